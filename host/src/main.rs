//! `tenax`: see `tenax --help`.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    tenax::cli::main()
}
