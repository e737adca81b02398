//! Slip rate: amplitude and frequency of a block that is drawn over the head, and the fit of both.

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use tenax_frames::quantile::middle;
use tenax_logic::photoelastic::rate::RateFit;
use tenax_logic::photoelastic::split::Q;
use tenax_logic::photoelastic::track::Hints;
use tenax_scene::Seeds;
use tenax_scene::physics::Touch;
use tenax_scene::physics::stribeck::{METAL, PLASTIC, Slider, Stribeck};
use tenax_scene::sensor::photoelastic::curve::{Day, Making};
use tenax_scene::sensor::photoelastic::optics::Layer;
use tenax_scene::sensor::photoelastic::{Head, drawn_strip};

use super::balance;
use super::bench::{Bench, between, over_decades};
use crate::equations::Equations;

/// Friction of one material differs by this part from day to day: grease, dust, wear. Assumed.
const DAILY: f64 = 0.1;
/// Slip rates, mm/s (Dubey 2006, section 4).
const RATES_MM_S: (f64, f64) = (0.1, 3.0);
/// Loads, N: the blocks of 105 and 155 g between two fingers need some 1 to 2 N.
const LOADS_N: (f64, f64) = (0.7, 2.0);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Material {
    Aluminium,
    Plastic,
}

impl Material {
    pub const ALL: [Self; 2] = [Self::Aluminium, Self::Plastic];

    pub const fn name(self) -> &'static str {
        match self {
            Self::Aluminium => "aluminium",
            Self::Plastic => "plastic",
        }
    }

    pub const fn friction(self) -> Stribeck {
        match self {
            Self::Aluminium => METAL,
            Self::Plastic => PLASTIC,
        }
    }
}

/// A head in a rig that draws a block over it.
#[derive(Debug)]
pub struct Rig {
    head: Head,
    pub bench: Bench,
}

#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// True rate, mm/s.
    pub rate_mm_s: f64,
    /// Mean size of the ac part, mV.
    pub amplitude_mv: f64,
    /// Its frequency, Hz; 0 if nothing swings.
    pub hz: f64,
    /// Amplitude, period and force, None if nothing swings.
    pub swing: Option<(i32, u16, i32)>,
    /// The part of the cycles in which slip was said.
    pub said: f64,
}

impl Rig {
    /// The mean head on its first day, calibrated.
    pub fn mean(slider: Slider, seed: u64) -> Self {
        Self::with(Making::MEAN, Day::FIRST, slider, seed, &super::bench::mean_head())
    }

    /// A head of this making and its day; `config` is its calibration.
    pub fn with(
        making: Making,
        day: Day,
        slider: Slider,
        seed: u64,
        config: &tenax_logic::photoelastic::HeadConfig,
    ) -> Self {
        let head = Head::with(Layer::DUBEY, making, day, slider, seed.into());
        Self { head, bench: Bench::new(*config, seed) }
    }

    /// Presses a block on the head and draws it at `rate_mm_s` for `for_s`; what is seen in the last half of that.
    pub fn slide(&mut self, load_n: f64, rate_mm_s: f64, for_s: f64) -> Seen {
        let cycles = |seconds: f64| (seconds * 80.0) as usize;
        self.still(0.0, 40, Hints { unloaded: true, ..Hints::default() });
        for n in 1..=40 {
            self.still(load_n * f64::from(n) / 40.0, 1, Hints::default());
        }
        self.still(load_n, 20, Hints::default());
        let touch = Touch { normal_n: load_n, slide_m_s: rate_mm_s / 1e3, ..Touch::default() };
        let (count, mut said) = (cycles(for_s), 0);
        let (mut amplitudes, mut periods, mut swings) = (Vec::new(), Vec::new(), Vec::new());
        for n in 0..count {
            let head = &mut self.head;
            self.bench.cycle(Hints::default(), |t_s| head.step(t_s, &touch));
            if n < count / 2 {
                continue;
            }
            let reads = &self.bench.head;
            said += usize::from(reads.vibrates());
            amplitudes.push(f64::from(reads.split.envelope) / f64::from(1 << Q) * 3_300.0 / 16_380.0);
            periods.push(f64::from(reads.split.period_q4()));
            swings.extend(reads.swing(&self.bench.config));
        }
        let period_q4 = middle(periods).unwrap_or(f64::NAN);
        swings.sort_by_key(|swing| swing.0);
        Seen {
            rate_mm_s,
            amplitude_mv: middle(amplitudes).unwrap_or(f64::NAN),
            hz: if period_q4 > 0.0 { 32_000.0 / period_q4 } else { 0.0 },
            swing: swings.get(swings.len() / 2).copied(),
            said: said as f64 / (count - count / 2) as f64,
        }
    }

