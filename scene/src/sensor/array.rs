//! The normal-force array: two rows of five elements under a silicone cover (Bamshad 2023, section 2.1).

use std::f64::consts::TAU;

use tenax_hal_shim::channel::{ARRAY, ARRAY_COUNT, CHANNELS};

use super::front_end_v;
use super::pvdf::ring_mv;
use crate::file::SceneFile;
use crate::file::sections::{Array, Knock};
use crate::physics::{TOUCH_N, Touch};
use crate::random::{Noise, Source};
use crate::schedule::FRAME_S;

const ROWS: usize = 2;
const LONG: usize = ARRAY_COUNT / ROWS;
/// Time in which the cover forgets that an element slipped, s (assumed).
const FORGETS_S: f64 = 0.030;
/// The cover spreads the load of the patch to this many times its radius (assumed): no element is ever out of it.
const SPREADS: f64 = 1.4;
/// The least share of the load that an element at the edge of it has, beside one in the middle (assumed).
const EDGE_PART: f64 = 0.05;
/// Waves of a surface's unevenness: from one pitch of its texture on, each so many times as long as the last (assumed).
const WAVES: usize = 5;
const WAVE_RATIO: f64 = 1.7;

/// Ten shares of one load.
///
/// At rest an element carries more the nearer it is to the contact's middle. The weight on the pad tilts the load along it, torsion
/// across the diagonal. Slip moves load between neighbours and mostly stays in the sum, so the covariance changes more than the
/// spectrum of the sum, as the detector of Bamshad 2023 (section 4) expects. A knock and the gear press on all of it.
#[derive(Debug)]
pub(crate) struct Elements {
    parameters: Array,
    knocks: Vec<Knock>,
    patch_m: f64,
    motor_hz: f64,
    motor_phase: f64,
    elements: [Element; ARRAY_COUNT],
    waves: [Wave; WAVES],
    noise: Noise,
    slips: Noise,
}

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Shakes {
    pub(crate) t_s: f64,
    pub(crate) released_n: f64,
    pub(crate) motor_speed: f64,
}

#[derive(Clone, Copy, Debug)]
struct Element {
    gain: f64,
    offset_mv: f64,
    /// Across and along the pad, -1 to 1.
    across: f64,
    along: f64,
    part: f64,
    travel_m: f64,
    uneven: f64,
    moved_n: f64,
}

#[derive(Clone, Copy, Debug)]
struct Wave {
    length_m: f64,
    begins: [f64; ROWS],
}

impl Elements {
    pub(crate) fn new(scene: &SceneFile, seed: u64) -> Self {
        let parameters = &scene.array;
        let patch_m = scene.contact.patch_radius_mm.get() / 1e3;
        let pitch_m = scene.contact.pitch_mm.get() / 1e3;
        let mut making = Noise::new(parameters.specimen.map_or(seed, u64::from), Source::ArrayMaking);
        let spread = parameters.spread.get();
        let place = parameters.place_mm.get() / 1e3 / patch_m;
        let mut elements: [Element; ARRAY_COUNT] = std::array::from_fn(|n| {
            let across = if n / LONG == 0 { -1.0 } else { 1.0 };
            let along = (n % LONG) as f64 * 2.0 / (LONG - 1) as f64 - 1.0;
            // The rows are half an element from the middle, an element being two fifths of the radius long.
            let away = [across / LONG as f64, along * (1.0 - 1.0 / LONG as f64) - place];
            let inside = 1.0 - (away[0] * away[0] + away[1] * away[1]) / (SPREADS * SPREADS);
            Element {
                gain: making.between(1.0 - spread, 1.0 + spread),
                offset_mv: making.between(0.0, parameters.offset_mv.get()),
                across,
                along,
                part: inside.max(EDGE_PART * EDGE_PART).sqrt(),
                travel_m: 0.0,
                uneven: 0.0,
                moved_n: 0.0,
            }
        });
        let whole: f64 = elements.iter().map(|element: &Element| element.part).sum();
        elements.iter_mut().for_each(|element| element.part /= whole);
        let mut surface = Noise::new(seed, Source::ArraySurface);
        let mut length_m = pitch_m;
        let waves: [Wave; WAVES] = std::array::from_fn(|_| {
            let wave = Wave { length_m, begins: std::array::from_fn(|_| surface.between(0.0, 1.0)) };
            length_m *= WAVE_RATIO;
            wave
        });
        for element in &mut elements {
            element.uneven = uneven(&waves, element, patch_m);
        }
        Self {
            parameters: parameters.clone(),
            knocks: scene.knock.clone(),
            patch_m,
            motor_hz: scene.pvdf.motor_hz.get(),
            motor_phase: 0.0,
            elements,
            waves,
            noise: Noise::new(seed, Source::Array),
            slips: Noise::new(seed, Source::ArraySlips),
        }
    }

