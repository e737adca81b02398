//! The tests of the workspace as one command.

use std::process::Command;

use tenax_launch::tool;

/// All that is tested with the tool itself, in one command, so that everything is compiled once: in release, with the checks of a debug
/// build (the workspace's Cargo.toml), for in the logic's arithmetic an overflow is an error.
const PACKAGES: [&str; 13] = [
    "logic",
    "hal-shim",
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

/// `cargo test` of all of them.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_member_of_the_workspace_is_tested() {
        let manifest =
            std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.toml")).unwrap();
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
