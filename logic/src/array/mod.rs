//! Slip felt by ten elements that know normal force only (Bamshad 2023).
//!
//! Sliding moves load from element to element while the whole stays the same. So what each element's force does from one
//! slow frame to the next is compared with what every other's does ([`covariance`], equations 1 to 4), and the force of
//! all of them is looked at by frequency ([`spectrum`]): the paper's 76 numbers. How soon an element's force forgets
//! ([`structure`]) tells how fast something slides. Together they are 112 [`Features`] ([`preprocess`]), on which a small
//! network ([`network`]) says whether the object slips, and [`detector`] says it without flicker.
//!
//! | step | exact on every machine because | range |
//! |---|---|---|
//! | difference, covariance | integers | +-d_max, 10 d_max^2 below 2^31 |
//! | spectrum | integers: one term in, one term out | below 2^53 |
//! | structure functions | integers | `u32` |
//! | features | [`logarithm`]: single precision, no operation of which is fused or reordered | `i16` |
//! | network | integers, sums that cannot overflow by construction | `i32` |
//!
//! Both transforms slide: a slow frame costs what its one new reading changes, and since integers come and go without a
//! remainder, they say after a year what they would say after a second.

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

/// One reading of every element, 14-bit samples; None where an element has no believable one.
pub type Reading = [Option<u16>; ELEMENTS];

/// The detector that ships.
pub type ShippedDetector = ArrayDetector<'static, 32, 1, 16>;

impl Default for ShippedDetector {
    /// One that has read nothing.
    fn default() -> Self {
        Self::new(&shipped::MODEL)
    }
}
