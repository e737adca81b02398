//! The Hebbian network, which learns slip from a camera (Tada 2006, equations 1 to 6; limits in
//! `docs/hebbian.md`), in integers: tactile nodes t_j ([`activations`]), weights w_ij ([`network`]), outputs
//! o_i, codes v_i ([`teacher`]).
//!
//! ```text
//! o_i   = f(sum_j t_j w_ij + v_i)                            (3), f clips at +-1 (4)
//! dw_ij = alpha r_ij t_j v_i - beta w_ij                     (5)
//! r_ij  = (|w_ij| + delta) / ((sum_j |w_ij|) + delta)        (6)
//! ```

pub mod activations;
mod arithmetic;
pub mod detector;
pub mod gains;
pub mod network;
mod noise;
mod pvdf_part;
pub mod rule;
pub mod settings;
pub mod snapshot;
pub mod teacher;

pub use activations::{Activation, Activations, Normaliser, NormaliserConfig, Sense};
pub use detector::{HebbianDetector, Learned, NORMALISER, SNAPSHOT_LENGTH};
pub use gains::Gains;
pub use network::{Network, Output, Weight};
pub use rule::{Config, Config as LearningConfig, Rule};
pub use teacher::Teacher;
/// 12 vibration, 12 pressure (Tada 2006, section III.A); relative motion (o1) and direction (o2).
pub use tenax_hal_shim::wire::{NETWORK_OUTPUTS as OUTPUTS, RECEPTORS};
pub use tenax_hal_shim::words::{Code, Codes, NoLesson};

pub type FingertipNetwork = Network<RECEPTORS, OUTPUTS>;
