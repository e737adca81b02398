//! `tenax chart`: the charts behind the pages in `docs/`.

use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use anyhow::Context;
use clap::ValueEnum;

use super::progress::Progress;
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
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Subject {
    /// How the scenes' friction is stepped: where each method fails, and what it costs
    Scenes,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let Subject::Scenes = args.subject;
    let progress = Mutex::new(Progress::new("charts", 1.0));
    let charts = chart::scenes(&|part| {
        // A bar that a panicking thread left is still a bar.
        progress.lock().unwrap_or_else(PoisonError::into_inner).at(part);
    })?;
    drop(progress);
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
