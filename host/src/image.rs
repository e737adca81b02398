//! The image for the microcontroller: building it, and reading what it says about itself.

pub mod symbols;
