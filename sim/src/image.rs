//! The image for the microcontroller: building it, and reading what it says about itself.

pub mod size;
pub mod symbols;

pub use tenax_frames::tool::image::{TARGET, build};
