//! `tenax calibrate`: a person is told step by step what to do at the hand, and what came of it.

use std::process::ExitCode;

use super::port;
use crate::guide;
use tenax_frames::link::{Client, Target};
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
    what: Hand,
}

/// What is calibrated at the hand.
#[derive(Debug, clap::Subcommand)]
pub enum Hand {
    /// Zero the force sensor and check it with known weights
    Force {
        /// Which line.
        #[command(flatten)]
        line: Line,
        /// The weights in the order in which you put them on, N (0.1 to 60)
        #[arg(long, value_name = "N,N,...", value_delimiter = ',', default_values_t = [1.0, 2.0, 5.0, 10.0], value_parser = weight)]
        weights_n: Vec<f64>,
    },
    /// Measure a surface's static friction by strokes over it, and set S2 from it
    Friction {
        /// Which line.
        #[command(flatten)]
        line: Line,
        /// Number of strokes, 1 to 20
        #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=20))]
        strokes: u32,
    },
    /// Calibrate the myosensors to the wearer: three prompts of 5 s
    Emg {
        /// Which line.
        #[command(flatten)]
        line: Line,
    },
}

/// Which line.
#[derive(Debug, clap::Args)]
pub struct Line {
    /// Serial line: /dev/ttyACM0, COM3, /dev/pts/5 or tcp:127.0.0.1:7777 [default: the only board that is plugged in]
    #[arg(long, value_name = "PORT")]
    port: Option<Target>,
}

impl Line {
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
