//! Which compiler can build the image here.
//!
//! On an ordinary machine rustup has fetched the target that `rust-toolchain.toml` names, and nothing is to be done. Where
//! it cannot, Debian's compiler builds the target's `core` itself, from the sources that Debian also packages.

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Result, bail};

use super::{TARGET, debian, output};
use crate::jobs::Desk;

/// What Cargo sets for the processes it runs, or a person for the build of the tool: none of it is meant for the image.
const NOT_FOR_THE_IMAGE: [&str; 11] = [
    "CARGO",
    "CARGO_BUILD_TARGET",
    "CARGO_ENCODED_RUSTFLAGS",
    "CARGO_INCREMENTAL",
    "CARGO_MANIFEST_DIR",
    "CARGO_TARGET_DIR",
    "RUSTC",
    "RUSTC_WORKSPACE_WRAPPER",
    "RUSTDOC",
    "RUSTFLAGS",
    "RUSTUP_TOOLCHAIN",
];

/// A compiler, and how it comes by the target's `core`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Toolchain {
    OnPath,
    /// Debian's, which builds it.
    Debian {
        /// The linker for the image.
        linker: PathBuf,
    },
}

impl Toolchain {
    /// The first that works, made to work if this process may.
    pub fn find(root: &Path, desk: &Desk) -> Result<Self> {
        if has_target(root) {
            return Ok(Self::OnPath);
        }
        let mut rustup = clean(Command::new("rustup"));
        rustup.current_dir(root).args(["target", "add", TARGET]);
        // What it prints when it cannot is no help to anybody who has another way.
        if output(&mut rustup).is_some() && has_target(root) {
            return Ok(Self::OnPath);
        }
        match debian::compiler(desk) {
            Ok(linker) => Ok(Self::Debian { linker }),
            Err(why) => bail!(
                "the image needs Rust's {TARGET} target, and neither way to it is open:\n\
                 - rustup could not add it: with a network, `rustup target add {TARGET}` does;\n\
                 - {why:#}"
            ),
        }
    }

    /// Cargo's command `verb`, as this toolchain needs it called.
    pub fn cargo(&self, verb: &str) -> Command {
        let mut cargo = match self {
            Self::OnPath => clean(Command::new("cargo")),
            Self::Debian { linker } => {
                // Cargo looks for its subcommands in rustup's folder first, so Debian's Clippy is called by its path.
                let program = if verb == "clippy" { debian::CLIPPY } else { debian::CARGO };
                let mut cargo = clean(Command::new(program));
                cargo.env("CARGO", debian::CARGO);
                cargo.env("RUSTC", debian::RUSTC);
                // Lets a stable compiler take `-Z build-std`.
                cargo.env("RUSTC_BOOTSTRAP", "1");
                cargo.env("CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER", linker);
                cargo
            }
        };
        cargo.arg(verb);
        cargo
    }

    /// What to tell Cargo so that it has a `core`.
    pub fn build_std(&self) -> Option<&'static str> {
        matches!(self, Self::Debian { .. }).then_some("-Zbuild-std=core")
    }

    /// Sees to it that there is a Clippy.
    pub fn fetch_clippy(&self, desk: &Desk) -> Result<()> {
        match self {
            // `rust-toolchain.toml` names it as a component.
            Self::OnPath => Ok(()),
            Self::Debian { .. } => debian::clippy(desk),
        }
    }
}

impl fmt::Display for Toolchain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OnPath => f.write_str("the Rust toolchain on PATH"),
            Self::Debian { linker } => write!(f, "Debian's {} and {}", debian::RUSTC, linker.display()),
        }
    }
}

/// Whether the compiler on PATH has the target's `core`.
fn has_target(root: &Path) -> bool {
    let mut rustc = clean(Command::new("rustc"));
    rustc.current_dir(root).args(["--print", "target-libdir", "--target", TARGET]);
    output(&mut rustc).and_then(|folder| std::fs::read_dir(folder).ok()).is_some_and(|files| {
        files.flatten().any(|file| file.file_name().to_string_lossy().starts_with("libcore-"))
    })
}

/// The command as a person's shell would run it.
fn clean(mut command: Command) -> Command {
    for name in NOT_FOR_THE_IMAGE {
        command.env_remove(name);
    }
    command
}
