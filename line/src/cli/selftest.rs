//! `tenax selftest`: tests every sensor's wire by a touch.

use std::process::ExitCode;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use tenax_frames::link::Client;
use tenax_frames::tool::out;
use tenax_logic::setting::SettingId;

use super::port::Line;
use crate::selftest::Selftest;

const SILENCE: Duration = Duration::from_secs(4);

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
    let all_pass = run(&mut args.line.open()?, &args.channels, args.within)?;
    Ok(ExitCode::from(u8::from(!all_pass)))
}

/// Runs the test to its end; whether all channels pass.
fn run(client: &mut Client, words: &[String], limit_s: u32) -> anyhow::Result<bool> {
    let (head, no_wearer) =
        (client.setting(SettingId::Head)? != 0, client.setting(SettingId::NoWearer)? != 0);
    let mut test = Selftest::named(words, head, no_wearer, limit_s)?;
    let (mut printed, mut heard) = (0, Instant::now());
    loop {
        test.said[printed..].iter().try_for_each(|line| out::say!("{line}"))?;
        printed = test.said.len();
        if let Some(why) = &test.failed {
            bail!("{why}");
        }
        if test.is_over() {
            return Ok(test.passes());
        }
        client.keep_streaming(false)?;
        if let Some(message) = client.next_message().context("the line ended")? {
            test.take(&message.received.message);
            heard = Instant::now();
        } else if heard.elapsed() > SILENCE {
            bail!("the board sends nothing");
        }
    }
}
