//! The whole `tenax` tool: the command line that joins serial tools, bench and studies, and the promises that it checks.
//!
//! Here lives a file for each command that is not the serial tools' alone, and a file for each promise of `tenax check`.
//! A command reads its arguments, calls one of the crates below, and prints what they give; it works nothing out.
//! What a command of the serial tools takes is defined in `tenax-serial` and used from there.
//! Nothing depends on this crate; what a test or a study wants of it belongs below.
//! Its binary is `tenax-host` in the target folder, where `tenax` is the serial tools'; `cargo tenax` starts the one that it takes.
#![forbid(unsafe_code)]

pub mod check;
pub mod cli;
pub mod safety;
mod suite;
