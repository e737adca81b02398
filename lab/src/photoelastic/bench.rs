//! One head, and the logic that reads it, frame by frame.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_hal_shim::channel::{CODE_MAX, FRAMES_PER_SLOW_FRAME, REFERENCE_MV, SCAN_HZ, SCANS_PER_FRAME};
use tenax_logic::config::Config;
use tenax_logic::photoelastic::track::Hints;
use tenax_logic::photoelastic::{Head, HeadConfig};

pub const CYCLE_S: f64 = SCANS_PER_FRAME as f64 * FRAMES_PER_SLOW_FRAME as f64 / SCAN_HZ as f64;
pub const SCAN_S: f64 = 1.0 / SCAN_HZ as f64;
/// Noise of a conversion, rms, codes.
const CONVERTER_LSB: f64 = 1.0;

/// The mean head's calibration, fitted.
pub fn mean_head() -> HeadConfig {
    HeadConfig { fitted: true, ..Config::default().head }
}

/// Reads a pin and steps the head's logic.
#[derive(Debug)]
pub struct Bench {
    pub config: HeadConfig,
    pub head: Head,
    converter: ChaCha8Rng,
    scans: u64,
}

impl Bench {
    /// A head that is read for the first time. The seed is the converter's.
    pub fn new(config: HeadConfig, seed: u64) -> Self {
        Self { config, head: Head::default(), converter: ChaCha8Rng::seed_from_u64(seed), scans: 0 }
    }

    /// Since the start, s.
    pub fn now_s(&self) -> f64 {
        self.scans as f64 * SCAN_S
    }

    /// One frame: `pin_v` is asked for the voltage at the end of each scan, by its instant. The sample that was taken.
    pub fn frame(&mut self, pin_v: &mut impl FnMut(f64) -> f64) -> u16 {
        let mut sample = 0;
        for _ in 0..SCANS_PER_FRAME {
            self.scans += 1;
            let volts = pin_v(self.now_s());
            // Twelve even numbers add up to a normal one, nearly.
            let noise = (0..12).map(|_| self.converter.random::<f64>()).sum::<f64>() - 6.0;
            let code =
                volts * 1e3 / f64::from(REFERENCE_MV) * f64::from(CODE_MAX + 1) + CONVERTER_LSB * noise;
            sample += code.clamp(0.0, f64::from(CODE_MAX)) as u16;
        }
        self.head.process(&self.config, sample);
        sample
    }

    pub fn cycle(&mut self, hints: Hints, mut pin_v: impl FnMut(f64) -> f64) {
        for _ in 0..FRAMES_PER_SLOW_FRAME {
            self.frame(&mut pin_v);
        }
        self.head.cycle(&self.config, hints);
    }
}

/// A number drawn evenly.
pub fn between(random: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * random.random::<f64>()
}

/// A number drawn so that each decade has as many.
pub fn over_decades(random: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    between(random, low.log10(), high.log10()).exp2().powf(std::f64::consts::LOG2_10)
}
