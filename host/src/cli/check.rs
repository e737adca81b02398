//! `tenax check`: every promise, measured, one line each.

use std::path::PathBuf;
use std::process::{Command, ExitCode};

use super::out;
use super::progress::Progress;
use super::workspace;
use crate::board::Run;
use crate::check::{Bar, Verdict, default_scene, learn, mistakes, recordings, wearer};
use crate::session::{self, Board};

/// Measure every promise of the project, one line each; fails if one is not kept.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Where the recordings are [default: shared/data beside the checkout]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// On the host's build of the logic: no image, no emulator, and so not every promise
    #[arg(long)]
    host: bool,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let data = match &args.data {
        Some(data) => data.clone(),
        None => workspace::root()?.join("../shared/data"),
    };
    let board = if args.host { Board::Host } else { Board::emulated(&workspace::root()?)? };
    let (mut failed, mut skipped, mut passed) = (0, 0, 0);
    // Whoever stops reading still wants the verdict: it is the exit code.
    let mut printed = Ok(());
    let mut print = |bar: Bar| {
        if printed.is_ok() {
            printed = out::say!("{bar}");
        }
        match bar.verdict {
            Verdict::Pass => passed += 1,
            Verdict::Fail => failed += 1,
            Verdict::Skipped => skipped += 1,
            Verdict::Noted => {}
        }
    };

    let file = session::load_scene(session::DEFAULT_SCENE)?;
    let mut progress = Progress::new(&file.name, file.duration_s());
    let mut run = Run::default();
    let outcome = session::scene_with(&file, 1, &board, &mut run, &mut |s| progress.at(s))?;
    drop(progress);
    run.summary = outcome.run.clone();
    default_scene::bars(&outcome, (!args.host).then_some(&run)).into_iter().for_each(&mut print);
    wearer::scenes()?.into_iter().for_each(&mut print);
    print(wearer::random(
        Command::new("cargo")
            .args(["test", "--quiet", "--release", "--package", "tenax-host-tests", "--test", "wearer"])
            .current_dir(workspace::root()?),
    ));
    recordings::bars(&data, &board, &mut print)?;
    learn::bars()?.into_iter().for_each(&mut print);
    mistakes::bars().into_iter().for_each(&mut print);
    let last = || out::say!("{passed} kept, {failed} not kept, {skipped} skipped");
    out::unless_closed(printed.and_then(|()| last()))?;
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
