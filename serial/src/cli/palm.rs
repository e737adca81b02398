//! `tenax palm`: a palm's board.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use super::{out, port};
use crate::link::Target;
use crate::palm::{Palm, Told, file_of, read};

/// Show which fingers a palm's hand has, and what happens on its bus.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The palm's serial line [default: the only board that is plugged in]
    #[arg(long, value_name = "PORT")]
    port: Option<Target>,
    /// Have the palm keep the fingers of this file from now on
    #[arg(long, value_name = "FILE.toml")]
    keep: Option<PathBuf>,
    /// Then print what happens on the bus for so long, s [default: until Ctrl-C]
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
}

const EXAMPLES: &str = "\
Examples:
  tenax palm                                 its fingers, and chips on the bus that are none of them
  tenax palm --keep hand.toml                have it keep other fingers; open the hand first
  tenax monitor --port /dev/ttyACM0#2        its second finger; every command takes a finger as PORT#N
The file has a table for each finger, in the order of their addresses:
  [[finger]]
  chip = \"0030002c-31365105-33393536\"        # as printed
  at_deg = 120                               # where it stands around the object
  ceiling_n = 40                             # the most that it may press";

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let wanted = args.keep.as_deref().map(read).transpose()?;
    let mut palm = Palm::open(&port::or_found(args.port.as_ref())?)?;
    if let Some(places) = wanted {
        out::note!("keeping them takes up to 2 s");
        palm.keep(&places)?;
    }
    let places = palm.hand()?;
    if places.is_empty() {
        out::say!("this hand has no fingers yet")?;
    }
    out::print(format_args!("{}", file_of(&places)))?;
    let began = Instant::now();
    let ends = args.seconds.map(Duration::from_secs_f64);
    while ends.is_none_or(|ends| began.elapsed() < ends) {
        if let Some(report) = palm.report()? {
            out::say!("{:>8.3} s  {}", began.elapsed().as_secs_f64(), Told(report))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}
