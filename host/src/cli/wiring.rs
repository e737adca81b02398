//! `tenax wiring`: prints `docs/wiring.md`.

use std::process::ExitCode;

pub fn main() -> anyhow::Result<ExitCode> {
    print!("{}", crate::wiring::markdown());
    Ok(ExitCode::SUCCESS)
}
