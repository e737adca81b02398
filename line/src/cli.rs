//! The command line, a file a subcommand.

pub mod calibrate;
pub mod config;
pub mod flash;
pub mod monitor;
pub mod play;
pub mod port;
pub mod record;
pub mod selftest;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use tenax_frames::tool::{exit, out};

use crate::tables;

/// Watches, records, plays and sets up a Tenax fingertip over its serial line.
#[derive(Debug, Parser)]
#[command(name = "tenax", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Flash a NUCLEO-F411RE through probe-rs
    Flash(flash::Args),
    /// Touch every sensor in turn; say which wire is wrong
    Selftest(selftest::Args),
    /// Watch a board: a page in the browser, or one line a message
    Monitor(monitor::Args),
    /// Record a board's line
    Record(record::Args),
    /// Write a recording as CSV
    Play(play::Args),
    /// Show and change a board's settings
    Config(config::Args),
    /// Calibrate a sensor or the wearer's muscles, step by step
    Calibrate(calibrate::Args),
    /// Print channels and settings as Markdown tables, wire messages as JSON
    #[command(after_help = "Examples:\n  tenax tables wiring | less\n  tenax tables settings > settings.md")]
    Tables {
        #[arg(value_enum)]
        table: Table,
    },
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Table {
    /// Pins and valid voltages of every channel
    Wiring,
    /// Every setting with number, unit, range, default and meaning
    Settings,
    /// Every message and type of the serial line with its fields, as JSON
    Wire,
}

/// Runs the command line. 0: done. 2: it could not be run.
pub fn main() -> ExitCode {
    exit(match Cli::parse().command {
        Command::Flash(args) => flash::main(&args),
        Command::Selftest(args) => selftest::main(&args),
        Command::Monitor(args) => monitor::main(&args),
        Command::Record(args) => record::main(&args),
        Command::Play(args) => play::main(&args),
        Command::Config(args) => config::main(&args),
        Command::Calibrate(args) => calibrate::main(&args),
        Command::Tables { table } => print(table),
    })
}

fn print(table: Table) -> anyhow::Result<ExitCode> {
    let page = match table {
        Table::Wiring => tables::wiring(),
        Table::Settings => tables::settings(),
        Table::Wire => include_str!("../../python/tenax/wire.json").to_owned(),
    };
    out::print(format_args!("{page}"))?;
    Ok(ExitCode::SUCCESS)
}
