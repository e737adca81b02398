//! The network's inputs from a recording: the firmware's own integers.

use tenax_logic::array::logarithm::Knee;
use tenax_logic::array::past::Past;
use tenax_logic::array::spectrum::SlidingSpectrum;
use tenax_logic::array::structure::{self, Structure};
use tenax_logic::array::{
    BINS, COVARIANCES, ELEMENTS, FEATURES, PAPER_FEATURES, PreprocessorConfig, SPECTRUM_WINDOW,
};
use tenax_sim::labelled::{ArrayRecipe, Part, Recording};
use tenax_sim::scorer::Doing;

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Recipe {
    /// A difference is to the reading so many slow frames before (equation 1: 1).
    pub lag: usize,
    /// Differences in the covariance (section 4.2: 10).
    pub window: usize,
    /// Sums in the spectrum (section 4.3: 40), or 20 or 10, which leave the upper bins 0.
    pub spectrum: usize,
    /// Covariance below which a feature is linear, samples^2.
    pub covariance_knee: u32,
    /// The same for a bin's power.
    pub spectrum_knee: u32,
    pub structure_knee: u32,
}

impl Recipe {
    pub const FIRMWARE: Self = Self {
        lag: 1,
        window: 10,
        spectrum: SPECTRUM_WINDOW,
        covariance_knee: PreprocessorConfig::DEFAULT.covariance_knee,
        spectrum_knee: PreprocessorConfig::DEFAULT.spectrum_knee,
        structure_knee: PreprocessorConfig::DEFAULT.structure_knee,
    };

    /// A file's recipe; the firmware's values where it has none.
    pub fn of(recipe: &ArrayRecipe) -> Self {
        let given = &recipe.features;
        let frames = |frames: &Option<toml::Spanned<u8>>, default: usize| {
            frames.as_ref().map_or(default, |frames| usize::from(*frames.get_ref()))
        };
        let window = frames(&given.window, Self::FIRMWARE.window);
        Self {
            lag: frames(&given.lag, Self::FIRMWARE.lag),
            window,
            // Figure 6 varies them together.
            spectrum: match window {
                1 => 10,
                2..=5 => 20,
                _ => 40,
            },
            covariance_knee: given.covariance_knee.unwrap_or(Self::FIRMWARE.covariance_knee),
            spectrum_knee: given.spectrum_knee.unwrap_or(Self::FIRMWARE.spectrum_knee),
            structure_knee: given.structure_knee.unwrap_or(Self::FIRMWARE.structure_knee),
        }
    }

    /// Readings before the first features.
    pub fn ready_after(&self) -> usize {
        (self.lag + self.window).max(self.spectrum).max(structure::READY_AFTER)
    }

    /// Bound of a difference, a power of two: the window's sum of products fits in an `i32`.
    fn d_max(&self) -> i32 {
        let most = (f64::from(i32::MAX) / self.window as f64).sqrt();
        1 << (most as u32).ilog2()
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sequence {
    pub session: String,
    pub material: String,
    pub part: Option<Part>,
    pub doing: Doing,
    /// Features of each step from the one on with which the windows are full.
    pub features: Vec<[i16; FEATURES]>,
    pub slips: Vec<bool>,
}

/// Equations 1 to 4, the transform and the structure functions, as the firmware computes them, over a whole recording. With a lag of 1
/// and a window of 10 they are those of [`Preprocessor`](tenax_logic::array::Preprocessor), bit for bit.
pub fn sequence(recording: &Recording, recipe: &Recipe) -> Sequence {
    let knees = (Knee::at(recipe.covariance_knee), Knee::at(recipe.spectrum_knee));
    let structure_knees = structure::knees(recipe.structure_knee);
    let (mut past, mut structure) = (Past::default(), Structure::default());
    let mut spectrum: Box<dyn Spectrum> = match recipe.spectrum {
        10 => Box::new(SlidingSpectrum::<10>::default()),
        20 => Box::new(SlidingSpectrum::<20>::default()),
        _ => Box::new(SlidingSpectrum::<SPECTRUM_WINDOW>::default()),
    };
    let mut sum = 0;
    let d_max = recipe.d_max();
    let mut differences = Vec::new();
    let mut covariance = [0i32; COVARIANCES];
    let (mut features, mut slips) = (Vec::new(), Vec::new());
    for (n, step) in recording.steps.iter().enumerate() {
        sum += past.push(&step.samples.map(Some)).change;
        spectrum.push(sum);
        structure.push(&past);
        differences.push(past.changes(recipe.lag).of.map(|change| change.clamp(-d_max, d_max - 1)));
        let new = differences[n];
        let old = n.checked_sub(recipe.window).map_or([0; ELEMENTS], |n| differences[n]);
        let pairs = (0..ELEMENTS).flat_map(|row| (row..ELEMENTS).map(move |other| (row, other)));
        for (entry, (row, other)) in covariance.iter_mut().zip(pairs) {
            *entry += new[row] * new[other] - old[row] * old[other];
        }
        if n + 1 < recipe.ready_after() {
            continue;
        }
        let mut row = [0; FEATURES];
        let (paper, structures) = row.split_at_mut(PAPER_FEATURES);
        let (covariances, bins) = paper.split_at_mut(COVARIANCES);
        for (feature, &entry) in covariances.iter_mut().zip(&covariance) {
            *feature = knees.0.signed(entry);
        }
        for (feature, power) in bins.iter_mut().zip(spectrum.powers()) {
            *feature = knees.1.of(power);
        }
        structure.compress(&structure_knees, structures);
        features.push(row);
        slips.push(step.slip);
    }
    Sequence {
        session: recording.session.clone(),
        material: recording.material.clone(),
        part: recording.part,
        doing: recording.doing,
        features,
        slips,
    }
}

/// A transform of one of the firmware's lengths.
trait Spectrum {
    fn push(&mut self, sum: i32);
    fn powers(&self) -> [f32; BINS];
}

impl<const SUMS: usize> Spectrum for SlidingSpectrum<SUMS> {
    fn push(&mut self, sum: i32) {
        Self::push(self, sum);
    }

    fn powers(&self) -> [f32; BINS] {
        Self::powers(self)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The diagonal of the covariance.
    Variance,
    Covariance,
    /// The spectrum of the sum.
    Bin,
    Structure,
}

/// The kind of a feature by its place; the covariance is its upper triangle, row by row.
pub fn kind_of(feature: usize) -> Kind {
    let is_diagonal = || (0..ELEMENTS).any(|row| row * ELEMENTS + row - row * (row + 1) / 2 == feature);
    match feature {
        PAPER_FEATURES.. => Kind::Structure,
        COVARIANCES.. => Kind::Bin,
        _ if is_diagonal() => Kind::Variance,
        _ => Kind::Covariance,
    }
}

/// Whether a feature says how much the elements move, rather than how they move together: that holds for other objects, too.
pub fn is_believed_first(feature: usize) -> bool {
    matches!(kind_of(feature), Kind::Variance | Kind::Structure)
}
