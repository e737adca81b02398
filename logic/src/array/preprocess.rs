//! From readings to what the network sees (Bamshad 2023, section 4; figure 8).

use tenax_hal_shim::channel::{ARRAY, CHANNELS, sample_from_mv};

use super::covariance::SlidingCovariance;
use super::logarithm::Knee;
use super::spectrum::SlidingSpectrum;
use super::{COVARIANCE_WINDOW, COVARIANCES, ELEMENTS, FEATURES, Reading, SPECTRUM_WINDOW};

/// What the network sees of one slow frame: 55 covariances, row by row of the upper triangle, then 21 spectral bins.
///
/// Each is a logarithm, Q9 ([`logarithm`](super::logarithm)): `sign(c) log2(1 + |c| / knee)` of a covariance,
/// `log2(1 + p / knee)` of a bin's power. 512 is one doubling. A covariance is within +-2^14, a bin within 0..2^15.
pub type Features = [i16; FEATURES];

/// The longest lag of a difference, slow frames: half a second, for sensors that creep.
pub const LAG_MAX: usize = 40;

/// How readings become features.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreprocessorConfig {
    /// A difference is to the reading so many slow frames before, 1 to [`LAG_MAX`] (equation 1: 1). What is beyond is cut.
    pub lag: u8,
    /// Covariance below which a feature is straight instead of logarithmic, samples^2: about that of noise alone.
    pub covariance_knee: u32,
    /// The same for a bin's power, samples^2.
    pub spectrum_knee: u32,
    /// With more elements than this without a reading, there are no features.
    pub dead_max: u8,
}

impl PreprocessorConfig {
    /// For elements of 200 mV/N with half a millivolt of noise: 2.5 samples, so 12.5 squared in a difference, ten of
    /// which make a variance, and 6.2 in a reading, 400 of which make a bin's power.
    pub const DEFAULT: Self = Self { lag: 1, covariance_knee: 128, spectrum_knee: 2_048, dead_max: 2 };
}

impl Default for PreprocessorConfig {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Covariance over `N` differences and spectrum over `M` sums of the readings pushed so far.
///
/// An element without a reading changes nothing: its differences are 0, its covariances are 0 from that very frame on
/// (also those of the frames before, whose readings may have been its dying ones), and the sum keeps what it had of it.
/// When it comes back, or reads for the first time, that is no change either: the spectrum's window is given the force
/// that it missed as a constant, and differences begin when there is a reading of its own to differ from.
#[derive(Clone, Debug)]
pub struct Preprocessor<const N: usize = COVARIANCE_WINDOW, const M: usize = SPECTRUM_WINDOW> {
    config: PreprocessorConfig,
    covariance_knee: Knee,
    spectrum_knee: Knee,
    /// Slow frames from the reading that a difference is to.
    lag: usize,
    /// Readings of the last `lag` frames, where there were any.
    past: [[u16; ELEMENTS]; LAG_MAX],
    /// The oldest of them.
    oldest: usize,
    /// The last reading of each element, and for how many frames up to now it has had one, `lag` at most.
    last: [(u16, usize); ELEMENTS],
    /// Force of all elements above rest, samples.
    sum: i32,
    covariance: SlidingCovariance<N>,
    spectrum: SlidingSpectrum<M>,
    /// Readings that are still missing before the windows are full.
    missing: usize,
    features: Features,
}

impl Default for Preprocessor {
    fn default() -> Self {
        Self::new(PreprocessorConfig::DEFAULT)
    }
}

impl<const N: usize, const M: usize> Preprocessor<N, M> {
    /// The reading of an element that nothing presses.
    const REST: u16 = sample_from_mv(CHANNELS[ARRAY].rest_mv);
    /// One that has read nothing.
    #[must_use]
    pub fn new(config: PreprocessorConfig) -> Self {
        let lag = usize::from(config.lag).clamp(1, LAG_MAX);
        Self {
            config,
            covariance_knee: Knee::at(config.covariance_knee),
            spectrum_knee: Knee::at(config.spectrum_knee),
            lag,
            past: [[Self::REST; ELEMENTS]; LAG_MAX],
            oldest: 0,
            last: [(Self::REST, 0); ELEMENTS],
            sum: 0,
            covariance: SlidingCovariance::default(),
            spectrum: SlidingSpectrum::default(),
            missing: if N + lag > M { N + lag } else { M },
            features: [0; FEATURES],
        }
    }

    /// Takes one slow frame. None until the windows are full, and while too many elements have no reading.
    pub fn push(&mut self, reading: &Reading) -> Option<&Features> {
        let dead = self.take(reading);
        self.missing = self.missing.saturating_sub(1);
        if self.missing > 0 || dead > usize::from(self.config.dead_max) {
            return None;
        }
        self.compress();
        Some(&self.features)
    }

    /// Equations 1 to 4, and the transform; gives the number of elements without a reading.
    fn take(&mut self, reading: &Reading) -> usize {
        let mut differences = [0; ELEMENTS];
        let (mut dead, mut missed) = (0, 0);
        let mut gone = [false; ELEMENTS];
        let Some(past) = self.past.get_mut(self.oldest) else { return ELEMENTS };
        self.oldest = if self.oldest + 1 < self.lag { self.oldest + 1 } else { 0 };
        let elements = self.last.iter_mut().zip(past).zip(reading).zip(&mut differences).zip(&mut gone);
        for (((((last, alive), past), reading), difference), gone) in elements {
            let Some(now) = *reading else {
                *gone = *alive > 0;
                *alive = 0;
                dead += 1;
                continue;
            };
            let change = i32::from(now) - i32::from(*last);
            self.sum += change;
            if *alive == 0 {
                missed += change;
            }
            if *alive < self.lag {
                *alive += 1;
            } else {
                *difference = i32::from(now) - i32::from(*past);
            }
            (*last, *past) = (now, now);
        }
        if gone.contains(&true) {
            self.covariance.forget(&gone);
        }
        if missed != 0 {
            self.spectrum.shift(missed);
        }
        self.covariance.push(&differences);
        self.spectrum.push(self.sum);
        dead
    }

    fn compress(&mut self) {
        let (covariances, bins) = self.features.split_at_mut(COVARIANCES);
        for (feature, &entry) in covariances.iter_mut().zip(self.covariance.entries()) {
            *feature = self.covariance_knee.signed(entry);
        }
        for (feature, power) in bins.iter_mut().zip(self.spectrum.powers()) {
            *feature = self.spectrum_knee.of(power);
        }
    }

    /// What [`push`](Self::push) gave last.
    #[must_use]
    pub fn features(&self) -> &Features {
        &self.features
    }

    /// The covariances behind the last features, samples^2.
    #[must_use]
    pub fn covariance(&self) -> &SlidingCovariance<N> {
        &self.covariance
    }

    /// The spectrum behind the last features.
    #[must_use]
    pub fn spectrum(&self) -> &SlidingSpectrum<M> {
        &self.spectrum
    }
}