    pub(crate) fn step(&mut self, touch: &Touch, shakes: Shakes) -> [f64; ARRAY_COUNT] {
        let pressed = touch.normal_n > TOUCH_N;
        self.slip(touch, if pressed { shakes.released_n } else { 0.0 });
        let shaken_n = if pressed { self.shaken_n(touch, shakes) } else { 0.0 };
        let draws: [f64; ARRAY_COUNT] = self.noise.normals();
        let p = &self.parameters;
        // Both as parts of the load: the shear, and the torsion over the patch's radius.
        let (weight, twist) = if pressed {
            (touch.shear_n / touch.normal_n, touch.torque_nm / (self.patch_m * touch.normal_n))
        } else {
            (0.0, 0.0)
        };
        let tilts = |element: &Element| {
            p.tilt.get() * (weight * element.along + twist * element.across * element.along)
        };
        let uneven = |element: &Element| p.uneven.get() * element.uneven;
        let mean = |what: &dyn Fn(&Element) -> f64| {
            self.elements.iter().map(|element| element.part * what(element)).sum::<f64>()
        };
        let stays = 1.0 - p.rim_part.get();
        let lean = mean(&tilts) + stays * mean(&uneven);
        let moved_n = self.elements.iter().map(|element| element.moved_n).sum::<f64>() / ARRAY_COUNT as f64;
        let moved_n = stays * moved_n;
        let load_n = touch.normal_n + shaken_n;
        let mut pins = [0.0; ARRAY_COUNT];
        for (n, element) in self.elements.iter().enumerate() {
            let share_n = load_n * element.part * (1.0 + tilts(element) + uneven(element) - lean)
                + element.moved_n
                - moved_n;
            let read_mv = p.mv_per_n.get() * element.gain * share_n.max(0.0) + element.offset_mv;
            let rest_mv = f64::from(CHANNELS[ARRAY + n].rest_mv);
            pins[n] = front_end_v(rest_mv + read_mv + p.noise_mv.get() * draws[n]);
        }
        pins
    }

    fn shaken_n(&mut self, touch: &Touch, shakes: Shakes) -> f64 {
        let p = &self.parameters;
        self.motor_phase = (self.motor_phase + self.motor_hz * shakes.motor_speed * FRAME_S).fract();
        let gear_n = p.motor_part.get()
            * touch.normal_n
            * shakes.motor_speed.sqrt()
            * libm::sin(TAU * self.motor_phase);
        let knocks_mv = self.knocks.iter().map(|knock| ring_mv(knock, shakes.t_s, 0.0)).sum::<f64>();
        // No knock lifts the pad off what it presses on.
        (gear_n + p.knock_mn_per_mv.get() / 1e3 * knocks_mv).max(-touch.normal_n)
    }

    fn slip(&mut self, touch: &Touch, released_n: f64) {
        let forgets = libm::exp(-FRAME_S / FORGETS_S);
        let part = self.parameters.slip_part.get();
        let renews_m = self.parameters.renews_um.get() / 1e6;
        let slides = !touch.sticks && touch.normal_n > TOUCH_N && touch.rub_m_s() > 0.0;
        for element in &mut self.elements {
            if !slides {
                element.moved_n *= forgets;
                continue;
            }
            let by_m = rub_m_s(touch, element, self.patch_m) * FRAME_S;
            if by_m > 0.0 {
                element.travel_m += by_m;
                element.uneven = uneven(&self.waves, element, self.patch_m);
            }
            // New contacts deal the load out anew.
            let keeps = libm::exp(-by_m / renews_m);
            let dealt_n = part * touch.drop_n * element.part * (1.0 - keeps * keeps).sqrt();
            element.moved_n = keeps * element.moved_n + dealt_n * self.slips.normal();
        }
        if released_n > 0.0 {
            let place = self.slips.between(0.0, ARRAY_COUNT as f64) as usize;
            let (row, place) = ((place / LONG).min(ROWS - 1) * LONG, place % LONG);
            // No element loses more than half of what it has.
            let has_n = self.elements[row + place].part * touch.normal_n;
            let moved_n = (part * released_n).min(has_n / 2.0);
            self.elements[row + place].moved_n -= moved_n;
            let neighbours = [place.checked_sub(1), Some(place + 1).filter(|&next| next < LONG)];
            let count = neighbours.iter().flatten().count() as f64;
            for neighbour in neighbours.into_iter().flatten() {
                self.elements[row + neighbour].moved_n += moved_n / count;
            }
        }
    }
}

fn uneven(waves: &[Wave; WAVES], element: &Element, patch_m: f64) -> f64 {
    let row = usize::from(element.across > 0.0);
    let at_m = element.travel_m + element.along * patch_m;
    let wave = |wave: &Wave| libm::sin(TAU * (at_m / wave.length_m + wave.begins[row]));
    waves.iter().map(wave).sum::<f64>() * (2.0 / WAVES as f64).sqrt()
}

