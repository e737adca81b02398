//! Slip from ten elements that measure normal force only (Bamshad 2023).
//!
//! Sliding moves load from element to element while the sum stays the same. So the changes of the elements' forces from one
//! slow frame to the next are correlated ([`covariance`], equations 1 to 4), and the sum of
//! all forces is transformed ([`spectrum`]): the paper's 76 numbers. Structure functions
//! ([`structure`]) show the speed of sliding. Together they are 112 [`Features`] ([`preprocess`]), the inputs of a small
//! network ([`network`]); [`detector`] turns its logit into a verdict with hysteresis.
//!
//! | step | exact on every machine because | range |
//! |---|---|---|
//! | difference, covariance | integers | +-d_max, 10 d_max^2 below 2^31 |
//! | spectrum | integers: one term in, one term out | below 2^53 |
//! | structure functions | integers | `u32` |
//! | features | [`logarithm`]: single precision, no operation of which is fused or reordered | `i16` |
//! | network | integers, sums that cannot overflow by construction | `i32` |
//!
//! Both transforms slide: a slow frame costs only the change by its new reading. In integers this is exact, so
//! nothing drifts over time.

mod adapter;
pub mod covariance;
pub mod detector;
pub mod dual;
pub mod logarithm;
pub mod network;
pub mod past;
pub mod preprocess;
pub mod shipped;
pub mod specimen;
pub mod spectrum;
pub mod structure;
pub mod taxels;

use tenax_hal_shim::channel::ARRAY_COUNT;
use tenax_hal_shim::schedule::{Job, slot_of};

pub use adapter::MlpDetector;
pub use detector::{ArrayDetector, ArrayVerdict, Judgement, Model};
pub use network::{Layer, LookBack, Mlp, TooLarge};
pub use preprocess::{Features, Preprocessor, PreprocessorConfig};

/// The slot in which every element has been read.
pub const ARRAY_READ: u8 = slot_of(Job::ArrayBegins);
/// The slot in which the network decides.
pub const MLP_DECIDES: u8 = slot_of(Job::MlpDecides);

/// Elements of the array: two pads of five (Bamshad 2023, section 2.1).
pub const ELEMENTS: usize = ARRAY_COUNT;
/// Entries of a symmetric matrix of [`ELEMENTS`] rows.
pub const COVARIANCES: usize = ELEMENTS * (ELEMENTS + 1) / 2;
/// Frequencies of [`SPECTRUM_WINDOW`] real samples, 0 Hz to 40 Hz in steps of 2 Hz.
pub const BINS: usize = SPECTRUM_WINDOW / 2 + 1;
/// Numbers that the paper's network sees of one slow frame (Bamshad 2023, section 5.3).
pub const PAPER_FEATURES: usize = COVARIANCES + BINS;
/// Numbers that the network sees of one slow frame.
pub const FEATURES: usize = PAPER_FEATURES + structure::STRUCTURES;
/// Differences in the covariance (Bamshad 2023, section 4.2).
pub const COVARIANCE_WINDOW: usize = 10;
/// Samples in the spectrum (Bamshad 2023, section 4.3).
pub const SPECTRUM_WINDOW: usize = 40;

/// One reading of every element, 14-bit samples; None for an element without a valid one.
pub type Reading = [Option<u16>; ELEMENTS];

/// The type of the shipped detector.
pub type ShippedDetector = ArrayDetector<'static, 32, 1, 16>;

impl Default for ShippedDetector {
    /// A detector without readings.
    fn default() -> Self {
        Self::new(&shipped::MODEL)
    }
}
