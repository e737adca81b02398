//! The command line, a file a subcommand.

mod balance;
mod chart;
mod check;
mod dataset;
mod evaluate;
mod learn;
mod people;
mod train;
mod train_network;
mod vision;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use tenax_frames::tool::exit;

/// The papers' studies, and every promise measured.
#[derive(Debug, Parser)]
#[command(name = "tenax", bin_name = "tenax", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Measure every promise of the project, one line each; fails if one is not kept
    Check(check::Args),
    /// Teach the Hebbian network slip with a camera, and score it
    Learn(learn::Args),
    /// Make a labelled data set of the normal-force array
    Dataset(dataset::Args),
    /// Train the force array's slip detector from labelled recordings
    Train(train::Args),
    /// Score the array's network on held-out data, or the whole hand in the paper's tasks
    Evaluate(evaluate::Args),
    /// Draw the charts behind a page of docs/
    Chart(chart::Args),
    /// Follow skin and object with a camera behind a clear skin, or calibrate its force
    Vision(vision::Args),
}

/// Runs the command line. 0: done. 1: something measured is not as promised. 2: it could not be run.
pub fn main() -> ExitCode {
    exit(match Cli::parse().command {
        Command::Check(args) => check::main(&args),
        Command::Learn(args) => learn::main(&args),
        Command::Dataset(args) => dataset::main(&args),
        Command::Train(args) => train::main(&args),
        Command::Evaluate(args) => evaluate::main(&args),
        Command::Chart(args) => chart::main(&args),
        Command::Vision(args) => vision::main(&args),
    })
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