    fn still(&mut self, normal_n: f64, cycles: usize, hints: Hints) {
        let touch = Touch { normal_n, sticks: true, ..Touch::default() };
        for _ in 0..cycles {
            let head = &mut self.head;
            self.bench.cycle(hints, |t_s| head.step(t_s, &touch));
        }
    }
}

/// A head that was calibrated on its first day, and a material, both on a day of their own.
pub fn rig_of(making_seed: u64, day_seed: u64, material: Material) -> Rig {
    let seeds = Seeds { making: making_seed, noise: day_seed };
    let making = Making::drawn(seeds, 0.2);
    let calibrated = balance::weigh(&making, &Day::FIRST, seeds);
    let mut random = ChaCha8Rng::seed_from_u64(day_seed);
    let today = |part: f64, random: &mut ChaCha8Rng| part * between(random, 1.0 - DAILY, 1.0 + DAILY);
    let Stribeck { mu_s, mu_d, speed_m_s } = material.friction();
    let mu_d = today(mu_d, &mut random);
    let friction = Stribeck {
        mu_s: mu_d + today(mu_s - material.friction().mu_d, &mut random),
        mu_d,
        speed_m_s: today(speed_m_s, &mut random),
    };
    let slider = Slider { friction, ..drawn_strip(seeds, 0.2) };
    Rig::with(making, Day::drawn(seeds, 0.02, 20.0), slider, day_seed, &calibrated.config())
}

/// Slips at rates and loads drawn with the day's seed, on one head.
pub fn slips(making_seed: u64, day_seed: u64, material: Material, count: usize) -> Vec<Seen> {
    let mut random = ChaCha8Rng::seed_from_u64(day_seed ^ 0x51);
    (0..count)
        .map(|_| {
            let rate_mm_s = over_decades(&mut random, RATES_MM_S.0, RATES_MM_S.1);
            let load_n = between(&mut random, LOADS_N.0, LOADS_N.1);
            rig_of(making_seed, day_seed, material).slide(load_n, rate_mm_s, 0.8 + 0.2 / rate_mm_s)
        })
        .collect()
}

/// The fit of all slips that swing (least squares of logarithms).
pub fn fit<'a>(slips: impl IntoIterator<Item = &'a Seen>) -> RateFit {
    let mut equations = Equations::new(4);
    for seen in slips {
        if let Some((amplitude, period_q4, force_mn)) = seen.swing {
            let [a, f, n] =
                RateFit::features(amplitude, period_q4, force_mn).map(|log| f64::from(log) / 1_024.0);
            equations.add(&[1.0, a, f, n], 1.0, (seen.rate_mm_s * 1e3).log2());
        }
    }
    let factors = equations.solve();
    let [constant, amplitude, frequency, force] = [0, 1, 2, 3].map(|n| (factors[n] * 1_024.0).round() as i32);
    RateFit { constant, amplitude, frequency, force }
}

/// Error of each rate, %.
pub fn errors_percent(fit: &RateFit, slips: &[Seen]) -> Vec<f64> {
    let error = |seen: &Seen| {
        let (amplitude, period_q4, force_mn) = seen.swing?;
        let read_mm_s = f64::from(fit.rate_um_s(amplitude, period_q4, force_mn)) / 1e3;
        Some((read_mm_s / seen.rate_mm_s - 1.0).abs() * 100.0)
    };
    slips.iter().map(|seen| error(seen).unwrap_or(100.0)).collect()
}
