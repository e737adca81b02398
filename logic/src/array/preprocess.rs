//! From readings to the network's features (Bamshad 2023, section 4; figure 8).

use super::covariance::SlidingCovariance;
use super::logarithm::Knee;
use super::past::{LAG_MAX, Past};
use super::spectrum::SlidingSpectrum;
use super::structure::{self, Structure, WINDOWS};
use super::{Aligned, COVARIANCE_WINDOW, COVARIANCES, FEATURES, PAPER_FEATURES, Reading, SPECTRUM_WINDOW};

/// 55 covariances, row by row of the upper triangle, then 21 spectral bins, then 36 sums of structure functions, lag by lag, the newest
/// window first, one of them as its quiet level. Each is a logarithm, Q9: `sign(c) log2(1 + |c| / knee)` of a covariance (within +-2^14),
/// `log2(1 + p / knee)` of a bin's power (0..2^15), `log2(1 + s / (knee frames))` of a sum over so many frames (0..2^14).
pub type Features = [i16; FEATURES];

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreprocessorConfig {
    /// Lag of a difference, slow frames, clamped to 1..=[`LAG_MAX`]. Bamshad 2023, equation 1: 1.
    pub lag: u8,
    pub covariance_knee: u32,
    pub spectrum_knee: u32,
    /// samples^2 times the number of elements, for each slow frame of a window.
    pub structure_knee: u32,
    pub dead_max: u8,
}

impl PreprocessorConfig {
    pub const DEFAULT: Self =
        Self { lag: 1, covariance_knee: 128, spectrum_knee: 2_048, structure_knee: 128, dead_max: 2 };
}

/// Covariance over ten differences, spectrum over 40 sums and structure functions. Of an element that loses
/// its reading, differences and covariances become 0, and the sum keeps its last value. Its return counts as
/// no change: the missed force is added to the spectrum's whole window.
#[derive(Clone, Debug)]
pub struct Preprocessor {
    config: PreprocessorConfig,
    covariance_knee: Knee,
    spectrum_knee: Knee,
    structure_knees: [Knee; WINDOWS],
    lag: usize,
    past: Past,
    ready: bool,
    sum: i32,
    covariance: SlidingCovariance,
    spectrum: SlidingSpectrum,
    structure: Structure,
    missing: usize,
    features: Aligned<Features>,
}

impl Default for Preprocessor {
    fn default() -> Self {
        Self::new(PreprocessorConfig::DEFAULT)
    }
}

impl Preprocessor {
    pub fn new(config: PreprocessorConfig) -> Self {
        let lag = usize::from(config.lag).clamp(1, LAG_MAX);
        Self {
            config,
            covariance_knee: Knee::at(config.covariance_knee),
            spectrum_knee: Knee::at(config.spectrum_knee),
            structure_knees: structure::knees(config.structure_knee),
            lag,
            past: Past::default(),
            ready: false,
            sum: 0,
            covariance: SlidingCovariance::default(),
            spectrum: SlidingSpectrum::default(),
            structure: Structure::default(),
            missing: (COVARIANCE_WINDOW + lag).max(SPECTRUM_WINDOW).max(structure::READY_AFTER),
            features: Aligned([0; FEATURES]),
        }
    }

    /// None until the windows are full, and while too many elements have no reading.
    pub fn push(&mut self, reading: &Reading) -> Option<&Features> {
        self.add_reading(reading);
        self.add_spectrum();
        self.finish()
    }

    /// First third of [`push`](Self::push): equations 1 to 4 with their features, and the transform.
    pub fn add_reading(&mut self, reading: &Reading) {
        let arrival = self.past.push(reading);
        if arrival.gone.contains(&true) {
            self.covariance.forget(&arrival.gone);
            self.structure.forget();
        }
        if arrival.missed != 0 {
            self.spectrum.shift(arrival.missed);
        }
        self.sum += arrival.change;
        self.covariance.push(&self.past.changes(self.lag).of);
        self.spectrum.push(self.sum);
        self.missing = self.missing.saturating_sub(1);
        self.ready = self.missing == 0 && arrival.dead <= usize::from(self.config.dead_max);
        if self.ready {
            for (feature, &entry) in self.features.0.iter_mut().zip(self.covariance.entries()) {
                *feature = self.covariance_knee.signed(entry);
            }
        }
    }

    pub fn add_spectrum(&mut self) {
        self.structure.push_short(&self.past);
        if self.ready {
            for (feature, power) in self.features.0[COVARIANCES..].iter_mut().zip(self.spectrum.powers()) {
                *feature = self.spectrum_knee.of(power);
            }
        }
    }

    pub fn finish(&mut self) -> Option<&Features> {
        self.structure.push_long(&self.past);
        if !self.ready {
            return None;
        }
        self.structure.compress(&self.structure_knees, &mut self.features.0[PAPER_FEATURES..]);
        Some(&self.features.0)
    }

    pub fn features(&self) -> &Aligned<Features> {
        &self.features
    }

    pub fn covariance(&self) -> &SlidingCovariance {
        &self.covariance
    }
}
