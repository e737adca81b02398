//! A drawn photoelastic head of the scene and the logic that reads it, without a hand around them.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_hal_shim::channel::{
    CODE_MAX, FRAMES_PER_SLOW_FRAME, REFERENCE_MV, SAMPLE_MAX, SCAN_HZ, SCANS_PER_FRAME,
};
use tenax_logic::config::Config;
use tenax_logic::photoelastic::curve::{Curve, KNOTS};
use tenax_logic::photoelastic::track::{Hints, SHEAR_MAX_PERMILLE, Track};
use tenax_logic::photoelastic::{ALUMINIUM, Head, HeadConfig};
use tenax_scene::Seeds;
use tenax_scene::physics::Touch;
use tenax_scene::physics::stribeck::{METAL, Slider, Stribeck};
use tenax_scene::sensor::photoelastic::curve::{Day, Making, receiver_mv};
use tenax_scene::sensor::photoelastic::optics::Layer;
use tenax_scene::sensor::photoelastic::{self, drawn_strip};

const CYCLE_S: f64 = SCANS_PER_FRAME as f64 * FRAMES_PER_SLOW_FRAME as f64 / SCAN_HZ as f64;
const CYCLES_PER_S: f64 = 1.0 / CYCLE_S;
/// Noise of a conversion, codes rms, and of a scan at the pin, mV rms.
const CONVERTER_LSB: f64 = 1.0;
const NOISE_MV: f64 = 1.0;
/// The fastest ramp, N/s.
const FASTEST_N_S: f64 = 6.0;
/// Deviation of friction from day to day, either way: grease, dust, wear. Assumed.
const DAILY: f64 = 0.1;
const UNLOADED: Hints = Hints { unloaded: true, force_mn: None };
const NO_HINT: Hints = Hints { unloaded: false, force_mn: None };

/// A normal force, N, and its shear as a part of it.
type Load = (f64, f64);

/// One cycle (12.5 ms) of a ramp.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub true_n: f64,
    pub shear: f64,
    /// The reading and its uncertainty, N, where the head is certain of the branch.
    pub certain: Option<(f64, f64)>,
    /// The least and the most force that fit, N.
    pub range_n: (f64, f64),
}

#[derive(Clone, Copy, Debug)]
pub struct Slide {
    /// Median of the slip rate that was reported, mm/s.
    pub rate_mm_s: f64,
    /// Part of the cycles in which slip was reported.
    pub slips: f64,
}

/// A head that was calibrated on its first day, on another day.
pub struct Bench {
    making: Making,
    day: Day,
    source: photoelastic::Head,
    config: HeadConfig,
    head: Head,
    noise: ChaCha8Rng,
    scans: u64,
}

/// The forces at which the light means each eighth of half a turn of phase, N; the fourth is the peak.
fn knots_n(making: &Making, day: &Day) -> [f64; KNOTS] {
    let newtons = || (0..9_000).map(|mn| f64::from(mn) / 1e3);
    let mv = |force_n: f64| receiver_mv(&Layer::DUBEY, making, day, 0.0, force_n, 0.0);
    let peak_n =
        newtons().take_while(|&n| n < 3.0).max_by(|a, b| mv(*a).total_cmp(&mv(*b))).expect("a curve");
    let (dark, span) = (mv(0.0), mv(peak_n) - mv(0.0));
    std::array::from_fn(|k| {
        let sine = ((k + 1) as f64 * std::f64::consts::PI / KNOTS as f64).sin();
        let level = dark + span * sine * sine;
        match (k + 1).cmp(&(KNOTS / 2)) {
            std::cmp::Ordering::Less => newtons().find(|&n| mv(n) >= level),
            std::cmp::Ordering::Equal => Some(peak_n),
            std::cmp::Ordering::Greater => newtons().find(|&n| n > peak_n && mv(n) <= level + 1e-9),
        }
        .expect("the curve ends below 9 N")
    })
}

