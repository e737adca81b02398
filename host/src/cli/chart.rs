//! `tenax chart`: the charts behind the pages in `docs/`.

use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use anyhow::Context;
use clap::ValueEnum;

use super::progress::Progress;
use super::workspace;
use crate::chart;
use crate::plot::png;

/// Draw charts.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// What of
    #[arg(value_enum)]
    subject: Subject,
    /// Where they are written: SVG, PNG and CSV
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Where the recordings are [default: shared/data beside the checkout]
    #[arg(long, value_name = "DIR")]
    recordings: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Subject {
    /// How the scenes' friction is stepped: where each method fails, and what it costs
    Scenes,
    /// What the scenes' sensors say at the onset of slip, beside real recordings where they are present
    Sensors,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let charts = match args.subject {
        Subject::Scenes => scenes()?,
        Subject::Sensors => {
            let recordings = match &args.recordings {
                Some(folder) => folder.clone(),
                None => workspace::root()?.join("../shared/data"),
            };
            vec![chart::sensors::chart(&recordings)?]
        }
    };
    fs::create_dir_all(&args.out).with_context(|| format!("cannot make {}", args.out.display()))?;
    for chart in charts {
        let files =
            [("svg", chart.svg.as_bytes()), ("png", &png::png(&chart.svg)?), ("csv", chart.csv.as_bytes())];
        for (extension, bytes) in files {
            let path = args.out.join(chart.name).with_extension(extension);
            fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
            println!("{}", path.display());
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn scenes() -> anyhow::Result<Vec<chart::Chart>> {
    let progress = Mutex::new(Progress::new("charts", 1.0));
    chart::scenes(&|part| {
        // A bar that a panicking thread left is still a bar.
        progress.lock().unwrap_or_else(PoisonError::into_inner).at(part);
    })
}
