//! `tenax chart`: the charts behind the pages in `docs/`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Context;
use clap::ValueEnum;

use tenax_frames::tool::folder;
use tenax_frames::tool::format::Format;
use tenax_frames::tool::out;
use tenax_frames::tool::progress::with_bar;
use tenax_frames::tool::workspace;
use tenax_sim::plot::png;
use crate::chart;

/// Where the recordings are, beside the checkout.
const RECORDINGS: &str = "../shared/data";

/// Draw charts.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Subject of the charts
    #[arg(value_enum)]
    subject: Subject,
    /// Folder for SVG, PNG and CSV
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// levels, photoelastic and table only: how to print the figures
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
    /// table only: rows of your own, with your detector's reports (docs/table.md)
    #[arg(long, value_name = "CSV")]
    decisions: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Subject {
    /// How the force array's network does against each quantity that sessions draw: where the method fails
    Array,
    /// What each grip pays in newtons beyond need for what it saves in millimetres: the hand, each detector alone, all but each, no
    /// reflex, constant grip, the bound; and decision delay by stiffness by gain
    Front,
    /// What each level of contact changes of every scene's outcome, and what it costs
    Levels,
    /// How well the wearer is understood on recorded people, and how late, against false motions: the hand and plain control
    Emg,
    /// What each detector catches and costs, pairs, the hand and plain rivals beside it, on the same fingertips and hours
    Table,
    /// What a photoelastic head tells of normal force and slip: its curve, force followed, rates, where slip is seen
    Photoelastic,
    /// What a camera behind the skin tells: known loads on a recording; where drawn sessions get too hard
    Vision,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let folder = folder::made(&args.out)?;
    let charts = match args.subject {
        Subject::Array => vec![with_bar("array", |progress| chart::array::chart(progress))?],
        Subject::Front => {
            let front = with_bar("front", |progress| chart::front::front(progress))?;
            vec![front, with_bar("delay", |progress| chart::delay::map(progress))?]
        }
        Subject::Levels => {
            let (chart, report) = with_bar("levels", |progress| chart::levels::chart(progress))?;
            out::unless_closed(args.report.show(&report))?;
            vec![chart]
        }
        Subject::Vision => {
            let folder = workspace::root()?.join(RECORDINGS).join("fingervision");
            vec![
                with_bar("loads", |progress| chart::loads::chart(&folder.join("loads.csv"), progress))?,
                with_bar("failures", |progress| chart::vision::failures(progress))?,
            ]
        }
        Subject::Emg => {
            let people = workspace::root()?.join(RECORDINGS).join("myobock");
            vec![with_bar("emg", |progress| chart::emg::chart(&people, progress))?]
        }
        Subject::Table => {
            let own = args.decisions.as_deref().map(decided).transpose()?.unwrap_or_default();
            let costs = chart::table::costs::Costs::counted(&workspace::root()?)?;
            let options = chart::table::Options::default();
            let mut table = with_bar("table", |progress| chart::table::table(&options, &costs, progress))?;
            table.rows.extend(own);
            out::unless_closed(args.report.print(&table, &table))?;
            vec![table.chart()?]
        }
        Subject::Photoelastic => {
            let (chart, report) = with_bar("photoelastic", |progress| chart::photoelastic::chart(progress))?;
            out::unless_closed(args.report.show(&report))?;
            vec![chart]
        }
    };
    let is_for_programs = args.report == Format::Json;
    for chart in charts {
        let files =
            [("svg", chart.svg.as_bytes()), ("png", &png::png(&chart.svg)?), ("csv", chart.csv.as_bytes())];
        for (extension, bytes) in files {
            let path = folder.join(chart.name).with_extension(extension);
            fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
            if is_for_programs {
                out::note!("{}", path.display());
            } else {
                out::unless_closed(out::say!("{}", path.display()))?;
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// A stranger's rows.
fn decided(file: &Path) -> anyhow::Result<Vec<chart::table::Line>> {
    let called = file.display().to_string();
    let text = fs::read_to_string(file).with_context(|| format!("cannot read {called}"))?;
    chart::table::decisions::rows(&text, &called)
}