/// The settings after a calibration with weights (docs/photoelastic.md).
pub fn calibrated(making: &Making) -> HeadConfig {
    let knots_n = knots_n(making, &Day::FIRST);
    let level_q4 = |force_n: f64| {
        let mv = receiver_mv(&Layer::DUBEY, making, &Day::FIRST, 0.0, force_n, 0.0);
        (16.0 * mv * f64::from(SAMPLE_MAX) / f64::from(REFERENCE_MV)).round() as i32
    };
    let curve = Curve {
        dark_q4: level_q4(0.0),
        bright_q4: level_q4(knots_n[KNOTS / 2 - 1]),
        force_mn: knots_n.map(|force_n| (1e3 * force_n).round() as i32),
    };
    HeadConfig { fitted: true, curve, ..Config::default().head }
}

impl Bench {
    pub fn new(seed: u64) -> Self {
        let seeds = Seeds { making: seed, noise: seed };
        let (making, day) = (Making::drawn(seeds, 0.2), Day::drawn(seeds, 0.02, 20.0));
        let mut noise = ChaCha8Rng::seed_from_u64(seed);
        let mut today = |mean: f64| mean * noise.random_range(1.0 - DAILY..1.0 + DAILY);
        let mu_d = today(METAL.mu_d);
        let mu_s = mu_d + today(METAL.mu_s - METAL.mu_d);
        let friction = Stribeck { mu_s, mu_d, speed_m_s: today(METAL.speed_m_s) };
        let slider = Slider { friction, ..drawn_strip(seeds, 0.2) };
        Self {
            source: photoelastic::Head::with(Layer::DUBEY, making, day, slider, seeds),
            config: calibrated(&making),
            head: Head::default(),
            making,
            day,
            noise,
            scans: 0,
        }
    }

    /// Twelve even numbers, which add up to a normal one, nearly.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.noise.random::<f64>()).sum::<f64>() - 6.0
    }

    /// One cycle; `pin_v` gives the voltage at an instant, s, and part of the cycle.
    fn cycle(&mut self, hints: Hints, mut pin_v: impl FnMut(&mut Self, f64, f64) -> f64) {
        let begin = self.scans;
        for _ in 0..FRAMES_PER_SLOW_FRAME {
            let mut sample = 0;
            for _ in 0..SCANS_PER_FRAME {
                self.scans += 1;
                let t_s = self.scans as f64 / f64::from(SCAN_HZ);
                let volts = pin_v(self, t_s, (self.scans - begin) as f64 / f64::from(SCAN_HZ) / CYCLE_S);
                let code = volts * 1e3 / f64::from(REFERENCE_MV) * f64::from(CODE_MAX + 1);
                sample += (code + CONVERTER_LSB * self.normal()).clamp(0.0, f64::from(CODE_MAX)) as u16;
            }
            self.head.process(&self.config, sample);
        }
        self.head.cycle(&self.config, hints);
    }

    /// Force and shear go evenly from one load to the next.
    fn press(&mut self, from: Load, to: Load, hints: Hints) -> Point {
        self.cycle(hints, |bench, t_s, part| {
            let force_n = from.0 + (to.0 - from.0) * part;
            let shear_n = force_n * (from.1 + (to.1 - from.1) * part);
            let noise_mv = NOISE_MV * bench.normal();
            (receiver_mv(&Layer::DUBEY, &bench.making, &bench.day, t_s, force_n, shear_n) + noise_mv) / 1e3
        });
        let newtons = |mn: i32| f64::from(mn) / 1e3;
        let force = self.head.force();
        let is_certain = matches!(self.head.track(), Track::Certain(_));
        let told = self.head.stand_in();
        Point {
            true_n: to.0,
            shear: to.1,
            certain: force
                .filter(|_| is_certain)
                .map(|force| (newtons(force.mn()), newtons(force.uncertainty_mn()))),
            range_n: told.map_or((0.0, f64::INFINITY), |told| (newtons(told.fn_mn), newtons(told.load_mn))),
        }
    }

    fn ramp(&mut self, loads: &[Load]) -> Vec<Point> {
        let mut last = (0.0, 0.0);
        loads.iter().map(|&to| self.press(std::mem::replace(&mut last, to), to, NO_HINT)).collect()
    }

    /// A second in an open hand.
    fn rest(&mut self) {
        for _ in 0..CYCLES_PER_S as usize {
            self.press((0.0, 0.0), (0.0, 0.0), UNLOADED);
        }
    }

    /// The cycles of `count` stories of ramps up and down, after one grip over the peak.
    pub fn follow(&mut self, count: usize, sheared: bool) -> Vec<Point> {
        let knots_n = knots_n(&self.making, &self.day);
        let (peak_n, end_n) = (knots_n[KNOTS / 2 - 1], knots_n[KNOTS - 1]);
        self.rest();
        let grip: Vec<Load> =
            (1..=400).map(|n| (0.8 * end_n * f64::from(n.min(400 - n)) / 200.0, 0.0)).collect();
        self.ramp(&grip);
        self.rest();
        let mut points = Vec::new();
        for _ in 0..count {
            let story = story(&mut self.noise, peak_n, end_n, sheared);
            points.extend(self.ramp(&story));
            self.rest();
        }
        points
    }

    /// Presses a metal block on the head and draws it; what is reported in the second half of that.
    pub fn slide(&mut self, load_n: f64, rate_mm_s: f64, for_s: f64) -> Slide {
        let mut rub = |hints: Hints, touch: Touch| {
            self.cycle(hints, |bench, t_s, _| bench.source.step(t_s, &touch));
            (self.head.vibrates(), self.head.rate_um_s(&self.config, &ALUMINIUM))
        };
        let still = |normal_n: f64| Touch { normal_n, sticks: true, ..Touch::default() };
        for _ in 0..40 {
            rub(UNLOADED, still(0.0));
        }
        for n in 1..=60 {
            rub(NO_HINT, still(load_n * f64::from(n.min(40)) / 40.0));
        }
        let touch = Touch { normal_n: load_n, slide_m_s: rate_mm_s / 1e3, ..Touch::default() };
        let half = (for_s * CYCLES_PER_S / 2.0) as usize;
        let said: Vec<_> = (0..2 * half).map(|_| rub(NO_HINT, touch)).skip(half).collect();
        let mut rates: Vec<i32> = said.iter().map(|own| own.1).collect();
        rates.sort_unstable();
        Slide {
            rate_mm_s: f64::from(rates[half / 2]) / 1e3,
            slips: said.iter().filter(|own| own.0).count() as f64 / half as f64,
        }
    }
}

