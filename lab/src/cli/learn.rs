//! `tenax learn`: a fingertip teaches itself slip.

use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use tenax_frames::tool::{out, progress::Progress};

use crate::check::learn::bars;
use crate::learn::Options;

/// Teach the Hebbian network slip with a camera, and score it; it takes minutes
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Seed of all random numbers
    #[arg(long, default_value_t = Options::default().seed)]
    seed: u64,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let bar: Mutex<Option<(String, Progress)>> = Mutex::new(None);
    let options = Options { seed: args.seed, ..Options::default() };
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
