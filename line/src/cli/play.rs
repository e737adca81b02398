//! `tenax play`: a recording's values as CSV.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context;
use tenax_frames::link::Captured;
use tenax_frames::record::csv;
use tenax_frames::tool::out;

const EXAMPLES: &str = "\
Examples:
  tenax play hand.mcap --csv tables            CSV files in the folder tables
Each begins with three times, in s: `time_s` goes on when the board starts again, `board_s` counts from its start, `host_s` is
the recording computer's since 1970.
`tenax monitor --file FILE` plays a recording on the page, which scrubs, loops and pauses it.";

/// Write a recording as CSV.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// A recording (MCAP) or a captured line
    file: PathBuf,
    /// Folder of the CSV files, one for each topic
    #[arg(long, value_name = "DIR")]
    csv: PathBuf,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let paths = csv::export(&Captured::open(&args.file)?, &args.csv);
    for path in paths.with_context(|| format!("cannot write to the folder {}", args.csv.display()))? {
        out::note!("  {:<14}{}", "written", path.display());
    }
    Ok(ExitCode::SUCCESS)
}
