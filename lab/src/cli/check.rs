//! `tenax check`: every promise, measured, one line each.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;

use tenax_frames::tool::status::Status;

use tenax_frames::tool::{out, workspace};
use crate::check::side_by_side::{Group, measure};
use crate::check::{Bar, Verdict, array, default_scene, learn, mistakes, pages, recordings, wearer};
use crate::suite;
use tenax_sim::board::Run;
use tenax_sim::budgets::Line;
use tenax_sim::live::Use;
use tenax_sim::report::text::Text;
use tenax_sim::session::{self, Board};

/// Measure every promise of the project, one line each; fails if one is not kept.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Where the recordings are [default: shared/data beside the checkout]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Run the host's build of the logic: no image, no emulator, fewer promises
    #[arg(long)]
    host: bool,
    /// Also check the budgets of `tenax size --check`, from the same run
    #[arg(long, conflicts_with = "host")]
    size: bool,
    /// Also run the other commands whose figures the pages quote, minutes each, and `learn` with three hours of holding
    #[arg(long, requires = "size")]
    pages: bool,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let root = workspace::root()?;
    let data = args.data.clone().unwrap_or_else(|| root.join("../shared/data"));
    let board = if args.host { Board::Host } else { Board::emulated(&root)? };
    if args.size {
        // Here, and not in the middle of what is measured side by side.
        tenax_sim::image::build_kernels(&root)?;
    }
    let told = Mutex::new(String::new());
    let mut groups = vec![
        Group::new("default scene", || default_scene(&root, &board, args, &told)),
        Group::new("wearer in all scenes", wearer::scenes),
        Group::new("random hands", || {
            Ok(vec![wearer::random(
                suite::all()
                    .args(["--quiet", "--test", "fingertip", "--", "wearer::", "adversary::"])
                    .current_dir(&root),
            )])
        }),
    ];
    groups.extend(recordings::groups(&data, &board)?);
    groups.push(Group::new("learn", || learn::bars(args.pages)));
    groups.push(Group::new("array", array::bars));
    groups.push(Group::new("mistakes", || Ok(mistakes::bars())));

    let status = Status::new("check");
    let (mut failed, mut skipped, mut passed) = (0, 0, 0);
    // Whoever stops reading still wants the verdict: it is the exit code.
    let mut printed = Ok(());
    let mut print = |bars: Vec<Bar>| {
        for bar in &bars {
            *told.lock().unwrap() += &format!("{bar}\n");
            match bar.verdict {
                Verdict::Pass => passed += 1,
                Verdict::Fail => failed += 1,
                Verdict::Skipped => skipped += 1,
                Verdict::Noted => {}
            }
        }
        if printed.is_ok() {
            status.print(|| printed = bars.iter().try_for_each(|bar| out::say!("{bar}")));
        }
    };
    measure(&groups, |running| status.say(running), &mut print)?;
    if args.size {
        let told = told.lock().unwrap().clone();
        print(pages::bars(&root, &told, args.pages)?);
    }
    drop(status);
    let last = || out::say!("{passed} kept, {failed} not kept, {skipped} skipped");
    out::unless_closed(printed.and_then(|()| last()))?;
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// One run of the default scene, and all that is told from it.
fn default_scene(root: &Path, board: &Board, args: &Args, told: &Mutex<String>) -> anyhow::Result<Vec<Bar>> {
    let file = session::load_scene(session::DEFAULT_SCENE)?;
    let mut run = Run::default();
    let outcome = session::scene_served(&file, 1, board, Use::default(), &mut run, &mut |_| {})?;
    run.summary = outcome.run.clone();
    *told.lock().unwrap() += &Text(&outcome.report).to_string();
    let mut bars = default_scene::bars(&outcome, (!args.host).then_some(&run));
    if args.size {
        bars.extend(size::lines(root, &outcome.report)?.iter().map(budget));
    }
    Ok(bars)
}

/// A line of `tenax size` as a promise.
fn budget(line: &Line) -> Bar {
    Bar::new("within its budget", line.to_string(), line.is_kept())
}
