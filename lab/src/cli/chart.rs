//! `tenax chart`: the charts behind the pages in `docs/`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::ValueEnum;
use tenax_frames::tool::{folder, format::Format, out, progress::with_bar, workspace};

use crate::chart::{Chart, emg, front, table};

/// Recordings of people, beside the checkout.
const RECORDINGS: &str = "../shared/data/myobock";

/// Draw the charts behind a page of docs/
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Subject of the charts
    #[arg(value_enum)]
    subject: Subject,
    /// front and emg only: folder for SVG and CSV
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// front only: drawn worlds, and what they are drawn from
    #[arg(long, value_name = "N", default_value_t = 200)]
    worlds: u32,
    #[arg(long, value_name = "S", default_value_t = 1000)]
    seed: u64,
    /// table only: how to print the figures
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Subject {
    /// Newtons beyond need against losses and millimetres on drawn worlds: the hand, rival controllers, no reflex, constant
    /// grips, a causal oracle, the bound
    Front,
    /// Accuracy and latency of intent recognition on recorded people against false motions: the hand and plain control
    Emg,
    /// Slips caught and false alarms of each detector, pairs, the hand and plain rivals, as a report
    Table,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let chart: Chart = match args.subject {
        Subject::Front => with_bar("front", |progress| front::front(args.seed, args.worlds, progress))?,
        Subject::Emg => emg::chart(&workspace::root()?.join(RECORDINGS))?,
        Subject::Table => {
            let table = with_bar("table", |progress| table::table(&table::PLANS, progress))?;
            out::unless_closed(args.report.show(&table))?;
            return Ok(ExitCode::SUCCESS);
        }
    };
    let path = folder::made(&args.out)?.join(chart.name);
    super::write(&path.with_extension("svg"), chart.svg.as_bytes())?;
    super::write(&path.with_extension("csv"), chart.csv.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}
