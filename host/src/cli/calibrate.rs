//! `tenax calibrate`: the serial tools' calibrations at the hand, and that of a photoelastic head on its balance.

mod photoelastic;

use std::process::ExitCode;

use tenax_serial::cli::calibrate::{Hand, hand};

const EXAMPLES: &str = "\
Examples:
  tenax calibrate force --weights-n 1,2,5,10            each weight in its turn on the finger; prints how far each is off
  tenax calibrate friction --strokes 3                  strokes over the surface that is to be held; S2 follows
  tenax calibrate emg                                   rest, close, open: the wearer's muscles
  tenax calibrate photoelastic                          a scene's head on a scene's balance: the mean one
  tenax calibrate photoelastic --seed 3                 a head that came out otherwise
  tenax calibrate photoelastic --weights bench.csv      a real one: columns force_n and level_mv, from no load upwards
Without a hand: `tenax run --host --serve` with a scene, and --port with the place that it names.";

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
