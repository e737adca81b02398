//! `tenax bridge`: a package of its own, which nothing else compiles.

use std::ffi::OsString;
use std::process::{Command, ExitCode};

use anyhow::Context;
use tenax_serial::cli::workspace;

/// `cargo tenax` starts the bridge itself, without this.
#[derive(Debug, clap::Args)]
#[command(disable_help_flag = true)]
pub struct Args {
    /// Options of the bridge; --help lists them
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "OPTION")]
    options: Vec<OsString>,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let mut command = Command::new("cargo");
    command.args(["run", "--release", "--ignore-rust-version", "--package", "tenax-bridge", "--quiet"]);
    command.arg("--manifest-path").arg(workspace::root()?.join("Cargo.toml")).arg("--").args(&args.options);
    let status = command.status().context("cannot start cargo")?;
    Ok(ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(2)))
}
