//! `tenax train emg`: fits the wearer's model. The force array's network is trained in Python: `python -m tenax.train`.

use std::process::{Command, ExitCode};

use tenax_frames::tool::{out, progress::with_bar, workspace};

use super::People;
use crate::evaluate::fit;

const EXAMPLES: &str = "\
Examples:
  tenax train emg --recordings FOLDER    the constants of intent recognition, leaving out each person once

The force array's network: python -m tenax.train --help (docs/array.md).";

/// Fit intent recognition to recordings of people
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, arg_required_else_help = true)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, clap::Subcommand)]
enum What {
    /// Fit intent recognition to recorded EMG envelopes of people
    Emg(EmgArgs),
}

#[derive(Debug, clap::Args)]
struct EmgArgs {
    #[command(flatten)]
    people: People,
    /// Rounds of the search; each takes 0.1 s a person
    #[arg(long, value_name = "N", default_value_t = 600)]
    rounds: u32,
    /// Write the constants into the firmware's source
    #[arg(long)]
    ship: bool,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let What::Emg(EmgArgs { people, rounds, ship }) = &args.what;
    let report = with_bar("fitting", |part| fit::fit(&people.recordings, *rounds, people.seed, part))?;
    out::unless_closed(people.report.show(&report))?;
    if *ship {
        let to = workspace::root()?.join("logic/src/emg/fitted.rs");
        super::write(&to, report.file.as_bytes())?;
        workspace::run(Command::new("rustfmt").args(["--edition", "2024"]).arg(&to))?;
    }
    Ok(ExitCode::SUCCESS)
}
