//! `tenax`, the serial tools alone: see `tenax --help`.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    tenax_line::cli::main()
}
