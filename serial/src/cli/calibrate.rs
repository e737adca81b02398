//! `tenax calibrate`: a person is told step by step what to do at the hand, and what came of it.

use std::process::ExitCode;

use super::{out, port};
use crate::guide;
use crate::link::{Client, Target};

const EXAMPLES: &str = "\
Examples:
  tenax calibrate force --weights-n 1,2,5,10            each weight in its turn on the finger; prints how far each is off
  tenax calibrate friction --strokes 3                  strokes over the surface that is to be held; S2 follows
  tenax calibrate emg                                   rest, close, open: the wearer's muscles
Without a hand: `tenax run --host --serve` with a scene, and --port with the place that it names.";

/// Calibrate a sensor, step by step.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(subcommand)]
    what: Hand,
}

/// What is calibrated at the hand.
#[derive(Debug, clap::Subcommand)]
pub enum Hand {
    /// The force sensor under known weights: zeroes it, and shows how far each reading is off
    Force {
        /// Which line.
        #[command(flatten)]
        line: Line,
        /// The weights in the order in which they are put on, N
        #[arg(long, value_name = "N,N,...", value_delimiter = ',', default_values_t = [1.0, 2.0, 5.0, 10.0], value_parser = weight)]
        weights_n: Vec<f64>,
    },
    /// The friction of a surface by strokes over it: measures mu_s, from which S2 follows
    Friction {
        /// Which line.
        #[command(flatten)]
        line: Line,
        /// How many strokes
        #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=20))]
        strokes: u32,
    },
    /// The wearer's muscles: three prompts of 5 s
    Emg {
        /// Which line.
        #[command(flatten)]
        line: Line,
    },
}

/// Which line.
#[derive(Debug, clap::Args)]
pub struct Line {
    /// Where the line is [default: the only board that is plugged in]
    #[arg(long, value_name = "PORT")]
    port: Option<Target>,
}

impl Line {
    /// Opens it.
    pub fn open(&self) -> anyhow::Result<Client> {
        Client::open(&port::or_found(self.port.as_ref())?)
    }
}

fn weight(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(weight) if (0.1..=60.0).contains(&weight) => Ok(weight),
        Ok(_) => Err("a weight is from 0.1 to 60 N".to_owned()),
        Err(_) => Err("write weights as 1,2,5 in N".to_owned()),
    }
}

/// Calibrates one sensor.
pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    hand(&args.what)
}

/// Calibrates one sensor at the hand.
pub fn hand(what: &Hand) -> anyhow::Result<ExitCode> {
    let say: guide::Say<'_> = &mut |text| out::say!("{text}");
    match what {
        Hand::Force { line, weights_n } => {
            let calibration = guide::force::calibrate(&mut line.open()?, weights_n, say)?;
            say(&format!("\n{}", calibration.text().trim_end()))?;
        }
        Hand::Friction { line, strokes } => {
            let measured = guide::friction::calibrate(&mut line.open()?, *strokes, say)?;
            let [mu_s, s2] =
                [measured.mu_s_permille, measured.s2_permille].map(|permille| f64::from(permille) / 1e3);
            say(&format!(
                "Static friction {mu_s:.3} on the scale of Ft/Fn; S2 is {s2:.3} from now on, and kept."
            ))?;
        }
        Hand::Emg { line } => {
            let apart = guide::emg::calibrate(&mut line.open()?, say)?;
            say(&format!(
                "Taken, and kept: rest, closing and opening are {apart:.1} deviations apart (3 are needed)."
            ))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}
