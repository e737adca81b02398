//! `tenax evaluate`: intent recognition, scored on recordings of people; the hand in hours of disturbance.

use std::process::ExitCode;

use tenax_frames::tool::{format::Format, out, progress::with_bar};

use super::People;
use crate::evaluate::{disturbed, emg};

/// Score intent recognition on recordings of people, or the hand in hours of disturbance
#[derive(Debug, clap::Args)]
#[command(arg_required_else_help = true)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, clap::Subcommand)]
enum What {
    /// Score intent recognition on recorded EMG envelopes of two muscles
    Emg(EmgArgs),
    /// Count closings without need and false alarms in drawn hours of disturbance
    Disturbed(DisturbedArgs),
}

#[derive(Debug, clap::Args)]
struct DisturbedArgs {
    /// Hours, in holds of ten minutes; 48 take a night of one core or two
    #[arg(long, value_name = "H", default_value_t = 1)]
    hours: u32,
    /// What holds are drawn from: 1 to 999 are for choosing, others for scoring
    #[arg(long, value_name = "S", default_value_t = 1000)]
    seed: u64,
    /// How to print the report
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
}

#[derive(Debug, clap::Args)]
struct EmgArgs {
    #[command(flatten)]
    people: People,
    /// Only these people, by number
    #[arg(long, value_name = "P,P", value_delimiter = ',')]
    persons: Vec<u32>,
    /// Also score this many random electrode faults over people at rest
    #[arg(long, value_name = "N", default_value_t = 0)]
    faults: u32,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let shown = match &args.what {
        What::Emg(EmgArgs { people, persons, faults }) => {
            people.report.show(&emg::evaluate(&people.recordings, persons, *faults, people.seed)?)
        }
        What::Disturbed(DisturbedArgs { hours, seed, report }) => {
            let holds = hours * 60 / disturbed::MINUTES;
            report.show(&with_bar("disturbed", |told| disturbed::evaluate(*seed, holds, told))?)
        }
    };
    out::unless_closed(shown)?;
    Ok(ExitCode::SUCCESS)
}
