//! `tenax size`: what the image takes.

use std::process::ExitCode;

pub fn main() -> anyhow::Result<ExitCode> {
    anyhow::bail!("not yet")
}
