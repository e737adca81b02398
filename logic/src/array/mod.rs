//! Slip from ten elements that measure normal force only (Bamshad 2023): features, a small network, a verdict with hysteresis.
//!
//! | step | exact on every machine because | range |
//! |---|---|---|
//! | difference, covariance | integers | +-d_max, 10 d_max^2 below 2^31 |
//! | spectrum | integers: one term in, one term out | below 2^53 |
//! | structure functions | integers | `u32` |
//! | features | [`logarithm`]: single precision, no operation fused or reordered | `i16` |
//! | network | integers, sums that cannot overflow by construction | `i32` |

pub mod covariance;
pub mod detector;
pub mod logarithm;
pub mod network;
pub mod past;
pub mod preprocess;
pub mod shipped;
pub mod spectrum;
pub mod structure;
pub mod taxels;

use tenax_hal_shim::channel::ARRAY_COUNT;
use tenax_hal_shim::schedule::{Job, slot_of};

pub use detector::{ArrayDetector, ArrayVerdict, Judgement, Model};
pub use network::{Layer, Mlp, TooLarge};
pub use preprocess::{Features, Preprocessor, PreprocessorConfig};
pub use tenax_smlad::Aligned;

pub const ARRAY_READ: u8 = slot_of(Job::ArrayBegins);
pub const MLP_DECIDES: u8 = slot_of(Job::MlpDecides);
/// Two pads of five (Bamshad 2023, section 2.1).
pub const ELEMENTS: usize = ARRAY_COUNT;
pub const COVARIANCES: usize = ELEMENTS * (ELEMENTS + 1) / 2;
/// 0 Hz to 40 Hz in steps of 2 Hz.
pub const BINS: usize = SPECTRUM_WINDOW / 2 + 1;
pub const PAPER_FEATURES: usize = COVARIANCES + BINS;
pub const FEATURES: usize = PAPER_FEATURES + structure::STRUCTURES;
pub const HIDDEN: [usize; 2] = [32, 16];
/// Differences in the covariance (Bamshad 2023, section 4.2).
pub const COVARIANCE_WINDOW: usize = 10;
/// Samples in the spectrum (Bamshad 2023, section 4.3).
pub const SPECTRUM_WINDOW: usize = 40;
/// 14-bit samples; None for an element without a valid one.
pub type Reading = [Option<u16>; ELEMENTS];
pub type ShippedDetector = ArrayDetector<'static>;

impl Default for ShippedDetector {
    fn default() -> Self {
        Self::new(&shipped::MODEL)
    }
}
