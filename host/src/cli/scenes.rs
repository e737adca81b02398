//! `tenax scenes`: what there is to run.

use std::process::ExitCode;

pub fn main() -> anyhow::Result<ExitCode> {
    anyhow::bail!("not yet")
}
