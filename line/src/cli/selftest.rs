//! `tenax selftest`: tests every sensor's wire by a touch.

use std::process::ExitCode;

use super::port::Line;
use crate::guide::selftest;
use tenax_frames::tool::out;

const EXAMPLES: &str = "\
The page of `tenax monitor` has the same test.
Examples:
  tenax selftest                                        the board that is plugged in, every channel
  tenax selftest fsr array_3                            fsr_a to fsr_d, and array_3
A scene does what the prompts say if they are piped to it:
  mkfifo say; tenax run --host --serve --serve-at board --scene bench < say &
  tenax selftest --port board | tee say";

/// Touch every sensor in turn; say which wire is wrong.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Prefixes of channel names, such as `fsr` or `array_3`: tests these channels only [default: all channels; with
    /// no-wearer-flag all except the myosensors]
    #[arg(value_name = "CHANNEL")]
    channels: Vec<String>,
    #[command(flatten)]
    line: Line,
    /// Time to wait for each touch, s
    #[arg(long, value_name = "S", default_value_t = 8, value_parser = clap::value_parser!(u32).range(2..=120))]
    within: u32,
}

/// Tests the wires. 1: not all of them are right.
pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let all_pass =
        selftest::run(&mut args.line.open()?, &args.channels, args.within, &mut |text| out::say!("{text}"))?;
    Ok(ExitCode::from(u8::from(!all_pass)))
}
