//! `tenax evaluate emg`: intent recognition, scored on recordings of people.

use std::process::ExitCode;

use tenax_frames::tool::out;

use super::People;
use crate::evaluate::emg;

/// Score intent recognition on recordings of people
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
    let What::Emg(EmgArgs { people, persons, faults }) = &args.what;
    let report = emg::evaluate(&people.recordings, persons, *faults, people.seed)?;
    out::unless_closed(people.report.show(&report))?;
    Ok(ExitCode::SUCCESS)
}
