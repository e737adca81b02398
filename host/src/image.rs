//! The image for the microcontroller: building it, and reading what it says about itself.

mod debian;
pub mod kernels;
pub mod size;
pub mod symbols;
mod toolchain;

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};

use self::toolchain::Toolchain;

/// What the image is compiled for: Cortex-M4F, hard float.
pub const TARGET: &str = "thumbv7em-none-eabihf";
/// The package that it is made of, and its file's name.
const PACKAGE: &str = "tenax-firmware";
/// The file's name of the image that is the array detector's arithmetic alone.
const KERNELS: &str = "tenax-kernels";
/// The Cargo profile that it is made with.
const PROFILE: &str = "firmware";

/// Builds the image of the workspace at `root`, fetching what it takes, and gives its ELF file.
///
/// # Errors
/// Says what to install, or what the compiler said.
pub fn build(root: &Path) -> Result<PathBuf> {
    build_bin(root, PACKAGE)
}

/// Builds the image of the array detector's kernels, for [`kernels`](crate::board::emulated::kernels).
///
/// # Errors
/// As [`build`].
pub fn build_kernels(root: &Path) -> Result<PathBuf> {
    build_bin(root, KERNELS)
}

fn build_bin(root: &Path, bin: &str) -> Result<PathBuf> {
    cargo(root, "build", &["--bin", bin])?;
    let elf = target_dir(root).join(TARGET).join(PROFILE).join(bin);
    ensure!(elf.exists(), "the build succeeded, but there is no {}", elf.display());
    Ok(elf)
}

/// Lints the image's package with the toolchain that builds it; a warning is an error.
///
/// # Errors
/// Says what to install, or what Clippy said.
pub fn clippy(root: &Path) -> Result<()> {
    cargo(root, "clippy", &["--", "--deny", "warnings"])
}

fn cargo(root: &Path, verb: &str, more: &[&str]) -> Result<()> {
    let toolchain = Toolchain::find(root)?;
    if verb == "clippy" {
        toolchain.fetch_clippy()?;
    }
    let mut cargo = toolchain.cargo(verb);
    cargo
        .current_dir(root)
        .args(["--quiet", "--profile", PROFILE, "--package", PACKAGE, "--target", TARGET])
        .args(toolchain.build_std())
        .arg("--target-dir")
        .arg(target_dir(root))
        .args(more);
    run(&mut cargo).with_context(|| format!("cargo {verb} of the image with {toolchain}"))
}

/// The image has a folder of its own: its std is another, and the tool's own build never waits for it.
fn target_dir(root: &Path) -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    root.join(target).join("image")
}

/// Runs a command to its end, its messages on this process's standard error.
fn run(command: &mut Command) -> Result<()> {
    let program = command.get_program().to_owned();
    let status = command
        .stdout(std::io::stderr())
        .status()
        .with_context(|| format!("cannot start {}", program.display()))?;
    if !status.success() {
        bail!("{} failed ({status}); its messages are above", program.display());
    }
    Ok(())
}

/// What a command prints, if it starts and succeeds.
fn output(command: &mut Command) -> Option<String> {
    let output = command.output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
