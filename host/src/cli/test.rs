//! `tenax test`: every test of the workspace, and their sum.

mod sum;

use std::process::{Command, ExitCode};

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

/// All that is tested with the tool itself, in one command, so that everything is compiled once: in release, with the checks of a debug
/// build (the workspace's Cargo.toml), for in the logic's arithmetic an overflow is an error.
const PACKAGES: [&str; 14] = [
    "logic",
    "hal-shim",
    "palm",
    "scene",
    "vision",
    "launch",
    "host-tests",
    "serial",
    "plot",
    "board-model",
    "bench",
    "studies",
    "ros2",
    "train",
];

pub fn all() -> Command {
    let mut command = Command::new("cargo");
    command.arg("test").args(tool::BUILD);
    for package in PACKAGES {
        command.args(["--package", &format!("tenax-{package}")]);
    }
    // Tests of the line wait for real time to go by: twice as many at once take half as long.
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    command.env("RUST_TEST_THREADS", (2 * cores).to_string());
    command
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    // Before the tests, so that its messages are seen and what is to be installed is said once.
    jobs::run(vec![job(
        &workspace::root()?,
        &[Binary::Image, Binary::Kernels, Binary::Frames, Binary::Pictures],
    )])?;
    let mut sum = Sum::default();
    // All are run even if one fails: a person wants to know of all that is broken.
    sum.run(all().arg("--no-fail-fast").args(&args.extra))?;
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
        let elsewhere = ["host", "firmware", "vision/quarter", "bridge"];
        for member in members.iter().filter_map(|member| member.as_str()) {
            assert!([&PACKAGES[..], &elsewhere].concat().contains(&member), "{member}");
        }
    }
}