fn rub_m_s(touch: &Touch, element: &Element, patch_m: f64) -> f64 {
    let turns_per_s = touch.turn_m_s / patch_m;
    let (across_m, along_m) = (element.across * patch_m / LONG as f64, element.along * patch_m);
    let (along_m_s, across_m_s) = (touch.slide_m_s + turns_per_s * across_m, turns_per_s * along_m);
    (along_m_s * along_m_s + across_m_s * across_m_s).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::quantity::{Lever, Millivolts, Part};

    const HELD: Touch = Touch {
        normal_n: 5.0,
        shear_n: 0.0,
        slide_m_s: 0.0,
        turn_m_s: 0.0,
        torque_nm: 0.0,
        sticks: true,
        stuck_part: 1.0,
        let_go: 0,
        released_n: 0.0,
        drop_n: 0.5,
    };
    const SLIDES: Touch = Touch { sticks: false, slide_m_s: 0.01, ..HELD };
    const STILL: Shakes = Shakes { t_s: 0.0, released_n: 0.0, motor_speed: 0.0 };
    const LETS_GO: Shakes = Shakes { released_n: 0.5, ..STILL };

    /// A quiet array of a scene that is changed so.
    fn made(change: impl FnOnce(&mut SceneFile)) -> Elements {
        let (name, text) = crate::builtin()[0];
        let mut scene = SceneFile::parse(text, name).unwrap();
        let off = Millivolts::of(0.0);
        let (spread, uneven) = (Part::of(0.0), Part::of(0.0));
        scene.array = Array { noise_mv: off, offset_mv: off, spread, uneven, ..scene.array };
        change(&mut scene);
        Elements::new(&scene, 1)
    }

    fn quiet() -> Elements {
        made(|_| {})
    }

    fn newtons(elements: &mut Elements, touch: Touch, shakes: Shakes) -> [f64; ARRAY_COUNT] {
        elements.step(&touch, shakes).map(|volts| (volts * 1e3 - 200.0) / 200.0)
    }

    /// Deviation of one share over 2000 frames, N.
    fn wander(mut elements: Elements, touch: Touch) -> f64 {
        let shares: Vec<f64> = (0..2_000).map(|_| newtons(&mut elements, touch, STILL)[3]).collect();
        let mean = shares.iter().sum::<f64>() / 2_000.0;
        (shares.iter().map(|share| (share - mean).powi(2)).sum::<f64>() / 2_000.0).sqrt()
    }

    #[test]
    fn the_shares_add_up_to_the_load_but_for_what_the_rim_takes_while_it_slides() {
        let slides = Touch { shear_n: 2.0, torque_nm: 0.004, ..SLIDES };
        let aside = || made(|scene| scene.array.place_mm = Lever::of(2.0));
        for make in [&quiet as &dyn Fn() -> Elements, &aside] {
            for (touch, shakes) in [(HELD, STILL), (HELD, LETS_GO), (slides, LETS_GO)] {
                let sum: f64 = newtons(&mut make(), touch, shakes).iter().sum();
                let rim_n = if touch.sticks { 1e-9 } else { 0.3 };
                assert!((sum - 5.0).abs() < rim_n, "{sum} N");
            }
        }
    }

    #[test]
    fn load_place_weight_and_torsion_decide_the_shares() {
        let middle = newtons(&mut quiet(), HELD, STILL);
        assert!(middle[2] > middle[1] && middle[1] > middle[0] && (middle[0] - middle[4]).abs() < 1e-12);
        let aside = newtons(&mut made(|scene| scene.array.place_mm = Lever::of(3.0)), HELD, STILL);
        assert!(aside[3] > aside[1] && aside[4] > aside[0]);
        let hangs = newtons(&mut quiet(), Touch { shear_n: 2.0, ..HELD }, STILL);
        assert!(hangs[4] > hangs[0] && hangs[9] > hangs[5] && (hangs[0] - hangs[5]).abs() < 1e-12);
        let twisted = newtons(&mut quiet(), Touch { torque_nm: 0.004, ..HELD }, STILL);
        assert!(twisted[9] > twisted[5] && twisted[4] < twisted[0]);
    }

    #[test]
    fn sliding_makes_the_shares_wander_and_sticking_does_not() {
        let uneven = || made(|scene| scene.array.uneven = Part::of(0.05));
        assert!(wander(quiet(), HELD) < 1e-12 && wander(uneven(), HELD) < 1e-12);
        assert!(wander(quiet(), SLIDES) > 0.005);
        assert!(wander(quiet(), Touch { slide_m_s: 0.0, turn_m_s: 0.01, ..SLIDES }) > 0.005);
        // Without stick-slip it is the unevenness of the surface.
        let smooth = Touch { drop_n: 0.0, ..SLIDES };
        assert!(wander(quiet(), smooth) < 1e-12);
        let (felt, share_n) = (wander(uneven(), smooth), newtons(&mut quiet(), HELD, STILL)[3]);
        assert!((felt / (0.05 * share_n) - 1.0).abs() < 0.3, "{felt} N of {share_n} N");
    }
}
