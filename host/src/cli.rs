//! The command line: one file a subcommand.

mod calibrate;
mod chart;
mod check;
mod commands;
mod dataset;
mod evaluate;
mod folder;
mod format;
mod hand;
mod learn;
mod line_file;
mod lint_image;
mod people;
mod plot;
mod progress;
mod run;
mod safety;
mod scenes;
mod size;
mod test;
mod train;
mod vision;

use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use tenax_serial::cli::{
    config, exit, flash, monitor, out, play, record, selftest, settings, wiring, workspace,
};

const EXAMPLES: &str = "\
Examples:
  tenax run                                 the default scene on the emulated board, with the flashed image
  tenax run --host --scene knocks           another scene, on the host's build of the logic
  tenax run --replay touch.csv              a recording, with the recipe that its name calls for
  tenax run --replay my.csv --recipe my.toml
  tenax run --report json > report.json     for programs
  tenax run --serve                         the same at real time, with its serial line on a pseudo-terminal
  tenax run --host --serve-tcp 7777         on TCP port 7777 of this machine only
  tenax learn                               a fingertip teaches itself slip from a camera
  tenax scenes                              what there is to run
  tenax check                               every promise, measured
  tenax chart scenes                        how friction is stepped, beside theory
  tenax monitor                             watch the board that is plugged in
  tenax monitor --port /dev/pts/5           watch a running scene: the path is what `tenax run --serve` printed
  tenax config --port /dev/pts/5 set s1-mv=120
  tenax record --out grasp.mcap             record it, for Foxglove, PlotJuggler, Python and `run --replay`
  tenax monitor --port tcp:127.0.0.1:7777   the same over TCP
  tenax monitor --port out/glass.line.bin   what a run sent";

/// Runs, replays, watches and charts the Tenax fingertip.
#[derive(Debug, Parser)]
#[command(name = "tenax", bin_name = "tenax", version, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run a scene or a recording on a board; report and draw it
    Run(run::Args),
    /// Let a fingertip teach itself slip from a camera, and measure what that is worth
    Learn(learn::Args),
    /// Run a hand of several fingertips
    Hand(hand::Args),
    /// List the scenes
    Scenes,
    /// Run every test of the workspace, the emulated ones included
    Test(test::Args),
    /// Measure every promise of the project, one line each; fails if one is not kept
    Check(check::Args),
    /// Hold requirements, hazards and tests against each other
    Safety(safety::Args),
    /// Make a labelled data set of the normal-force array
    Dataset(dataset::Args),
    /// Score the force array's network on what it never saw, or the whole hand in the paper's tasks
    Evaluate(evaluate::Args),
    /// Train the force array's slip detector from labelled recordings
    Train(train::Args),
    /// Calibrate a sensor or the wearer's muscles, step by step
    Calibrate(calibrate::Args),
    /// Draw the charts behind a page of docs/
    Chart(chart::Args),
    /// Follow skin and object with a camera behind a clear skin, or calibrate its force
    Vision(vision::Args),
    /// Flash a NUCLEO-F411RE through probe-rs
    Flash(flash::Args),
    /// Touch every sensor in turn; say which wire is wrong
    Selftest(selftest::Args),
    /// Watch a board: a screen, or one line a message
    Monitor(monitor::Args),
    /// Record a board's line
    Record(record::Args),
    /// Play a recording: serve its line, or write it as CSV
    Play(play::Args),
    /// Draw a recording
    Plot(plot::Args),
    /// Show and change a board's settings
    Config(config::Args),
    /// Flash, RAM, worst stack and instructions a tick of the image, beside their budgets
    Size(size::Args),
    /// Run Clippy on the image with the toolchain that builds it
    LintImage,
    /// Print every command with its options as a Markdown table
    Commands,
    /// Print the channel map as a Markdown table
    Wiring,
    /// Print every setting with unit, range, default and meaning as a Markdown table
    Settings,
}

/// Runs the command line. 0: done. 1: something measured is not as promised. 2: it could not be run.
pub fn main() -> ExitCode {
    exit(match Cli::parse().command {
        Command::Run(args) => run::main(&args),
        Command::Learn(args) => learn::main(&args),
        Command::Hand(args) => hand::main(&args),
        Command::Scenes => scenes::main(),
        Command::Test(args) => test::main(&args),
        Command::Check(args) => check::main(&args),
        Command::Safety(args) => safety::main(&args),
        Command::Train(args) => train::main(&args),
        Command::Calibrate(args) => calibrate::main(&args),
        Command::Chart(args) => chart::main(&args),
        Command::Dataset(args) => dataset::main(&args),
        Command::Evaluate(args) => evaluate::main(&args),
        Command::Vision(args) => vision::main(&args),
        Command::Flash(args) => flash::main(&args),
        Command::Selftest(args) => selftest::main(&args),
        Command::Monitor(args) => monitor::main(&args),
        Command::Record(args) => record::main(&args),
        Command::Play(args) => play::main(&args),
        Command::Plot(args) => plot::main(&args),
        Command::Config(args) => config::main(&args),
        Command::Size(args) => size::main(&args),
        Command::LintImage => lint_image::main(),
        Command::Commands => commands::main(&Cli::command()),
        Command::Wiring => wiring::main(),
        Command::Settings => settings::main(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_well_formed() {
        Cli::command().debug_assert();
    }
}
