//! `tenax flash`: the image onto a real board, through probe-rs.

use std::path::PathBuf;
use std::process::{Command, ExitCode};

use anyhow::{Context, ensure};

use tenax_frames::tool::{image, out, workspace};

const INSTALL: &str = "\
probe-rs does not start, and it is what talks to the board's ST-LINK.
Install it with   cargo install probe-rs-tools --locked
or as https://probe.rs/docs/getting-started/installation says, then run `tenax flash` again.";

/// Flash a NUCLEO-F411RE through probe-rs.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Flash this file (ELF) instead of building the image
    #[arg(long, value_name = "FILE")]
    image: Option<PathBuf>,
    /// The chip's name in probe-rs. The image is linked for the default; another chip needs another image
    #[arg(long, default_value = "STM32F411RETx")]
    chip: String,
    /// Read the flash back and compare it with the image
    #[arg(long)]
    verify: bool,
    /// Then print the image's log from the probe (defmt over RTT) until Ctrl-C
    #[arg(long)]
    log: bool,
    /// The probe: VID:PID or VID:PID:SERIAL, such as 0483:374b, from `probe-rs list` [default: the only probe]
    #[arg(long)]
    probe: Option<String>,
}

const EXAMPLES: &str = "\
Examples:
  tenax flash                       build the image and flash the only probe's board
  tenax flash --verify --log        compare the flash, then print the image's log
  tenax flash --image FILE          flash this ELF
The ELF's path is printed: other programmers take it, too, such as
  openocd -f board/st_nucleo_f4.cfg -c 'program FILE verify reset exit'";

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    Command::new("probe-rs").arg("--version").output().context(INSTALL)?;
    let image = match &args.image {
        Some(image) => image.clone(),
        None => image::build(&workspace::root()?)?,
    };
    out::note!("the image is {}", image.display());
    let probe_rs = |what: &str| {
        let mut command = Command::new("probe-rs");
        command.args([what, "--chip", &args.chip]);
        command.args(args.probe.iter().flat_map(|probe| ["--probe", probe]));
        command
    };
    let mut download = probe_rs("download");
    download.args(args.verify.then_some("--verify")).arg(&image);
    for command in [&mut download, &mut probe_rs("reset")] {
        ensure!(
            command.status()?.success(),
            "probe-rs could not flash {}: see its message above; is the board plugged in, and may this user open its USB \
             device?",
            image.display()
        );
    }
    out::say!("flashed {}; watch it with   tenax monitor", image.display())?;
    if args.log {
        let status = probe_rs("attach").arg(&image).status()?;
        return Ok(ExitCode::from(u8::from(!status.success())));
    }
    Ok(ExitCode::SUCCESS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cargo_run_in_the_firmwares_folder_builds_what_is_flashed() {
        let table = |path: &str| -> toml::Table {
            let path = workspace::root().unwrap().join(path);
            std::fs::read_to_string(path).unwrap().parse().unwrap()
        };
        let (own, all) = (table("firmware/.cargo/config.toml"), table("Cargo.toml"));
        assert_eq!(own["build"]["target"].as_str(), Some(image::TARGET));
        for (key, value) in own["profile"]["dev"].as_table().unwrap() {
            assert_eq!(all["profile"]["firmware"].get(key), Some(value), "{key}");
        }
    }
}
