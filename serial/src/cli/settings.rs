//! `tenax settings`: prints `docs/settings.md`.

use std::process::ExitCode;

use super::out;

pub fn main() -> anyhow::Result<ExitCode> {
    out::print(format_args!("{}", crate::settings::markdown()))?;
    Ok(ExitCode::SUCCESS)
}
