//! The command line of the serial tools, a file a subcommand; the whole tool takes each from here.

pub mod bringup;
pub mod calibrate;
pub mod config;
pub mod flash;
pub mod monitor;
pub mod out;
pub mod play;
pub mod port;
pub mod record;
pub mod selftest;
pub mod workspace;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::{settings, wiring};

/// Watches, records, plays and sets up a Tenax fingertip over its serial line.
#[derive(Debug, Parser)]
#[command(name = "tenax", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Calibrate a sensor or the wearer's muscles, step by step
    Calibrate(calibrate::Args),
    #[command(flatten)]
    Shared(Shared),
}

/// What the whole tool has as it is.
#[derive(Debug, Subcommand)]
pub enum Shared {
    /// Flash a NUCLEO-F411RE through probe-rs
    Flash(flash::Args),
    /// Measure a step of bring-up on a board
    BringUp(bringup::Args),
    /// Touch every sensor in turn; say which wire is wrong
    Selftest(selftest::Args),
    /// Watch a board: a screen, or one line a message
    Monitor(monitor::Args),
    /// Record a board's line
    Record(record::Args),
    /// Play a recording: serve its line, or write it as CSV
    Play(play::Args),
    /// Show and change a board's settings
    Config(config::Args),
    /// Print the channel map as a Markdown table
    Wiring,
    /// Print every setting with unit, range, default and meaning as a Markdown table
    Settings,
}

/// Runs the command line. 0: done. 2: it could not be run.
pub fn main() -> ExitCode {
    exit(match Cli::parse().command {
        Command::Calibrate(args) => calibrate::main(&args),
        Command::Shared(command) => command.run(),
    })
}

impl Shared {
    pub fn run(&self) -> anyhow::Result<ExitCode> {
        match self {
            Self::Flash(args) => flash::main(args),
            Self::BringUp(args) => bringup::main(args),
            Self::Selftest(args) => selftest::main(args),
            Self::Monitor(args) => monitor::main(args),
            Self::Record(args) => record::main(args),
            Self::Play(args) => play::main(args),
            Self::Config(args) => config::main(args),
            Self::Wiring => page(&wiring::markdown()),
            Self::Settings => page(&settings::markdown()),
        }
    }
}

fn page(text: &str) -> anyhow::Result<ExitCode> {
    out::print(format_args!("{text}"))?;
    Ok(ExitCode::SUCCESS)
}

/// What a command that has ended exits with; says what went wrong.
pub fn exit(done: anyhow::Result<ExitCode>) -> ExitCode {
    match done {
        Ok(code) => code,
        // Whoever read our output has read enough.
        Err(error) if error.is::<out::Closed>() => ExitCode::SUCCESS,
        Err(error) => {
            out::note!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_well_formed() {
        Cli::command().debug_assert();
    }
}
