//! Building the image for the microcontroller.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

pub const TARGET: &str = "thumbv7em-none-eabihf";
const PACKAGE: &str = "tenax-firmware";
const PROFILE: &str = "firmware";
const NOT_FOR_THE_IMAGE: [&str; 4] =
    ["CARGO_BUILD_TARGET", "CARGO_ENCODED_RUSTFLAGS", "RUSTFLAGS", "CARGO_MANIFEST_DIR"];

/// Builds the image of the workspace at `root`; its ELF file. `TENAX_CHIP`, such as `f412`, builds it for another chip, apart; what both have in
/// common is compiled once. Fails if the compiler does; its messages are on standard error.
pub fn build(root: &Path) -> Result<PathBuf> {
    let mut cargo = Command::new("cargo");
    NOT_FOR_THE_IMAGE.iter().for_each(|name| _ = cargo.env_remove(name));
    cargo.current_dir(root).args(["build", "--quiet", "--package", PACKAGE, "--bin", PACKAGE]);
    let mut target_dir = target_dir(root);
    if let Ok(chip) = std::env::var("TENAX_CHIP") {
        cargo.args(["--no-default-features", "--features", &format!("log,chip-{chip}")]);
        cargo.env("CARGO_BUILD_BUILD_DIR", &target_dir);
        target_dir.push(chip);
    }
    cargo.args(["--profile", PROFILE, "--target", TARGET]).arg("--target-dir").arg(&target_dir);
    let built = cargo.status().context("cannot start cargo")?.success();
    ensure!(built, "the image was not built; for its target: rustup target add {TARGET}");
    Ok(target_dir.join(TARGET).join(PROFILE).join(PACKAGE))
}

fn target_dir(root: &Path) -> PathBuf {
    root.join(std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| "target".into(), PathBuf::from))
}
