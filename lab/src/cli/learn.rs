//! `tenax learn`: a fingertip teaches itself slip; report and figures.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use anyhow::{Context, ensure};

use tenax_frames::tool::format::Format;
use tenax_frames::tool::out;
use tenax_frames::tool::progress::Progress;
use tenax_frames::tool::workspace;
use tenax_sim::board::agreement::Agreement;
use tenax_sim::session::Board;
use tenax_sim::plot::png;
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
    /// Random fingertips whose films lie in random directions, too: some hear the grip more than slip
    #[arg(long)]
    turned_films: bool,
    /// Seed of all random numbers
    #[arg(long, default_value_t = Options::default().seed)]
    seed: u64,
    /// How to print the report; studies/src/learn/report.rs lists the keys of json
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
    /// Where report and figures are written
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    const MOST: u64 = 1_000;
    ensure!(args.trials >= 1, "--trials 0: at least one held-out trial is needed");
    let options = Options {
        seed: args.seed,
        trials: args.trials,
        minutes: args.minutes,
        lifts: args.lifts,
        fingertips: args.fingertips,
        turned_films: args.turned_films,
        controls: true,
    };
    let counts = [
        ("trials", options.trials),
        ("minutes", options.minutes),
        ("lifts", options.lifts),
        ("fingertips", options.fingertips),
    ];
    for (name, count) in counts {
        ensure!(count <= MOST, "--{name} {count}: at most {MOST} are allowed");
    }
    let board = if args.host { Board::Host } else { Board::emulated(&workspace::root()?)? };
    let outcome = run(&options, &board)?;
    out::unless_closed(args.report.show(&Report::of(&outcome)))?;
    if let Some(agreement) = &outcome.agreement {
        out::note!("  {:<26}{agreement}", "image and host's logic");
    }
    for file in write(&args.out, &outcome)? {
        out::note!("  {:<26}{}", "written", file.display());
    }
    let agrees = outcome.agreement.as_ref().is_none_or(Agreement::holds);
    Ok(if agrees { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// All of it, with a bar for each part.
pub fn run(options: &Options, board: &Board) -> anyhow::Result<Outcome> {
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

/// Writes everything, and says where.
fn write(folder: &Path, outcome: &Outcome) -> anyhow::Result<Vec<PathBuf>> {
    let cannot = |path: &Path| format!("cannot write {}", path.display());
    fs::create_dir_all(folder).with_context(|| cannot(folder))?;
    let mut contents = vec![(folder.join("learn.json"), serde_json::to_vec_pretty(&Report::of(outcome))?)];
    for (name, svg) in figures::draw_all(outcome)? {
        contents.push((folder.join(name).with_extension("png"), png::png(&svg)?));
        contents.push((folder.join(name).with_extension("svg"), svg.into_bytes()));
    }
    let mut files = Vec::new();
    for (path, bytes) in contents {
        fs::write(&path, bytes).with_context(|| cannot(&path))?;
        files.push(path);
    }
    Ok(files)
}
