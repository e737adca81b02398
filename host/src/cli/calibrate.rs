//! `tenax calibrate`: the serial tools' calibrations at the hand, and that of a photoelastic head on its balance.

mod photoelastic;

use std::process::ExitCode;

use tenax_serial::cli::calibrate::{Hand, hand};

const EXAMPLES: &str = "\
Examples:
  tenax calibrate force --weights-n 1,2,5,10            one weight after the other on the finger; prints each reading's error
  tenax calibrate friction --strokes 3                  strokes over the surface to be held; sets S2
  tenax calibrate emg                                   rest, close, open: the wearer's muscles
  tenax calibrate photoelastic                          a simulated head of mean optics under simulated weights
  tenax calibrate photoelastic --seed 3                 another simulated head
  tenax calibrate photoelastic --weights bench.csv      a real head: columns force_n (N) and level_mv (mV)
Without a board: `tenax run --host --serve --loop --scene bench`, then --port with the port that it prints.";

/// Calibrate a sensor, step by step.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, clap::Subcommand)]
enum What {
    #[command(flatten)]
    Hand(Hand),
    Photoelastic(photoelastic::Args),
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    match &args.what {
        What::Hand(what) => hand(what),
        What::Photoelastic(args) => photoelastic::main(args),
    }
}