/// A number drawn so that each decade has as many.
pub fn over_decades(random: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    random.random_range(low.ln()..high.ln()).exp()
}

/// Ramps up and down in turn, cycle by cycle, each as fast as drawn. One in three turns near the peak, and half of those right at it.
/// Half of the change of shear comes with the force, the rest while it stays, as in a lift.
fn story(random: &mut ChaCha8Rng, peak_n: f64, end_n: f64, sheared: bool) -> Vec<Load> {
    let most = if sheared { f64::from(SHEAR_MAX_PERMILLE) / 1e3 } else { 0.0 };
    let between = |part: f64, from: f64, to: f64| from + part * (to - from);
    let (mut loads, mut at_n, mut at_shear) = (Vec::new(), 0.0_f64, 0.0);
    for n in 0..6 {
        let (low_n, high_n) = if n % 2 == 0 { (at_n, end_n) } else { (0.0, at_n) };
        let near_n = peak_n + random.random_range(-0.3..0.3) * f64::from(random.random_range(0..2_u8));
        let target_n = if n == 5 {
            0.0
        } else if random.random_range(0..3_u8) == 0 && (low_n..high_n).contains(&near_n) {
            near_n
        } else {
            between(random.random(), low_n, high_n)
        };
        let shear = most * random.random::<f64>();
        let half_way = between(0.5, at_shear, shear);
        let speed_n_s = over_decades(random, 0.3, FASTEST_N_S);
        let cycles = ((target_n - at_n).abs() * CYCLES_PER_S / speed_n_s).ceil().max(1.0);
        let parts = |cycles: f64| (1..=cycles as usize).map(move |cycle| cycle as f64 / cycles);
        loads.extend(
            parts(cycles).map(|part| (between(part, at_n, target_n), between(part, at_shear, half_way))),
        );
        if sheared {
            let lift = parts(cycles.clamp(8.0, 80.0));
            loads.extend(lift.map(|part| (target_n, between(part, half_way, shear))));
        }
        (at_n, at_shear) = (target_n, shear);
    }
    loads
}
