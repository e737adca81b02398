//! `tenax-lab`: see `cargo tenax --help`.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    tenax_lab::cli::main()
}
