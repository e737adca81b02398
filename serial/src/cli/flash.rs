//! `tenax flash`: the image onto a real board, through probe-rs.

use std::path::PathBuf;
use std::process::{Command, ExitCode};

use anyhow::{Context, bail};

use tenax_launch::image::{self, Binary};

use super::out;
use super::workspace;

const CHIP: &str = "STM32F411RETx";
const INSTALL: &str = "\
probe-rs is not installed, and it is what talks to the board's ST-LINK.
Install it with   cargo install probe-rs-tools --locked
or as https://probe.rs/docs/getting-started/installation says, then run `tenax flash` again.";

/// Flash a NUCLEO-F411RE through probe-rs.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Flash this file (ELF) instead of building the image
    #[arg(long, value_name = "FILE")]
    image: Option<PathBuf>,
    /// Which probe, if several are plugged in: VID:PID or VID:PID:SERIAL, as `probe-rs list` shows
    #[arg(long)]
    probe: Option<String>,
}

/// Flashes the image.
pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    match Command::new("probe-rs").arg("--version").output() {
        Ok(output) if output.status.success() => {}
        Ok(output) => bail!("probe-rs does not start: {}", String::from_utf8_lossy(&output.stderr).trim()),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => bail!(INSTALL),
        Err(error) => return Err(error).context("cannot start probe-rs"),
    }
    let image = match &args.image {
        Some(image) => image.clone(),
        None => image::build(&workspace::root()?, Binary::Image)?,
    };
    let mut download = Command::new("probe-rs");
    download.args(["download", "--chip", CHIP]).arg(&image);
    let mut reset = Command::new("probe-rs");
    reset.args(["reset", "--chip", CHIP]);
    if let Some(probe) = &args.probe {
        download.args(["--probe", probe]);
        reset.args(["--probe", probe]);
    }
    for command in [&mut download, &mut reset] {
        let status = command.status().context("cannot start probe-rs")?;
        if !status.success() {
            bail!(
                "probe-rs could not flash {}: see its message above; is the board plugged in, and may this user open its \
                 USB device?",
                image.display()
            );
        }
    }
    out::say!("flashed {}; watch it with   tenax monitor", image.display())?;
    Ok(ExitCode::SUCCESS)
}
