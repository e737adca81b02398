//! The command line: one file a subcommand.

mod bridge;
mod calibrate;
mod chart;
mod check;
mod commands;
mod dataset;
mod evaluate;
mod folder;
mod format;
mod hil;
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
mod sweep;
mod test;
mod train;
mod vision;

use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use tenax_serial::cli::{Shared, exit, out, workspace};

const EXAMPLES: &str = "\
Examples:
  tenax run                                 the default scene on the emulated board, with the flashed image
  tenax run --host --scene knocks           another scene, on the host's build of the logic
  tenax run --replay touch.csv              a recording, with the recipe that its name calls for
  tenax run --replay my.csv --recipe my.toml
  tenax run --report json > report.json     for programs
  tenax run --serve                         the same at real time, with its serial line on a pseudo-terminal
  tenax run --host --serve-tcp 7777         on TCP port 7777 of this machine only
  tenax learn                               a camera teaches the Hebbian network
  tenax scenes                              what there is to run
  tenax check                               every promise, measured
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
    /// Teach the Hebbian network slip with a camera, and score it
    Learn(learn::Args),
    /// Measure a real board in the loop
    Hil(hil::Args),
    /// List the scenes
    Scenes,
    /// Run scenes with many seeds, in shards
    Sweep(sweep::Args),
    /// Run every test of the workspace, the emulated ones included
    Test(test::Args),
    /// Measure every promise of the project, one line each; fails if one is not kept
    Check(check::Args),
    /// Check requirements, hazards and tests against each other
    Safety(safety::Args),
    /// Make a labelled data set of the normal-force array
    Dataset(dataset::Args),
    /// Score the array's network on held-out data, or the whole hand in the paper's tasks
    Evaluate(evaluate::Args),
    /// Train the force array's slip detector from labelled recordings
    Train(train::Args),
    /// Calibrate a sensor or the wearer's muscles, step by step
    Calibrate(calibrate::Args),
    /// Draw the charts behind a page of docs/
    Chart(chart::Args),
    /// Follow skin and object with a camera behind a clear skin, or calibrate its force
    Vision(vision::Args),
    #[command(flatten)]
    Serial(Shared),
    /// Bring fingertips into ROS 2 over zenoh, without a ROS install
    Bridge(bridge::Args),
    /// Draw a recording
    Plot(plot::Args),
    /// Flash, RAM, worst stack and instructions a tick of the image, beside their budgets
    Size(size::Args),
    /// Run Clippy on the image; check that its tick and interrupts cannot panic
    ///
    /// Also compiles the image for the STM32F446RE and compares the other places that may panic with budgets.toml. Exit status
    /// 1: too many. Example: cargo tenax lint-image
    LintImage,
    /// Print every command as a Markdown table
    Commands,
}

/// Runs the command line. 0: done. 1: something measured is not as promised. 2: it could not be run.
pub fn main() -> ExitCode {
    exit(match Cli::parse().command {
        Command::Run(args) => run::main(&args),
        Command::Learn(args) => learn::main(&args),
        Command::Hil(args) => hil::main(&args),
        Command::Scenes => scenes::main(),
        Command::Sweep(args) => sweep::main(&args),
        Command::Test(args) => test::main(&args),
        Command::Check(args) => check::main(&args),
        Command::Safety(args) => safety::main(&args),
        Command::Train(args) => train::main(&args),
        Command::Calibrate(args) => calibrate::main(&args),
        Command::Chart(args) => chart::main(&args),
        Command::Dataset(args) => dataset::main(&args),
        Command::Evaluate(args) => evaluate::main(&args),
        Command::Vision(args) => vision::main(&args),
        Command::Serial(command) => command.run(),
        Command::Bridge(args) => bridge::main(&args),
        Command::Plot(args) => plot::main(&args),
        Command::Size(args) => size::main(&args),
        Command::LintImage => lint_image::main(),
        Command::Commands => commands::main(&Cli::command()),
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
