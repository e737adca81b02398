//! `tenax plot`: a recording as a figure.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context;

use crate::plot::sheet::draw;
use crate::session;
use tenax_frames::link::Captured;
use tenax_frames::tool::out;

const EXAMPLES: &str = "\
Examples:
  tenax plot grasp.mcap                     grasp.svg beside the recording
  tenax plot out/glass.line.bin --out glass.svg";

/// Draw a recording.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// A recording (MCAP) or a captured line
    file: PathBuf,
    /// The figure, an SVG [default: beside the recording]
    #[arg(long, value_name = "PATH")]
    out: Option<PathBuf>,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let name = session::name_of(&args.file);
    let outcome = session::recorded(&name, &Captured::open(&args.file)?)?;
    let path = args.out.clone().unwrap_or_else(|| args.file.with_extension("svg"));
    std::fs::write(&path, draw::svg(&outcome.figure)?)
        .with_context(|| format!("cannot write {}", path.display()))?;
    out::note!("  {:<14}{}", "written", path.display());
    Ok(ExitCode::SUCCESS)
}
