//! `tenax-sim`: see `cargo tenax --help`.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    tenax_sim::cli::main()
}
