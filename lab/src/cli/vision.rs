//! `tenax vision`: the camera behind the skin, on drawn sessions.

use std::process::ExitCode;

use anyhow::ensure;
use tenax_frames::tool::format::Format;

use crate::vision::score;

/// Follow skin and object in drawn sessions of a camera behind a clear skin, scored against their truth.
/// Videos and cameras: python -m tenax.camera --help
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Seed of the drawn scenes
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of drawn sessions
    #[arg(long, value_name = "N", default_value_t = 3)]
    sessions: u64,
    /// How to report
    #[arg(long, value_enum, default_value = "text")]
    report: Format,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    ensure!(args.sessions > 0, "--sessions must be at least 1");
    args.report.show(&score(args.seed, args.sessions)?)?;
    Ok(ExitCode::SUCCESS)
}
