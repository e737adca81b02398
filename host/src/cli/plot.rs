//! `tenax plot`: a recording as a figure.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context;

use super::out;
use tenax_bench::session;
use tenax_plot::{draw, png};
use tenax_serial::link::captured::line_of;

/// Draw a recording.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A recording (MCAP) or a captured line
    file: PathBuf,
    /// The figure, without its extension: an SVG and a PNG are written [default: beside the recording]
    #[arg(long, value_name = "PATH")]
    out: Option<PathBuf>,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let name = session::name_of(&args.file);
    let outcome = session::recorded(&name, &line_of(&args.file)?)?;
    let path = args.out.clone().unwrap_or_else(|| args.file.with_extension(""));
    let svg = draw::svg(&outcome.figure)?;
    for (extension, bytes) in [("png", png::png(&svg)?), ("svg", svg.into_bytes())] {
        let path = path.with_extension(extension);
        std::fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
        out::note!("  {:<14}{}", "written", path.display());
    }
    Ok(ExitCode::SUCCESS)
}
