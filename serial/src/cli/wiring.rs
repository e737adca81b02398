//! `tenax wiring`: prints `docs/wiring.md`.

use std::process::ExitCode;

use super::out;

pub fn main() -> anyhow::Result<ExitCode> {
    out::print(format_args!("{}", crate::wiring::markdown()))?;
    Ok(ExitCode::SUCCESS)
}
