//! Building the tool, and becoming it.

use std::env::consts::EXE_SUFFIX;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::SystemTime;

use anyhow::{Context, Result, ensure};

use crate::cargo;
use crate::fresh::Program;
use crate::image::Binary;
use crate::jobs::Job;

/// How the whole tool is built: wherever it is, so that it is built once.
///
/// rigless asks for rustc 1.98 and builds on 1.95: see docs/tools.md.
pub const BUILD: [&str; 6] =
    ["--release", "--ignore-rust-version", "--package", "tenax", "--features", "tenax/emulator"];
/// How the serial tools alone are built.
const BUILD_SERIAL: [&str; 3] = ["--release", "--package", "tenax-serial"];
/// How the bridge into ROS 2 is built, which nothing else compiles.
const BUILD_BRIDGE: [&str; 4] = ["--release", "--ignore-rust-version", "--package", "tenax-bridge"];

/// The bridge's command.
const BRIDGE: &str = "bridge";

/// What runs a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tool {
    Whole,
    /// The serial tools, which take no emulator and no plots: built in a minute and a half, the whole tool in minutes.
    Serial,
    /// `bridge`, whose zenoh nobody else is to wait for.
    Bridge,
}

impl Tool {
    /// The smaller one that has this command, or the whole if only that is built. Fails if this program is not in a target folder.
    pub fn of(root: &Path, arguments: &[OsString]) -> Result<Self> {
        if arguments.first().is_some_and(|command| command == BRIDGE) {
            return Ok(Self::Bridge);
        }
        let [whole, serial] = [Self::Whole, Self::Serial];
        let is_small = is_serial(arguments)
            && (serial.program(root, &target()?).is_fresh() || !whole.program(root, &target()?).is_fresh());
        Ok(if is_small { serial } else { whole })
    }

    const fn build(self) -> &'static [&'static str] {
        match self {
            Self::Whole => &BUILD,
            Self::Serial => &BUILD_SERIAL,
            Self::Bridge => &BUILD_BRIDGE,
        }
    }

    /// Its program in a target folder.
    pub fn program<'a>(self, root: &'a Path, target: &Path) -> Program<'a> {
        let name = match self {
            Self::Whole => "tenax-host",
            Self::Serial => "tenax",
            Self::Bridge => "tenax-bridge",
        };
        let file = target.join("release").join(format!("{name}{EXE_SUFFIX}"));
        Program { root, file, how: self.build().join(" ") }
    }

    /// Builds it from the workspace at `root` into the target folder that this program is in, if it is not built.
    pub fn job(self, root: &Path) -> Job<'_> {
        let run = move |desk: &_| {
            let target = target()?;
            let program = self.program(root, &target);
            if program.is_fresh() {
                return Ok(());
            }
            let begun = SystemTime::now();
            let mut cargo = Command::new("cargo");
            cargo.arg("build").args(self.build()).arg("--target-dir").arg(target).current_dir(root);
            // If a person has set it, the target folder is already the one of that target.
            cargo.env_remove("CARGO_BUILD_TARGET");
            cargo::run(&mut cargo, desk)?;
            program.built(begun)
        };
        Job { name: "tool", done: "built", run: Box::new(run) }
    }

    /// Starts it; where the system can, this process becomes it. Fails if it is not there or does not start.
    pub fn become_it(self, root: &Path, arguments: &[OsString]) -> Result<ExitCode> {
        let path = self.program(root, &target()?).file;
        ensure!(path.exists(), "the build succeeded, but there is no {}", path.display());
        let mut tool = Command::new(&path);
        // It has no other command.
        tool.args(arguments.iter().skip(usize::from(self == Self::Bridge)));
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
}

/// Whether the serial tools have this command. Their `calibrate` has no photoelastic head on a balance, and does not list it.
fn is_serial(arguments: &[OsString]) -> bool {
    let mut words = arguments.iter().map(|argument| argument.to_str());
    match words.next().flatten() {
        Some("calibrate") => matches!(words.next().flatten(), Some("emg" | "force" | "friction")),
        Some("config" | "flash" | "monitor" | "play" | "record" | "selftest" | "settings" | "wiring") => true,
        _ => false,
    }
}

/// What the tool will ask for when it is called with these arguments. If this is wrong, the tool builds it itself.
pub fn image_of(arguments: &[OsString]) -> &'static [Binary] {
    let has = |asked: &[&str]| arguments.iter().any(|own| asked.iter().any(|asked| own == asked));
    let command = arguments.first().and_then(|command| command.to_str());
    match command {
        _ if has(&["--host", "--help", "-h"]) => &[],
        Some("check" | "size") => &[Binary::Image, Binary::Kernels],
        Some("test") => &[Binary::Image, Binary::Kernels, Binary::Frames, Binary::Pictures],
        Some("flash" | "learn" | "run") => &[Binary::Image],
        _ => &[],
    }
}

/// Wherever Cargo was told to put it: this program is its `launch/tenax-launch`, and the tool its `release/tenax-host`.
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
    fn the_serial_tools_run_what_they_have() {
        let serial = |line: &str| is_serial(&line.split(' ').map(OsString::from).collect::<Vec<_>>());
        for own in
            ["monitor", "monitor --port tcp:a:1", "calibrate force --weights-n 1", "wiring", "play a.mcap"]
        {
            assert!(serial(own), "{own}");
        }
        for whole in ["run", "plot a.mcap", "calibrate photoelastic", "calibrate --help", "--help", ""] {
            assert!(!serial(whole), "{whole}");
        }
    }

    #[test]
    fn the_bridge_has_a_tool_of_its_own() {
        let of = |line: &str| {
            Tool::of(Path::new("/"), &line.split(' ').map(OsString::from).collect::<Vec<_>>()).unwrap()
        };
        assert_eq!(of("bridge"), Tool::Bridge);
        assert_eq!(of("bridge --port tcp:a:1 --help"), Tool::Bridge);
        assert_ne!(of("run bridge"), Tool::Bridge);
    }

    #[test]
    fn only_what_runs_the_image_waits_for_it() {
        assert_eq!(image("run --seed 2"), [Binary::Image]);
        assert_eq!(image("size --check"), [Binary::Image, Binary::Kernels]);
        for none in ["run --host", "run --help", "scenes", "chart emg", ""] {
            assert_eq!(image(none), [], "{none}");
        }
    }
}
