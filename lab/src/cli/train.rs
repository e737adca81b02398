//! `tenax train emg`: fits the wearer's model. The force array's network is trained in Python: `python -m tenax.train`.

use std::process::{Command, ExitCode};

use tenax_frames::tool::{out, progress::with_bar, workspace};

use super::People;
use crate::evaluate::fit;

#[derive(Debug, clap::Args)]
pub struct Args {
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
    let Args { people, rounds, ship } = args;
    let report = with_bar("fitting", |part| fit::fit(&people.recordings, *rounds, people.seed, part))?;
    out::unless_closed(people.report.show(&report))?;
    if *ship {
        let to = workspace::root()?.join("logic/src/emg/fitted.rs");
        super::write(&to, report.file.as_bytes())?;
        workspace::run(Command::new("rustfmt").args(["--edition", "2024"]).arg(&to))?;
    }
    Ok(ExitCode::SUCCESS)
}
