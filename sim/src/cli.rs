//! The command line, a file a subcommand.

mod plot;
mod run;
mod sweep;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use tenax_frames::tool::exit;

#[derive(Debug, Parser)]
#[command(name = "tenax", bin_name = "tenax", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Args),
    Sweep(sweep::Args),
    Plot(plot::Args),
}

/// Runs the command line. 0: done. 1: something measured is not as promised. 2: it could not be run.
pub fn main() -> ExitCode {
    exit(match Cli::parse().command {
        Command::Run(args) => run::main(&args),
        Command::Sweep(args) => sweep::main(&args),
        Command::Plot(args) => plot::main(&args),
    })
}
