//! Building the tool, and becoming it.

use std::env::consts::EXE_SUFFIX;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::{Context, Result, ensure};

use crate::cargo;
use crate::image::Binary;
use crate::jobs::Job;

/// How the tool is built: wherever it is, so that it is built once.
///
/// rigless asks for rustc 1.98 and builds on 1.95: see docs/tools.md.
pub const BUILD: [&str; 6] =
    ["--release", "--ignore-rust-version", "--package", "tenax", "--features", "tenax/emulator"];

/// Builds the tool of the workspace at `root` into the target folder that this program is in.
#[must_use]
pub fn job(root: &Path) -> Job<'_> {
    let run = move |desk: &_| {
        let mut cargo = Command::new("cargo");
        cargo.arg("build").args(BUILD).arg("--target-dir").arg(target()?).current_dir(root);
        // If a person has set it, the target folder is already the one of that target.
        cargo.env_remove("CARGO_BUILD_TARGET");
        cargo::run(&mut cargo, desk)
    };
    Job { name: "tool", done: "built", run: Box::new(run) }
}

/// What the tool will ask for when it is called with these arguments. If this is wrong, the tool builds it itself.
#[must_use]
pub fn image_of(arguments: &[OsString]) -> &'static [Binary] {
    let has = |asked: &[&str]| arguments.iter().any(|own| asked.iter().any(|asked| own == asked));
    let command = arguments.first().and_then(|command| command.to_str());
    match command {
        _ if has(&["--host", "--help", "-h"]) => &[],
        Some("check" | "size" | "test") => &[Binary::Image, Binary::Kernels],
        Some("flash" | "learn" | "run") => &[Binary::Image],
        _ => &[],
    }
}

/// Starts the tool beside this program in the target folder; where the system can, this process becomes it.
///
/// # Errors
/// If it is not there or does not start.
pub fn become_it(arguments: &[OsString]) -> Result<ExitCode> {
    let path = path()?;
    let mut tool = Command::new(&path);
    tool.args(arguments);
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt;
        Err(tool.exec()).with_context(|| format!("cannot start {}", path.display()))
    }
    #[cfg(not(unix))]
    {
        let status = tool.status().with_context(|| format!("cannot start {}", path.display()))?;
        let code = status.code().and_then(|code| u8::try_from(code).ok());
        Ok(ExitCode::from(code.unwrap_or(2)))
    }
}

fn path() -> Result<PathBuf> {
    let path = target()?.join("release").join(format!("tenax{EXE_SUFFIX}"));
    ensure!(path.exists(), "the build succeeded, but there is no {}", path.display());
    Ok(path)
}

/// Wherever Cargo was told to put it: this program is its `debug/tenax-launch`, and the tool its `release/tenax`.
fn target() -> Result<PathBuf> {
    let own = std::env::current_exe().context("cannot tell where this program is")?;
    let target = own.ancestors().nth(2).context("this program is not in a target folder")?;
    Ok(target.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(arguments: &str) -> &'static [Binary] {
        image_of(&arguments.split(' ').map(OsString::from).collect::<Vec<_>>())
    }

    #[test]
    fn only_what_runs_the_image_waits_for_it() {
        assert_eq!(image("run --seed 2"), [Binary::Image]);
        assert_eq!(image("size --check"), [Binary::Image, Binary::Kernels]);
        for none in ["run --host", "run --help", "scenes", "chart scenes", ""] {
            assert_eq!(image(none), [], "{none}");
        }
    }
}
