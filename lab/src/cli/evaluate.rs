//! `tenax evaluate emg`: intent recognition, scored on recordings of people.

use std::process::ExitCode;

use tenax_frames::tool::out;

use super::People;
use crate::evaluate::emg;

#[derive(Debug, clap::Args)]
pub struct Args {
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
    let Args { people, persons, faults } = args;
    let report = emg::evaluate(&people.recordings, persons, *faults, people.seed)?;
    out::unless_closed(people.report.show(&report))?;
    Ok(ExitCode::SUCCESS)
}
