//! `tenax calibrate`: tells a person step by step what to do at the hand, and the result.

use std::process::ExitCode;

use super::port::Line;
use crate::guide;
use tenax_frames::tool::out;

const EXAMPLES: &str = "\
Examples:
  tenax calibrate force --weights-n 1,2,5,10            one weight after the other on the finger; prints each reading's error
  tenax calibrate friction --strokes 3                  strokes over the surface to be held; sets S2
  tenax calibrate emg                                   rest, close, open: the wearer's muscles
Without a board: `tenax run --host --serve --loop --scene bench`, then --port with the port that it prints.";

/// Calibrate a sensor, step by step.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(subcommand)]
    what: What,
    #[command(flatten)]
    line: Line,
}

#[derive(Debug, clap::Subcommand)]
enum What {
    /// Zero the force sensor and check it with known weights
    Force {
        /// The weights in the order in which you put them on, N (0.1 to 60)
        #[arg(long, value_name = "N,N,...", value_delimiter = ',', default_values_t = [1.0, 2.0, 5.0, 10.0], value_parser = weight)]
        weights_n: Vec<f64>,
    },
    /// Measure a surface's static friction by strokes over it, and set S2 from it
    Friction {
        /// Number of strokes, 1 to 20
        #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=20))]
        strokes: u32,
    },
    /// Calibrate the myosensors to the wearer: three prompts of 5 s
    Emg,
}

fn weight(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(weight) if (0.1..=60.0).contains(&weight) => Ok(weight),
        Ok(_) => Err("a weight is from 0.1 to 60 N".to_owned()),
        Err(_) => Err("write weights as 1,2,5 in N".to_owned()),
    }
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let say: guide::Say<'_> = &mut |text| out::say!("{text}");
    let mut client = args.line.open()?;
    match &args.what {
        What::Force { weights_n } => guide::force::calibrate(&mut client, weights_n, say)?,
        What::Friction { strokes } => guide::friction(&mut client, *strokes, say)?,
        What::Emg => guide::emg(&mut client, say)?,
    }
    Ok(ExitCode::SUCCESS)
}
