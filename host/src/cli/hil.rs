//! `tenax hil`: a real board in the loop, and a file of its figures.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use anyhow::Context;
use tenax_bench::hil::{Fitted, measure};
use tenax_serial::cli::port;
use tenax_serial::guide::bringup::Wire;
use tenax_serial::link::{Client, Target};

use super::out;

/// What resets the board through its probe.
const PROBE: &str = "probe-rs reset --chip STM32F411RETx";

/// Measure a real board in the loop: its clock, ticks, line, inputs and decisions.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Serial line: /dev/ttyACM0, COM3, /dev/pts/5 or tcp:127.0.0.1:7777 [default: the only board that is plugged in]
    #[arg(long, value_name = "PORT")]
    port: Option<Target>,
    /// Reset the board 21 times through its probe [default: you press its reset button once]
    #[arg(long)]
    probe: bool,
    /// The wires of docs/bring-up.md, from PA8 and PA9 to PC2 and PC3, are fitted
    #[arg(long)]
    harness: bool,
    /// Duration of each part, s
    #[arg(long, value_name = "S", default_value_t = 20)]
    seconds: u32,
    /// File for the figures
    #[arg(long, value_name = "FILE.toml", default_value = "hil.toml")]
    out: PathBuf,
}

/// Measures, and writes what was measured. 1: something does not pass.
pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let fitted = Fitted {
        lasts: Duration::from_secs(args.seconds.into()),
        reset: args.probe.then(|| PROBE.to_owned()),
        harness: args.harness,
    };
    let target = port::or_found(args.port.as_ref())?;
    let open = || Client::open(&target);
    let report = measure(&mut Wire::new(&open)?, &fitted, &mut |text| out::say!("{text}"))?;
    std::fs::write(&args.out, toml::to_string(&report)?)
        .with_context(|| format!("cannot write {}", args.out.display()))?;
    out::note!("  {:<14}{}", "written", args.out.display());
    Ok(ExitCode::from(u8::from(!report.passes())))
}
