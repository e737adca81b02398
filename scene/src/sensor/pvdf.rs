//! PVDF films in the skin: piezoelectric, so they hear change, not load.

use std::f64::consts::{SQRT_2, TAU};

use tenax_hal_shim::channel::{PVDF_COUNT, SCANS_PER_FRAME};
use tenax_hal_shim::front_end::PVDF_REST_MV;

use super::front_end_v;
use super::place::Place;
use crate::file::sections::{Hum, Knock, Pvdf};
use crate::physics::{TOUCH_N, Touch};
use crate::random::{Noise, Seeds, Source};
use crate::schedule::LowPass;
use crate::schedule::{STEP_S, Span};

/// A knock is forgotten after this many times its decay: e^-12 of millivolts is below any code.
const KNOCK_DECAYS: f64 = 12.0;

/// Twelve films, each with its own gain, sign, depth and place, and if asked for its direction.
///
/// Load, shear and the shear let go reach a film through the skin, two poles, and the charge amplifier's high-pass: a step becomes the
/// bump of about 25 ms that the recordings show. Texture, settling, gear, knocks, hum and noise are added at the film. A film hears
/// slip of its own place first, and the rest of the patch as far as its depth spreads it: a patch that lets go from its edge inwards
/// is heard by one film after the other. A film with a direction hears pressure or shear, as it lies.
#[derive(Debug)]
pub(crate) struct Films {
    parameters: Pvdf,
    knocks: Vec<Knock>,
    hums: Vec<(Span, Hum)>,
    pitch_m: f64,
    films: [Film; PVDF_COUNT],
    gains: [f64; PVDF_COUNT],
    noises: [f64; PVDF_COUNT],
    skin: [[LowPass; 2]; PVDF_COUNT],
    amplifiers: [LowPass; PVDF_COUNT],
    noise: Noise,
    last_normal_n: f64,
    last_edge: f64,
    texture_phase: f64,
    motor_phase: f64,
}

#[derive(Clone, Copy, Debug)]
struct Film {
    phase: f64,
    place: Place,
    pressure: f64,
    shear: f64,
    released_n: f64,
}

impl Films {
    pub(crate) fn new(
        parameters: &Pvdf,
        (knocks, hums): (&[Knock], &[Hum]),
        pitch_mm: f64,
        seeds: Seeds,
    ) -> Self {
        let mut making = Noise::new(seeds.making, Source::FilmMaking);
        let spread = parameters.spread.get();
        let skin_s = parameters.skin_ms.get() / 1e3;
        let (mut gains, mut skin) = ([0.0; PVDF_COUNT], [LowPass::with_tau_s(skin_s); PVDF_COUNT]);
        let mut films: [Film; PVDF_COUNT] = std::array::from_fn(|n| {
            gains[n] = making.sign() * making.between(1.0 - spread, 1.0 + spread);
            skin[n] = LowPass::with_tau_s(skin_s * making.between(0.67, 1.5));
            let phase = making.between(0.0, 1.0);
            Film { phase, place: Place::EVERYWHERE, pressure: 1.0, shear: 1.0, released_n: 0.0 }
        });
        let amplifier = LowPass::with_corner_hz(parameters.high_pass_hz.get());
        for film in &mut films {
            film.place = Place::random(&mut making);
        }
        // Drawn last: a scene without it has the films that it ever had.
        let mut about_1 = || libm::pow(10.0, parameters.film_decades.get() * making.between(-0.5, 0.5));
        gains.iter_mut().for_each(|gain| *gain *= about_1());
        let noises = std::array::from_fn(|_| about_1());
        let turned = parameters.film_directions.get();
        for film in &mut films {
            // So that the mean of the squares is that of films that lie alike.
            let turn = making.between(0.0, TAU);
            film.pressure += turned * (SQRT_2 * libm::cos(turn).abs() - 1.0);
            film.shear += turned * (SQRT_2 * libm::sin(turn) - 1.0);
        }
        Self {
            parameters: parameters.clone(),
            knocks: knocks.to_vec(),
            hums: hums.iter().map(|hum| (Span::of(hum.at_s, hum.for_s), hum.clone())).collect(),
            pitch_m: pitch_mm / 1e3,
            films,
            gains,
            noises,
            skin: skin.map(|pole| [pole; 2]),
            amplifiers: [amplifier; PVDF_COUNT],
            noise: Noise::new(seeds.noise, Source::Film),
            last_normal_n: 0.0,
            last_edge: 0.0,
            texture_phase: 0.0,
            motor_phase: 0.0,
        }
    }

