//! `tenax learn`: a fingertip teaches itself slip; report and figures.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use anyhow::ensure;
use tenax_frames::tool::{folder, format::Format, out, progress::Progress};
use tenax_sim::board::agreement::Agreement;
use tenax_sim::session::Board;

use crate::learn::report::Report;
use crate::learn::{self, Options, Outcome, figures};

const EXAMPLES: &str = "\
Examples:
  tenax learn                       7 lessons and 50 held-out trials on the emulated board, and everything else: minutes
  tenax learn --host                the same on the host's build of the logic
  tenax learn --host --trials 5 --minutes 1 --fingertips 2
  tenax learn --report json > learn.json";

/// Teach the Hebbian network slip with a camera, and score it
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Run the trials on the host's own build of the logic: no image, no emulator
    #[arg(long)]
    host: bool,
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
    /// How to print the report; lab/src/learn/report.rs lists the keys of json
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
    /// Folder for report and figures
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    const MOST: u64 = 1_000;
    let &Args { seed, trials, minutes, lifts, fingertips, .. } = args;
    ensure!(trials >= 1, "--trials 0: at least one held-out trial is needed");
    for (name, count) in
        [("trials", trials), ("minutes", minutes), ("lifts", lifts), ("fingertips", fingertips)]
    {
        ensure!(count <= MOST, "--{name} {count}: at most {MOST} are allowed");
    }
    let options = Options { seed, trials, minutes, lifts, fingertips };
    let folder = folder::made(&args.out)?;
    let outcome = run(&options, &super::board(args.host)?)?;
    let report = Report::of(&outcome);
    out::unless_closed(args.report.show(&report))?;
    if let Some(agreement) = &outcome.agreement {
        out::note!("  {:<26}{agreement}", "image and host's logic");
    }
    super::write(&folder.join("learn.json"), &serde_json::to_vec_pretty(&report)?)?;
    super::write(&folder.join("learn-worth.svg"), figures::draw(&outcome)?.as_bytes())?;
    let agrees = outcome.agreement.as_ref().is_none_or(Agreement::holds);
    Ok(if agrees { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// All parts, with a progress line for each.
fn run(options: &Options, board: &Board) -> anyhow::Result<Outcome> {
    let bar: Mutex<Option<(String, Progress)>> = Mutex::new(None);
    learn::run(options, board, &|what, part| {
        // A bar that a panicking thread left is still a bar.
        let mut bar = bar.lock().unwrap_or_else(PoisonError::into_inner);
        if bar.as_ref().is_none_or(|(before, _)| before != what) {
            *bar = Some((what.to_owned(), Progress::new(what, 1.0)));
        }
        if let Some((_, progress)) = bar.as_mut() {
            progress.at(part);
        }
    })
}
