//! `tenax bring-up`: the ten steps of a new board, each measured over its line.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use anyhow::Context;
use serde::Serialize;

use super::{out, port};
use crate::guide::bringup::{Asked, Figure, STEPS, Step, Wire};
use crate::guide::selftest::named;
use crate::link::{Client, Target};

const EXAMPLES: &str = "\
Examples:
  tenax bring-up clock                                  compares the board's clock with this computer's for a minute
  tenax bring-up line --seconds 600                     ten minutes instead of an hour
  tenax bring-up noise pvdf                             pvdf_1 to pvdf_12
  tenax bring-up cuts --cut-power 'uhubctl -a cycle -d 1 -l 1-1 -p 2'
docs/bring-up.md says what passes.";

/// Measure a step of bring-up on a board.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The step; docs/bring-up.md says what to do and what passes
    #[arg(value_name = "STEP", value_parser = clap::builder::PossibleValuesParser::new(STEPS.map(|step| step.name)))]
    step: String,
    /// Prefixes of channel names, such as `pvdf` [default: all channels]
    #[arg(value_name = "CHANNEL")]
    channels: Vec<String>,
    /// Serial line: /dev/ttyACM0, COM3, /dev/pts/5 or tcp:127.0.0.1:7777 [default: the only board that is plugged in]
    #[arg(long, value_name = "PORT")]
    port: Option<Target>,
    /// Duration of the measurement, s [default: the step's own]
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// Number of repetitions, such as power cuts [default: the step's own]
    #[arg(long, value_name = "N")]
    times: Option<u32>,
    /// Shell command that cuts the power and restores it, for the step `cuts`
    #[arg(long, value_name = "COMMAND")]
    cut_power: Option<String>,
    /// Also write the figures to this file
    #[arg(long, value_name = "FILE.toml")]
    out: Option<PathBuf>,
}

#[derive(Serialize)]
struct Report<'a> {
    step: &'a str,
    passes: bool,
    figure: Vec<Figure>,
}

/// Measures the step. 1: it does not pass.
pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let step: &Step = STEPS.iter().find(|step| step.name == args.step).context("no step is called so")?;
    let asked = Asked {
        lasts: args.seconds.map(Duration::try_from_secs_f64).transpose()?,
        times: args.times,
        channels: named(&args.channels)?,
        cut_power: args.cut_power.clone(),
    };
    let target = port::or_found(args.port.as_ref())?;
    let open = || Client::open(&target);
    let figure = step.measure(&mut Wire::new(&open)?, &asked, &mut |text| out::say!("{text}"))?;
    let passes = figure.iter().all(Figure::passes);
    if let Some(path) = &args.out {
        let text = toml::to_string(&Report { step: step.name, passes, figure })?;
        std::fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))?;
    }
    Ok(ExitCode::from(u8::from(!passes)))
}
