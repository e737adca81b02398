//! Debian's compiler, which can build the target's `core` from the sources beside it.

use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};

use super::output;
use crate::jobs::Desk;

/// Debian's compiler.
pub const RUSTC: &str = "/usr/bin/rustc";
/// Debian's Cargo.
pub const CARGO: &str = "/usr/bin/cargo";
/// Where Debian puts the sources of `core` for `-Zbuild-std`.
const SOURCES: &str = "/usr/lib/rustlib/src/rust/library/core/Cargo.toml";
/// Debian's Clippy, called as `cargo clippy` calls it.
pub const CLIPPY: &str = "/usr/bin/cargo-clippy";
const LLD: &str = "/usr/bin/ld.lld";

/// The compiler, Cargo, the sources, and Clippy: first the recent ones that stable releases get for their browsers.
const PACKAGES: [[&str; 4]; 2] = [
    ["rustc-web", "cargo-web", "rust-web-src", "rust-web-clippy"],
    ["rustc", "cargo", "rust-src", "rust-clippy"],
];
/// The oldest minor version of Rust 1 that compiles the image's crates.
const OLDEST_MINOR: u32 = 88;

/// Sees to it that there is a compiler with sources; gives the linker to use with it.
pub fn compiler(desk: &Desk) -> Result<PathBuf> {
    if !has_compiler() {
        install_first(desk, |[rustc, cargo, sources, _]| vec![rustc, cargo, sources])?;
        ensure!(
            has_compiler(),
            "{RUSTC}, {CARGO} or {SOURCES} is still missing or too old (before 1.{OLDEST_MINOR})"
        );
    }
    linker(desk)
}

/// Sees to it that there is a Clippy beside the compiler.
pub fn clippy(desk: &Desk) -> Result<()> {
    if Path::new(CLIPPY).exists() {
        return Ok(());
    }
    install_first(desk, |[.., clippy]| vec![clippy])
}

fn has_compiler() -> bool {
    let recent = output(Command::new(RUSTC).arg("--version"))
        .and_then(|version| minor_version(&version))
        .is_some_and(|minor| minor >= OLDEST_MINOR);
    recent && Path::new(CARGO).exists() && Path::new(SOURCES).exists()
}

/// `rustc 1.96.0 (...)` is 96.
fn minor_version(version: &str) -> Option<u32> {
    version.strip_prefix("rustc 1.")?.split('.').next()?.parse().ok()
}

/// Rust's own linker from any toolchain that rustup has, else LLVM's, which Debian has.
fn linker(desk: &Desk) -> Result<PathBuf> {
    if let Some(linker) = rustup_home().and_then(|home| rust_lld(&home)) {
        return Ok(linker);
    }
    if !Path::new(LLD).exists() {
        install(desk, &["lld"])?;
    }
    Ok(PathBuf::from(LLD))
}

fn rustup_home() -> Option<PathBuf> {
    let set = std::env::var_os("RUSTUP_HOME").map(PathBuf::from);
    set.or_else(|| Some(std::env::home_dir()?.join(".rustup")))
}

fn rust_lld(rustup_home: &Path) -> Option<PathBuf> {
    // toolchains/NAME/lib/rustlib/HOST/bin/rust-lld
    let toolchains = folders(&rustup_home.join("toolchains"));
    let mut hosts = toolchains.flat_map(|toolchain| folders(&toolchain.join("lib/rustlib")));
    hosts.find_map(|host| Some(host.join("bin/rust-lld")).filter(|linker| linker.exists()))
}

/// What is in a folder, by name; nothing if there is no such folder.
fn folders(folder: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    let mut inside: Vec<PathBuf> =
        std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    inside.sort();
    inside.into_iter()
}

/// Installs what `choose` takes from the first row of [`PACKAGES`] that this Debian has.
fn install_first(desk: &Desk, choose: fn([&'static str; 4]) -> Vec<&'static str>) -> Result<()> {
    let rows = PACKAGES.map(choose);
    may_install(&rows[0])?;
    update(desk)?;
    let known = |row: &Vec<&str>| row.iter().all(|package| is_known(package));
    match rows.iter().find(|row| known(row)) {
        Some(row) => apt(desk, row),
        None => bail!("this system's package sources have neither of {rows:?}"),
    }
}

fn install(desk: &Desk, packages: &[&str]) -> Result<()> {
    may_install(packages)?;
    update(desk)?;
    apt(desk, packages)
}

fn may_install(packages: &[&str]) -> Result<()> {
    let packages = packages.join(" ");
    let has_apt = output(Command::new("apt-get").arg("--version")).is_some();
    ensure!(has_apt, "on Debian, its packages {packages} would do; this system has no apt-get");
    // The owner of a process's folder is its effective user.
    let is_root = std::fs::metadata("/proc/self").is_ok_and(|process| process.uid() == 0);
    ensure!(is_root, "Debian's packages would do: `sudo apt-get install --no-install-recommends {packages}`");
    Ok(())
}

fn is_known(package: &str) -> bool {
    output(Command::new("apt-cache").args(["policy", package])).is_some_and(|policy| {
        policy
            .lines()
            .any(|line| line.trim().strip_prefix("Candidate:").is_some_and(|it| it.trim() != "(none)"))
    })
}

fn update(desk: &Desk) -> Result<()> {
    desk.state("its compiler is missing: asking Debian (apt-get update)");
    quietly(Command::new("apt-get").args(["update", "--quiet"]))
}

fn apt(desk: &Desk, packages: &[&str]) -> Result<()> {
    let packages_named = packages.join(" ");
    desk.state(format!("installing {packages_named} (apt-get install)"));
    desk.tell(&format!("installed for the image: {packages_named}"));
    let mut apt = Command::new("apt-get");
    apt.env("DEBIAN_FRONTEND", "noninteractive");
    quietly(apt.args(["install", "--yes", "--quiet", "--no-install-recommends"]).args(packages))
}

/// Runs a command and shows what it printed only if it fails.
fn quietly(command: &mut Command) -> Result<()> {
    let output = command.output().with_context(|| format!("cannot start {command:?}"))?;
    ensure!(
        output.status.success(),
        "{command:?} failed:\n{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_linker_of_any_toolchain_is_found() {
        let home = std::env::temp_dir().join(format!("tenax-launch-{}", std::process::id()));
        assert_eq!(rust_lld(&home), None);
        let folder = home.join("toolchains/1.95.0-x86_64/lib/rustlib/x86_64/bin");
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::create_dir_all(home.join("toolchains/empty")).unwrap();
        std::fs::write(folder.join("rust-lld"), "").unwrap();
        assert_eq!(rust_lld(&home), Some(folder.join("rust-lld")));
        std::fs::remove_dir_all(&home).unwrap();
    }

    #[test]
    fn versions_are_read_as_debian_prints_them() {
        assert_eq!(
            minor_version("rustc 1.96.0 (ac68faa20 2026-05-25) (built from a source tarball)"),
            Some(96)
        );
        assert_eq!(minor_version("rustc 1.63.0"), Some(63));
        assert_eq!(minor_version("error: no such command"), None);
    }
}
