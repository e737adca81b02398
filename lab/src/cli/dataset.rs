//! `tenax dataset`: a labelled data set of the normal-force array.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::bail;
use tenax_frames::tool::{folder, format::Format, out, progress::with_bar};

use crate::dataset::{Dataset, Plan, session::Sizes};

const EXAMPLES: &str = "\
Examples:
  tenax dataset                                    out/array_dataset.csv, and its manifest beside it
  tenax dataset --sessions 4 --out less.csv        a sixth as much";

/// Make a labelled data set of the normal-force array
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Seed of everything that is drawn: the same seed gives the same bytes
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Training sessions of each material; a quarter as many for validation, half as many for test
    #[arg(long, value_name = "N", default_value_t = Sizes::DEFAULT_TRAIN)]
    sessions: usize,
    /// File for the data; its manifest (.toml) is written beside it
    #[arg(long, value_name = "FILE.csv", default_value = "out/array_dataset.csv")]
    out: PathBuf,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    if args.sessions == 0 {
        bail!("--sessions must be at least 1");
    }
    make(Plan { seed: args.seed, sessions: args.sessions }, &args.out)?;
    Ok(ExitCode::SUCCESS)
}

/// Makes a data set, writes it and its manifest, and prints the manifest's counts. Fails if a file cannot be written.
fn make(plan: Plan, file: &Path) -> anyhow::Result<()> {
    let Some(name) = file.file_name().map(|name| name.to_string_lossy().into_owned()) else {
        bail!("--out needs a file name, such as out/array_dataset.csv");
    };
    if file.extension().is_some_and(|extension| extension == "toml") {
        bail!("--out is the data's file, a .csv; the manifest goes beside it as .toml");
    }
    // A folder that cannot be written to is reported before minutes of work.
    if let Some(parent) = file.parent() {
        folder::made(if parent.as_os_str().is_empty() { Path::new(".") } else { parent })?;
    }
    let dataset = with_bar("sessions", |progress| Dataset::make(plan, None, progress))?;
    let csv = dataset.csv()?;
    let manifest = dataset.manifest(&name, &csv);
    super::write(file, &csv)?;
    super::write(&file.with_extension("toml"), toml::to_string(&manifest)?.as_bytes())?;
    out::unless_closed(Format::Text.show(&manifest.split))
}
