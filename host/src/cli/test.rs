//! `tenax test`: every test of the workspace, and their sum.

mod sum;

use std::process::{Command, ExitCode, Stdio};

use anyhow::Context;
use sum::Sum;

use tenax_launch::image::{Binary, job};
use tenax_launch::{jobs, tool};

use super::{out, workspace};
use crate::safety::RESULTS;

/// Run every test of the workspace, the emulated ones included.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Arguments for `cargo test`, after --
    #[arg(last = true)]
    extra: Vec<String>,
}

/// What is tested in a debug build.
const DEBUG: [&str; 7] = ["logic", "hal-shim", "palm", "scene", "vision", "launch", "host-tests"];

/// What the tool is made of.
const TOOL: [&str; 6] = ["serial", "plot", "board-model", "bench", "studies", "ros2"];

/// Tests of all that is not the tool, with the checks of a debug build: in the logic's arithmetic an overflow is an error.
pub fn logic() -> Command {
    let mut command = Command::new("cargo");
    command.arg("test");
    for package in DEBUG {
        command.args(["--package", &format!("tenax-{package}")]);
    }
    command
}

/// Tests of the tool, as it is built to be run, so that everything that it is made of is compiled once.
fn tool() -> Command {
    let mut command = Command::new("cargo");
    command.arg("test").args(tool::BUILD);
    for package in TOOL {
        command.args(["--package", &format!("tenax-{package}")]);
    }
    // Tests of the line wait for real time to go by: twice as many at once take half as long.
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    command.env("RUST_TEST_THREADS", (2 * cores).to_string());
    command
}

/// Tests of the training. It learns, which without optimisation takes minutes. Apart from the tool's, as `tenax train` builds
/// it: together they would share features, and the emulator would be compiled again.
const TRAINING: [&str; 5] = ["test", "--release", "--ignore-rust-version", "--package", "tenax-train"];

/// Compiles the tests of the training with what the tool's tests leave of the cores: many of those wait for a board that runs at
/// real time. Not before these are compiled, for Cargo lets one of them compile at a time.
fn compile_training() {
    let mut command = Command::new("nice");
    command.args(["-n", "19", "cargo"]).args(TRAINING).args(["--no-run", "--quiet"]);
    let quiet = command.stdout(Stdio::null()).stderr(Stdio::null());
    // Whatever hinders it will be said when they are run. It goes on by itself.
    let _hindered = workspace::root().and_then(|root| Ok(quiet.current_dir(root).spawn()?));
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    // Before the tests, so that its messages are seen and what is to be installed is said once.
    jobs::run(vec![job(
        &workspace::root()?,
        &[Binary::Image, Binary::Kernels, Binary::Frames, Binary::Pictures],
    )])?;
    let mut sum = Sum::default();
    // The next is run even if one fails: a person wants to know of all that is broken.
    let mut run = |command: &mut Command, compiled: fn()| {
        sum.run(command.arg("--no-fail-fast").args(&args.extra), compiled)
    };
    run(&mut logic(), || {})?;
    run(&mut tool(), compile_training)?;
    run(Command::new("cargo").args(TRAINING), || {})?;
    if args.extra.is_empty() {
        // For `tenax safety --tested`.
        let path = workspace::root()?.join(RESULTS);
        std::fs::write(&path, &sum.results).with_context(|| format!("cannot write {}", path.display()))?;
    }
    out::say!("{sum}")?;
    Ok(if sum.good() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_member_of_the_workspace_is_tested() {
        let manifest = std::fs::read_to_string(workspace::root().unwrap().join("Cargo.toml")).unwrap();
        let manifest: toml::Table = manifest.parse().unwrap();
        let members = manifest["workspace"]["members"].as_array().unwrap();
        // The image is tested on the emulated board, by the tool's tests.
        // The quarter is vision's sources, held against the emulated core.
        // The bridge's zenoh compiles for three minutes; `.ci/run` names the command that tests it.
        let elsewhere = ["host", "train", "firmware", "vision/quarter", "bridge"];
        for member in members.iter().filter_map(|member| member.as_str()) {
            assert!([&DEBUG[..], &TOOL, &elsewhere].concat().contains(&member), "{member}");
        }
    }
}
