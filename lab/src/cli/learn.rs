//! `tenax learn`: a fingertip teaches itself slip.

use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use anyhow::ensure;
use tenax_frames::tool::{out, progress::Progress};

use crate::check::learn::bars;
use crate::learn::Options;

const EXAMPLES: &str = "\
Examples:
  tenax learn                       7 lessons and 50 held-out trials, and everything else: minutes
  tenax learn --trials 5 --minutes 1 --fingertips 2";

/// Teach the Hebbian network slip with a camera, and score it
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Number of held-out trials after the seven lessons
    #[arg(long, value_name = "N", default_value_t = Options::default().trials)]
    trials: u64,
    /// Minutes of holding without slip, to count false alarms
    #[arg(long, value_name = "N", default_value_t = Options::default().minutes)]
    minutes: u64,
    /// Number of lifts and of pours in which network, camera and bound each trigger the reflex
    #[arg(long, value_name = "N", default_value_t = Options::default().lifts)]
    lifts: u64,
    /// Number of random fingertips that learn the same way
    #[arg(long, value_name = "N", default_value_t = Options::default().fingertips)]
    fingertips: u64,
    /// Seed of all random numbers
    #[arg(long, default_value_t = Options::default().seed)]
    seed: u64,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    const MOST: u64 = 1_000;
    let &Args { seed, trials, minutes, lifts, fingertips } = args;
    ensure!(trials >= 1, "--trials 0: at least one held-out trial is needed");
    for (name, count) in
        [("trials", trials), ("minutes", minutes), ("lifts", lifts), ("fingertips", fingertips)]
    {
        ensure!(count <= MOST, "--{name} {count}: at most {MOST} are allowed");
    }
    let bar: Mutex<Option<(String, Progress)>> = Mutex::new(None);
    let options = Options { seed, trials, minutes, lifts, fingertips };
    let bars = bars(&options, &|what, part| {
        // A bar that a panicking thread left is still a bar.
        let mut bar = bar.lock().unwrap_or_else(PoisonError::into_inner);
        if bar.as_ref().is_none_or(|(before, _)| before != what) {
            *bar = Some((what.to_owned(), Progress::new(what, 1.0)));
        }
        if let Some((_, progress)) = bar.as_mut() {
            progress.at(part);
        }
    })?;
    out::unless_closed(bars.iter().try_for_each(|bar| out::say!("{bar}")))?;
    Ok(ExitCode::SUCCESS)
}
