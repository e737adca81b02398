//! `tenax dataset`: a labelled data set of the normal-force array.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};

use tenax_frames::tool::folder;
use tenax_frames::tool::out;
use tenax_frames::tool::progress::with_bar;
use crate::dataset::manifest::Manifest;
use crate::dataset::session::Sizes;
use crate::dataset::{Dataset, Label, Plan};

const EXAMPLES: &str = "\
Examples:
  tenax dataset                                    out/array_dataset.csv, and its manifest beside it
  tenax dataset --sessions 4 --out less.csv        a sixth as much
  tenax dataset --label marker --out marker.csv    labelled by the marker's moving averages, as in the paper";

/// Make a labelled data set of the normal-force array: Bamshad's collection method as scenes.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Seed of everything that is drawn: the same seed gives the same bytes
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Training sessions of each material; a quarter as many for validation, half as many for test
    #[arg(long, value_name = "N", default_value_t = Sizes::DEFAULT_TRAIN)]
    sessions: usize,
    /// Source of the labels
    #[arg(long, value_enum, default_value_t = Label::Truth)]
    label: Label,
    /// File for the data; its manifest (.toml) is written beside it
    #[arg(long, value_name = "FILE.csv", default_value = "out/array_dataset.csv")]
    out: PathBuf,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    if args.sessions == 0 {
        bail!("--sessions must be at least 1");
    }
    let Some(file) = args.out.file_name().map(|name| name.to_string_lossy().into_owned()) else {
        bail!("--out needs a file name, such as out/array_dataset.csv");
    };
    if args.out.extension().is_some_and(|extension| extension == "toml") {
        bail!("--out is the data's file, a .csv; the manifest goes beside it as .toml");
    }
    // What cannot be written is said now, not after minutes.
    if let Some(parent) = args.out.parent() {
        folder::made(if parent.as_os_str().is_empty() { Path::new(".") } else { parent })?;
    }
    let plan = Plan { seed: args.seed, sessions: args.sessions, label: args.label };
    let dataset = with_bar("sessions", |progress| Dataset::make(plan, progress))?;
    let csv = dataset.csv()?;
    let manifest = dataset.manifest(&file, &csv);
    let beside = args.out.with_extension("toml");
    let files = [(&args.out, csv), (&beside, toml::to_string(&manifest)?.into_bytes())];
    for (path, bytes) in &files {
        fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
    }
    print(&manifest)?;
    for (path, _) in files {
        out::note!("  {:<14}{}", "written", path.display());
    }
    Ok(ExitCode::SUCCESS)
}

fn print(manifest: &Manifest) -> anyhow::Result<()> {
    out::say!("data set of seed {}, SHA-256 {}", manifest.seed, manifest.sha256)?;
    for (split, counts) in &manifest.split {
        let percent = 100.0 * counts.slip_steps as f64 / counts.steps.max(1) as f64;
        out::say!(
            "  {:<14}{} sessions, {} steps, {percent:.1} % of them slip, {} slips, {} of {} recordings end in a fall",
            split.name(),
            counts.sessions,
            counts.steps,
            counts.slips,
            counts.dropped,
            counts.recordings
        )?;
    }
    out::say!("  {:<14}agrees with the world in {:.1} % of steps", "marker", manifest.marker_agrees_percent)?;
    Ok(())
}
