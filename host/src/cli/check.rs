//! `tenax check`: every promise, measured.

use std::process::ExitCode;

/// Measure every promise.
#[derive(Debug, clap::Args)]
pub struct Args {}

pub fn main(_args: &Args) -> anyhow::Result<ExitCode> {
    anyhow::bail!("not yet")
}
