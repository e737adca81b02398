//! `tenax calibrate photoelastic`: an optical channel's curve from known weights.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail, ensure};
use tenax_hal_shim::channel::{REFERENCE_MV, SAMPLE_MAX};
use tenax_scene::Seeds;
use tenax_scene::sensor::photoelastic::curve::{Day, Making};

use tenax_frames::tool::{folder, out};
use crate::chart;
use crate::photoelastic::balance::{self, Calibration};

/// Fit a photoelastic head's curve to known weights; without --weights to a simulated head.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Simulate a head with optics drawn from this seed [default: mean optics]
    #[arg(long, conflicts_with = "weights")]
    seed: Option<u64>,
    /// Readings of a real head: columns `force_n` (N) and `level_mv` (mV at the pin), at least 20 rows of rising force, the
    /// first without load [default: simulated]
    #[arg(long, value_name = "CSV")]
    weights: Option<PathBuf>,
    /// Folder for the figure, the residuals (CSV) and the settings
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let folder = folder::made(&args.out)?;
    let calibration = match &args.weights {
        Some(path) => balance::fit(&read(path)?),
        None => {
            let seeds = Seeds::from(args.seed.unwrap_or(1));
            let making = args.seed.map_or(Making::MEAN, |_| Making::drawn(seeds, 0.2));
            balance::weigh(&making, &Day::FIRST, seeds)
        }
    };
    let settings = settings(&calibration)?;
    let chart = chart::photoelastic::residuals(&calibration)?;
    let files = [
        ("svg", chart.svg.as_bytes()),
        ("csv", chart.csv.as_bytes()),
        ("settings", settings.as_bytes()),
    ];
    out::unless_closed(out::say!(
        "{} weights, residuals {:.2} % of full scale at most",
        calibration.weighed.len(),
        calibration.worst_percent()
    ))?;
    out::unless_closed(out::print(format_args!("{settings}")))?;
    for (extension, bytes) in files {
        let path = folder.join(chart.name).with_extension(extension);
        fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
        out::unless_closed(out::say!("{}", path.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The settings that bring a calibration to a board, one a line.
fn settings(calibration: &Calibration) -> anyhow::Result<String> {
    let mut lines = String::new();
    for (id, value) in calibration.settings() {
        let row = id.row();
        ensure!(row.range().contains(&value), "{} = {value} is outside {:?}", row.name, row.range());
        lines.push_str(&format!("{}={value}\n", row.name));
    }
    Ok(lines)
}

/// Forces and levels (1/16 of a sample) of a bench.
fn read(path: &Path) -> anyhow::Result<Vec<(f64, f64)>> {
    let mut reader =
        csv::Reader::from_path(path).with_context(|| format!("cannot read {}", path.display()))?;
    let headers = reader.headers()?.clone();
    let column = |name: &str| {
        headers
            .iter()
            .position(|header| header == name)
            .with_context(|| format!("{} has no column `{name}`", path.display()))
    };
    let (force, level) = (column("force_n")?, column("level_mv")?);
    let mut levels = Vec::new();
    for (n, row) in reader.records().enumerate() {
        let row = row?;
        let number = |column: usize| {
            let text = row.get(column).unwrap_or_default().trim();
            text.parse::<f64>()
                .with_context(|| format!("{}, row {}: `{text}` is no number", path.display(), n + 2))
        };
        let q4_per_mv = 16.0 * f64::from(SAMPLE_MAX) / f64::from(REFERENCE_MV);
        levels.push((number(force)?, number(level)? * q4_per_mv));
    }
    if levels.len() < 20 || levels.windows(2).any(|two| two[1].0 <= two[0].0) {
        bail!("{}: at least 20 weights are needed, in rising order, the first without load", path.display());
    }
    Ok(levels)
}
