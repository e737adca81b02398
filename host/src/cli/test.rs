//! `tenax test`: every test of the workspace.

use std::process::{Command, ExitCode};

use super::workspace;
use crate::image;

/// Run every test of the workspace, the emulated ones included.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Arguments for `cargo test`, after --
    #[arg(last = true)]
    extra: Vec<String>,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let mut plain = Command::new("cargo");
    plain.arg("test").args(&args.extra);
    // rigless asks for rustc 1.98 and builds on 1.95: see docs/tools.md.
    let mut emulated = Command::new("cargo");
    emulated.args([
        "test",
        "--release",
        "--ignore-rust-version",
        "--package",
        "tenax",
        // It learns, which without optimisation takes minutes.
        "--package",
        "tenax-train",
        "--features",
        "tenax/emulator",
    ]);
    emulated.args(&args.extra);
    // Before the tests, so that its messages are seen and what is to be installed is said once.
    image::build(&workspace::root()?)?;
    let mut passed = true;
    for command in [&mut plain, &mut emulated] {
        // The second is run even if the first fails: a person wants to know of all that is broken.
        passed &= workspace::run(command)?;
    }
    Ok(if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
