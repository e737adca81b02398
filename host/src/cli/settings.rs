//! `tenax settings`: prints `docs/settings.md`.

use std::process::ExitCode;

pub fn main() -> anyhow::Result<ExitCode> {
    print!("{}", crate::settings::markdown());
    Ok(ExitCode::SUCCESS)
}
