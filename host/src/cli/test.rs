//! `tenax test`: every test of the workspace, and their sum.

mod sum;

use std::process::ExitCode;

use anyhow::Context;
use sum::Sum;

use tenax_launch::image::{Binary, job};
use tenax_launch::jobs;

use super::{out, workspace};
use crate::safety::RESULTS;
use crate::suite;

/// Run every test of the workspace, the emulated ones included.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Arguments for `cargo test`, after --
    #[arg(last = true)]
    extra: Vec<String>,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    // Before the tests, so that its messages are seen and what is to be installed is said once.
    jobs::run(vec![job(
        &workspace::root()?,
        &[Binary::Image, Binary::Kernels, Binary::Frames, Binary::Pictures],
    )])?;
    let mut sum = Sum::default();
    // All are run even if one fails: a person wants to know of all that is broken.
    sum.run(suite::all().arg("--no-fail-fast").args(&args.extra))?;
    if args.extra.is_empty() {
        // For `tenax safety --tested`.
        let path = workspace::root()?.join(RESULTS);
        std::fs::write(&path, &sum.results).with_context(|| format!("cannot write {}", path.display()))?;
    }
    out::say!("{sum}")?;
    Ok(if sum.good() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
