//! `tenax chart`: the charts behind the pages in `docs/`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::ValueEnum;
use tenax_frames::tool::{folder, format::Format, out, progress::with_bar, workspace};

use crate::chart::{Chart, delay, emg, front, photoelastic, table};

/// Recordings beside the checkout.
const RECORDINGS: &str = "../shared/data";

/// Draw the charts behind a page of docs/
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Subject of the charts
    #[arg(value_enum)]
    subject: Subject,
    /// Folder for SVG and CSV
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// photoelastic and table only: how to print the figures
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Subject {
    /// Newtons beyond need against millimetres slid, of each grip: the hand, each detector alone, all but each, no reflex,
    /// constant grip, the bound; and decision delay by stiffness by gain
    Front,
    /// Accuracy and latency of intent recognition on recorded people against false motions: the hand and plain control
    Emg,
    /// Slips caught, false alarms and processor time of each detector, pairs, the hand and plain rivals
    Table,
    /// Force, slip rate and the region in which slip is seen of a photoelastic head
    Photoelastic,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let folder = folder::made(&args.out)?;
    let charts: Vec<Chart> = match args.subject {
        Subject::Front => vec![
            with_bar("front", |progress| front::front(progress))?,
            with_bar("delay", |progress| delay::map(progress))?,
        ],
        Subject::Emg => vec![emg::chart(&workspace::root()?.join(RECORDINGS).join("myobock"))?],
        Subject::Table => {
            let costs = table::costs::Costs::measured()?;
            let table = with_bar("table", |progress| table::table(&table::PLANS, &costs, progress))?;
            out::unless_closed(args.report.show(&table))?;
            vec![table.chart()?]
        }
        Subject::Photoelastic => {
            let (chart, report) = with_bar("photoelastic", |progress| photoelastic::chart(progress))?;
            out::unless_closed(args.report.show(&report))?;
            vec![chart]
        }
    };
    for chart in charts {
        let path = folder.join(chart.name);
        super::write(&path.with_extension("svg"), chart.svg.as_bytes())?;
        super::write(&path.with_extension("csv"), chart.csv.as_bytes())?;
    }
    Ok(ExitCode::SUCCESS)
}
