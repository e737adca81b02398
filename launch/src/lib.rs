//! What `cargo tenax` starts: it builds the tool and the image side by side, shows how far they are, and becomes the tool.
//!
//! The tool takes minutes to compile the first time, and cannot say so before it is compiled. The tool uses this library too:
//! to build the image when it is asked to, and to show how far a run is.
#![forbid(unsafe_code)]

mod cargo;
pub mod fresh;
pub mod image;
pub mod jobs;
pub mod status;
pub mod tool;
