//! Building the image for the microcontroller.

mod debian;
mod toolchain;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

use anyhow::{Context, Result, ensure};

use self::toolchain::Toolchain;
use crate::cargo;
use crate::fresh::Program;
use crate::jobs::{self, Desk, Job};

/// What the image is compiled for: Cortex-M4F, hard float.
pub const TARGET: &str = "thumbv7em-none-eabihf";
const PACKAGE: &str = "tenax-firmware";
/// The Cargo profile that it is made with.
const PROFILE: &str = "firmware";

/// What the package can be made into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binary {
    /// What is flashed.
    Image,
    /// The array detector's arithmetic alone.
    Kernels,
    /// Every detector's, frame by frame.
    Frames,
    /// A small camera's, picture by picture.
    Pictures,
}

impl Binary {
    /// Its file's name.
    const fn name(self) -> &'static str {
        match self {
            Self::Image => PACKAGE,
            Self::Kernels => "tenax-kernels",
            Self::Frames => "tenax-frames",
            Self::Pictures => "tenax-pictures",
        }
    }

    /// What it is built with besides.
    const fn features(self) -> &'static [&'static str] {
        match self {
            Self::Pictures => &["--features", "pictures"],
            _ => &[],
        }
    }
}

/// Builds what is asked for of the workspace at `root`, fetching what it takes, and gives its ELF file.
/// An error says what to install, or what the compiler said.
pub fn build(root: &Path, binary: Binary) -> Result<PathBuf> {
    jobs::run(vec![job(root, &[binary])])?;
    let elf = program(root, binary).file;
    ensure!(elf.exists(), "the build succeeded, but there is no {}", elf.display());
    Ok(elf)
}

/// Its program. How it is built is in the sources, but for what [`Toolchain`] finds.
fn program(root: &Path, binary: Binary) -> Program<'_> {
    let file = target_dir(root).join(TARGET).join(PROFILE).join(binary.name());
    Program { root, file, how: binary.name().to_owned() }
}

/// The same, beside other jobs.
pub fn job<'a>(root: &'a Path, binaries: &[Binary]) -> Job<'a> {
    // What has features of its own is built by itself: what is flashed has none of them.
    let (own, others): (Vec<Binary>, _) = binaries.iter().partition(|binary| !binary.features().is_empty());
    let groups = [others].into_iter().chain(own.into_iter().map(|binary| vec![binary]));
    let builds: Vec<Vec<&str>> = groups
        .filter_map(|group| {
            let first = group.first()?;
            let bins = group.iter().flat_map(|binary| ["--bin", binary.name()]);
            Some(bins.chain(first.features().iter().copied()).collect())
        })
        .collect();
    let programs: Vec<_> = binaries.iter().map(|&binary| program(root, binary)).collect();
    let run = move |desk: &Desk| {
        if programs.iter().all(Program::is_fresh) {
            return Ok(());
        }
        let begun = SystemTime::now();
        builds.iter().try_for_each(|build| run(root, "build", build, desk))?;
        programs.iter().try_for_each(|program| program.built(begun))
    };
    Job { name: "image", done: "built", run: Box::new(run) }
}

/// Lints the image's package with the toolchain that builds it; a warning is an error. An error says what to install, or what Clippy
/// said.
pub fn clippy(root: &Path) -> Result<()> {
    let run = move |desk: &Desk| run(root, "clippy", &["--", "--deny", "warnings"], desk);
    jobs::run(vec![Job { name: "image", done: "linted", run: Box::new(run) }])
}

fn run(root: &Path, verb: &str, more: &[&str], desk: &Desk) -> Result<()> {
    desk.state("looking for its compiler");
    let toolchain = Toolchain::find(root, desk)?;
    if verb == "clippy" {
        toolchain.fetch_clippy(desk)?;
    }
    let mut command = toolchain.cargo(verb);
    command
        .current_dir(root)
        .args(["--profile", PROFILE, "--package", PACKAGE, "--target", TARGET])
        .args(toolchain.build_std())
        .arg("--target-dir")
        .arg(target_dir(root))
        .args(more);
    cargo::run(&mut command, desk).with_context(|| format!("cargo {verb} of the image with {toolchain}"))
}

/// The image has a folder of its own: its std is another, and the tool's own build never waits for it.
fn target_dir(root: &Path) -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    root.join(target).join("image")
}

/// What a command prints, if it starts and succeeds.
fn output(command: &mut Command) -> Option<String> {
    let output = command.output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
