//! What the network sees of a recording: the firmware's own integers.

use tenax::labelled::{Part, Recording, Step};
use tenax_logic::array::logarithm::Knee;
use tenax_logic::array::spectrum::SlidingSpectrum;
use tenax_logic::array::{BINS, COVARIANCES, ELEMENTS, FEATURES, PreprocessorConfig, SPECTRUM_WINDOW};

/// What features are made with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Recipe {
    /// A difference is to the reading so many slow frames before (equation 1: 1).
    pub lag: usize,
    /// Differences in the covariance (section 4.2: 10).
    pub window: usize,
    /// Sums in the spectrum (section 4.3: 40), or 20 or 10, which leave the upper bins 0.
    pub spectrum: usize,
    /// Covariance below which a feature is straight, samples^2.
    pub covariance_knee: u32,
    /// The same for a bin's power.
    pub spectrum_knee: u32,
}

impl Recipe {
    /// The firmware's.
    pub const FIRMWARE: Self = Self {
        lag: 1,
        window: 10,
        spectrum: SPECTRUM_WINDOW,
        covariance_knee: PreprocessorConfig::DEFAULT.covariance_knee,
        spectrum_knee: PreprocessorConfig::DEFAULT.spectrum_knee,
    };

    /// Readings before the first features.
    #[must_use]
    pub fn ready_after(&self) -> usize {
        (self.lag + self.window).max(self.spectrum)
    }

    /// Differences are cut at this, so that the window's sum of products fits in an `i32`: a power of two.
    fn d_max(&self) -> i32 {
        let most = (f64::from(i32::MAX) / self.window as f64).sqrt();
        1 << (most as u32).ilog2()
    }
}

/// A recording as features.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sequence {
    /// The recording's name.
    pub name: String,
    /// Its session.
    pub session: String,
    /// Its material.
    pub material: String,
    /// What it is for, if its file says so.
    pub part: Option<Part>,
    /// Features of each step from the one on with which the windows are full.
    pub features: Vec<[i16; FEATURES]>,
    /// Whether it slipped in that step.
    pub slips: Vec<bool>,
}

/// Equations 1 to 4 and the transform, as the firmware computes them, over a whole recording.
///
/// With a lag of 1 and a window of 10 it is what [`Preprocessor`](tenax_logic::array::Preprocessor) gives, bit for bit.
#[must_use]
pub fn sequence(recording: &Recording, recipe: &Recipe) -> Sequence {
    let knees = (Knee::at(recipe.covariance_knee), Knee::at(recipe.spectrum_knee));
    let differences = differences(recording, recipe);
    let powers = match recipe.spectrum {
        10 => powers::<10>(recording),
        20 => powers::<20>(recording),
        _ => powers::<SPECTRUM_WINDOW>(recording),
    };
    let mut covariance = [0i32; COVARIANCES];
    let (mut features, mut slips) = (Vec::new(), Vec::new());
    for (n, step) in recording.steps.iter().enumerate() {
        let old = n.checked_sub(recipe.window).map_or([0; ELEMENTS], |n| differences[n]);
        let mut entries = covariance.iter_mut();
        for row in 0..ELEMENTS {
            for other in row..ELEMENTS {
                if let Some(entry) = entries.next() {
                    *entry += differences[n][row] * differences[n][other] - old[row] * old[other];
                }
            }
        }
        if n + 1 < recipe.ready_after() {
            continue;
        }
        let mut row = [0; FEATURES];
        let (covariances, bins) = row.split_at_mut(COVARIANCES);
        for (feature, &entry) in covariances.iter_mut().zip(&covariance) {
            *feature = knees.0.signed(entry);
        }
        for (feature, power) in bins.iter_mut().zip(powers[n]) {
            *feature = knees.1.of(power);
        }
        features.push(row);
        slips.push(step.slip);
    }
    Sequence {
        name: recording.name.clone(),
        session: recording.session.clone(),
        material: recording.material.clone(),
        part: recording.part,
        features,
        slips,
    }
}

/// Powers of the bins after each step.
fn powers<const M: usize>(recording: &Recording) -> Vec<[f32; BINS]> {
    let mut spectrum = SlidingSpectrum::<M>::default();
    let after = |step: &Step| {
        spectrum.push(step.samples.iter().map(|&sample| i32::from(sample)).sum());
        spectrum.powers()
    };
    recording.steps.iter().map(after).collect()
}

/// Differences over the lag; none before there is something to differ from.
fn differences(recording: &Recording, recipe: &Recipe) -> Vec<[i32; ELEMENTS]> {
    let d_max = recipe.d_max();
    let sample = |n: usize, element: usize| i32::from(recording.steps[n].samples[element]);
    (0..recording.steps.len())
        .map(|n| match n.checked_sub(recipe.lag) {
            Some(before) => std::array::from_fn(|element| {
                (sample(n, element) - sample(before, element)).clamp(-d_max, d_max - 1)
            }),
            None => [0; ELEMENTS],
        })
        .collect()
}

/// Whether a network is shown a feature. Bin 0 it is not: that is the force itself, whatever the object does.
#[must_use]
pub fn is_shown(feature: usize) -> bool {
    feature != COVARIANCES
}

/// Whether a feature is a variance: the diagonal of the covariance, row by row of its upper triangle.
#[must_use]
pub fn is_variance(feature: usize) -> bool {
    (0..ELEMENTS).any(|row| row * ELEMENTS + row - row * (row + 1) / 2 == feature)
}
