//! The command line, a file a subcommand.

mod chart;
mod check;
mod dataset;
mod evaluate;
mod learn;
mod train;
mod vision;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Context;
use clap::{Parser, Subcommand};
use tenax_frames::tool::{exit, format::Format, out, workspace};
use tenax_sim::session::Board;

/// The papers' studies, and every promise measured.
#[derive(Debug, Parser)]
#[command(name = "tenax", bin_name = "tenax", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const ARRAY: &str = "The force array's network: python -m tenax.train --help (docs/array.md).";

#[derive(Debug, Subcommand)]
enum Command {
    Check(check::Args),
    Learn(learn::Args),
    Dataset(dataset::Args),
    /// Fit intent recognition to recordings of people
    #[command(subcommand, arg_required_else_help = true, after_help = ARRAY)]
    Train(Of<train::Args>),
    Evaluate(evaluate::Args),
    Chart(chart::Args),
    Vision(vision::Args),
}

#[derive(Debug, Subcommand)]
enum Of<A: clap::Args> {
    /// Of recorded EMG envelopes of two muscles
    Emg(A),
}

/// Runs the command line. 0: done. 1: something measured is not as promised. 2: it could not be run.
pub fn main() -> ExitCode {
    exit(match Cli::parse().command {
        Command::Check(args) => check::main(&args),
        Command::Learn(args) => learn::main(&args),
        Command::Dataset(args) => dataset::main(&args),
        Command::Train(Of::Emg(args)) => train::main(&args),
        Command::Evaluate(args) => evaluate::main(&args),
        Command::Chart(args) => chart::main(&args),
        Command::Vision(args) => vision::main(&args),
    })
}

/// Recorded envelopes of people: the arguments of `evaluate emg` and `train emg`.
#[derive(Debug, clap::Args)]
struct People {
    /// Folder of personP_dayD_postureQ.csv: t_s, ecu, edc, fcr, fcu (32767 is 2.8 V), label (1 rest, 3 close, 4 open)
    #[arg(long, value_name = "FOLDER")]
    recordings: PathBuf,
    /// Seed of the random faults, or of the search
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How to print the report
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
}

/// The host's build of the logic, or the emulated board with the image, which is built. Fails if it cannot be built.
fn board(host: bool) -> anyhow::Result<Board> {
    if host { Ok(Board::Host) } else { Board::emulated(&workspace::root()?) }
}

/// Writes a file and tells its path on standard error.
fn write(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    std::fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
    out::note!("  {:<14}{}", "written", path.display());
    Ok(())
}