    /// Voltages at the pins after one scan that ends at `t_s`. `motor_speed` is a part of the fastest; `vibrates_mv` is what else shakes
    /// the whole hand.
    pub(crate) fn step(
        &mut self,
        t_s: f64,
        touch: &Touch,
        motor_speed: f64,
        vibrates_mv: f64,
    ) -> [f64; PVDF_COUNT] {
        let p = &self.parameters;
        // Pressure over its peak at the edge of what slides: the brush's s.
        let edge = if touch.sticks { (1.0 - touch.stuck_part).max(0.0).sqrt() } else { 1.0 };
        let last_edge = std::mem::replace(&mut self.last_edge, edge);
        let pressed_mv = p.normal_mv_per_n.get() * touch.normal_n;
        let sheared_mv = p.shear_mv_per_n.get() * touch.shear_n;

        let change_n_per_s = (touch.normal_n - self.last_normal_n).abs() / STEP_S;
        self.last_normal_n = touch.normal_n;
        let adjust_mv = p.adjust_mv_per_n_s.get() * change_n_per_s;
        // White over the whole scan rate, so that the sum of a frame's scans has the rms that was asked for.
        let power = p.noise_mv.get() * p.noise_mv.get() + adjust_mv * adjust_mv;
        let noise_mv = (power * SCANS_PER_FRAME as f64).sqrt();

        let speed_m_s = touch.rub_m_s();
        self.texture_phase = (self.texture_phase + speed_m_s / self.pitch_m * STEP_S).fract();
        let half_m_s = p.texture_half_mm_s.get() / 1e3;
        let texture_mv = if touch.normal_n > TOUCH_N && speed_m_s > 0.0 {
            p.texture_mv_per_n.get() * touch.drop_n * speed_m_s / (speed_m_s + half_m_s)
        } else {
            0.0
        };

        self.motor_phase = (self.motor_phase + p.motor_hz.get() * motor_speed * STEP_S).fract();
        let everywhere_mv = if motor_speed > 0.0 {
            p.motor_mv.get() * motor_speed.sqrt() * libm::sin(TAU * self.motor_phase)
        } else {
            0.0
        } + vibrates_mv
            + p.mains_mv.get() * libm::sin(TAU * p.mains_hz.get() * t_s)
            + self
                .hums
                .iter()
                .filter(|(span, _)| span.contains(t_s))
                .map(|(_, hum)| hum_mv(hum, t_s))
                .sum::<f64>();

        if touch.released_n > 0.0 {
            for film in &mut self.films {
                film.released_n += touch.released_n * film.place.hears_release(last_edge, edge);
            }
        }
        let release_mv_per_n = p.release_mv_per_n.get();
        let mut films_mv: [f64; PVDF_COUNT] = std::array::from_fn(|n| {
            let film = &self.films[n];
            let under_mv = film.pressure * pressed_mv
                + film.shear * sheared_mv
                + film.shear * release_mv_per_n * film.released_n;
            let [upper, lower] = &mut self.skin[n];
            let deformed_mv = lower.step(upper.step(under_mv));
            deformed_mv - self.amplifiers[n].step(deformed_mv)
        });
        if texture_mv > 0.0 {
            for (film_mv, film) in films_mv.iter_mut().zip(&self.films) {
                *film_mv += texture_mv
                    * film.shear
                    * film.place.slides(edge)
                    * spike(self.texture_phase + film.phase);
            }
        }
        for knock in self.knocks.iter().filter(|knock| rings(knock, t_s)) {
            for (film_mv, film) in films_mv.iter_mut().zip(&self.films) {
                *film_mv += film.hears(knock) * ring_mv(knock, t_s, film.phase);
            }
        }
        let draws: [f64; PVDF_COUNT] = self.noise.normals();
        let gain = p.gain.get();
        std::array::from_fn(|n| {
            let film_mv =
                self.gains[n] * (films_mv[n] + everywhere_mv) + self.noises[n] * noise_mv * draws[n];
            front_end_v(f64::from(PVDF_REST_MV) + gain * film_mv)
        })
    }
}

impl Film {
    fn hears(&self, knock: &Knock) -> f64 {
        let comes_from = (knock.at_s.get() * 7.389).fract();
        1.0 + knock.uneven.get() * libm::cos(TAU * (self.phase - comes_from))
    }
}

fn spike(turns: f64) -> f64 {
    let hump = (1.0 + libm::cos(TAU * turns)) / 2.0;
    hump * hump * hump * hump - 35.0 / 128.0
}

fn hum_mv(hum: &Hum, t_s: f64) -> f64 {
    hum.peak_mv.get() * libm::sin(TAU * hum.hum_hz.get() * t_s)
}

fn rings(knock: &Knock, t_s: f64) -> bool {
    let decay_s = knock.decay_ms.get() / 1e3;
    (0.0..KNOCK_DECAYS * decay_s).contains(&(t_s - knock.at_s.get()))
}

pub(super) fn ring_mv(knock: &Knock, t_s: f64, phase: f64) -> f64 {
    if !rings(knock, t_s) {
        return 0.0;
    }
    let since_s = t_s - knock.at_s.get();
    let decay_s = knock.decay_ms.get() / 1e3;
    let ring = libm::sin(TAU * (knock.ring_hz.get() * since_s + phase));
    knock.peak_mv.get() * libm::exp(-since_s / decay_s) * ring
}
