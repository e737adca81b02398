//! `tenax evaluate`: the force array's network, scored; and what the wearer wants.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use rayon::prelude::*;

use tenax_frames::tool::format::Format;
use tenax_frames::tool::out;
use super::people::People;
use tenax_frames::tool::progress::with_bar;
use tenax_frames::tool::workspace;
use tenax_sim::array::network::Network;
use tenax_sim::array::real::{Logits, Real};
use tenax_sim::array::{Verdicts, adapt, readings};
use tenax_sim::jobs::Told;
use tenax_sim::labelled::{self, Part, Recording, library};
use tenax_sim::session::Board;
use crate::dataset::session::{Sizes, sessions};
use crate::dataset::{Dataset, Label, Plan};
use crate::evaluate::report::Report;
use crate::evaluate::roc::Roc;
use crate::evaluate::{draws, emg, online, test_split};

const EXAMPLES: &str = "\
Examples:
  tenax evaluate                                   the shipped network on the test split of the built-in data set
  tenax evaluate --report json                     for programs
  tenax evaluate --dataset my.csv --recipe my.toml --adapt 6
                                                   on recordings of one's own array, after 6 s of quiet holding of each object
  tenax evaluate --dataset my.csv --network out/train
                                                   the network that `tenax train` has made of one's own
  tenax evaluate --online --host                   the paper's two tasks, ten times with each of four materials
  tenax evaluate emg --recordings FOLDER           intent recognition on EMG envelopes of people";

/// Score the array's network on held-out data.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
pub struct Args {
    #[command(subcommand)]
    what: Option<What>,
    /// A labelled recording (CSV) instead of the built-in data set
    #[arg(long, value_name = "FILE.csv")]
    dataset: Option<PathBuf>,
    /// How its columns are read: a recipe file, or the name of one in recipes/ [default: by its name]
    #[arg(long, value_name = "FILE.toml|NAME", requires = "dataset")]
    recipe: Option<String>,
    /// The network in this folder of `tenax train` instead of the one that ships
    #[arg(long, value_name = "DIR", conflicts_with = "online")]
    network: Option<PathBuf>,
    /// Fit scale and threshold to N seconds of each session without slip, which are not scored; once from each quiet recording on
    #[arg(long, value_name = "N", conflicts_with = "online")]
    adapt: Option<f64>,
    /// Seed of the built-in data set, or of the online tasks
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Size of the built-in data set: training sessions of each material; validation and test are in proportion
    #[arg(long, value_name = "N", default_value_t = Sizes::DEFAULT_TRAIN, conflicts_with = "dataset")]
    sessions: usize,
    /// Part of the built-in data set. Choose by validation; keep test for final scores
    #[arg(long, value_name = "train|validation|test", default_value = "test", conflicts_with = "dataset")]
    part: Part,
    /// Sessions with one drawn quantity at a time outside the range of training, by quantity under `by_material`, instead of the test part
    #[arg(long, conflicts_with_all = ["dataset", "part", "online"])]
    outside: bool,
    /// The paper's two tasks with the whole hand, instead of recordings
    #[arg(long, conflicts_with_all = ["dataset", "sessions"])]
    online: bool,
    /// Online: repetitions of each task with each material
    #[arg(long, value_name = "N", default_value_t = online::TIMES, requires = "online")]
    times: usize,
    /// Online: run the host's own build of the logic, no image, no emulator
    #[arg(long, requires = "online")]
    host: bool,
    /// How to print the scores
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
}

/// What is scored instead of the force array's network.
#[derive(Debug, clap::Subcommand)]
enum What {
    /// Score intent recognition on recorded EMG envelopes of two muscles
    Emg(EmgArgs),
}

#[derive(Debug, clap::Args)]
struct EmgArgs {
    #[command(flatten)]
    people: People,
    /// Only this person
    #[arg(long, value_name = "N")]
    person: Option<u32>,
    /// Also score this many random electrode faults over people at rest
    #[arg(long, value_name = "N", default_value_t = 0)]
    faults: u32,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    if let Some(What::Emg(emg)) = &args.what {
        let People { recordings, seed, report: format } = &emg.people;
        let report = emg::evaluate(recordings, emg.person, emg.faults, *seed)?;
        out::unless_closed(format.show(&report))?;
        return Ok(ExitCode::SUCCESS);
    }
    if args.online {
        return online_tasks(args);
    }
    let recordings = recordings(args)?;
    let recordings = if args.dataset.is_some() { test_split(recordings) } else { recordings };
    if recordings.is_empty() {
        bail!("the data has no recording that is called test");
    }
    let network = args.network.as_deref().map_or_else(|| Ok(Network::shipped()), Network::read)?;
    let report = match args.adapt {
        Some(quiet_s) => {
            if !(quiet_s > 0.0 && quiet_s <= 3_600.0) {
                bail!("--adapt {quiet_s}: more than 0 s and at most an hour is allowed");
            }
            adapted(&network, &recordings, quiet_s)?
        }
        None => {
            if args.dataset.is_some() {
                adapt::accept(&network, &recordings)?;
            }
            let judge = |recording: &Recording| network.judge(&readings(&recording.steps));
            let (logits, said): (Vec<Logits>, Vec<Verdicts>) =
                with_bar("judging", |_| recordings.par_iter().map(judge).unzip());
            // The network that ships looks back over one frame, itself: there is no other to compare it with.
            let mut report = Report::new(&recordings, &said, &said);
            report.roc = Roc::of(&recordings, &logits);
            if args.dataset.is_none() && !args.outside {
                report.real = real(&network)?;
                let drawn = sessions(args.seed, Sizes::of_train(args.sessions));
                report.by_draw = draws::draws(&drawn, &recordings, &said, &logits);
            }
            report
        }
    };
    out::unless_closed(args.report.show(&report))?;
    Ok(ExitCode::SUCCESS)
}

/// What a network that has adapted to each session says of the rest of it: every calibration together.
fn adapted(network: &Network, recordings: &[Recording], quiet_s: f64) -> anyhow::Result<Report> {
    let calibrations = adapt::adapt(network, recordings, quiet_s)?;
    let judged = || calibrations.iter().flat_map(|own| own.logits.iter().zip(&own.on));
    let said: Vec<Verdicts> = judged()
        .map(|(logits, &on)| logits.iter().map(|logit| logit.is_some_and(|logit| logit >= on)).collect())
        .collect();
    let scored: Vec<Recording> = calibrations.iter().flat_map(|own| own.recordings.clone()).collect();
    Ok(Report { real: Real::of(&calibrations), ..Report::new(&scored, &said, &said) })
}

/// Recordings of a real array, and how long a network may hold each object quietly to adapt to it, s.
const REAL: (&str, f64) = ("../shared/data/array_biotac_sp_solids.csv", 6.0);

/// The same of the real array, where its recordings are present.
fn real(network: &Network) -> anyhow::Result<Option<Real>> {
    let (file, quiet_s) = REAL;
    let Some(file) = workspace::root().ok().map(|root| root.join(file)).filter(|file| file.exists()) else {
        out::note!("a real array: skipped, recording not present");
        return Ok(None);
    };
    let recordings = labelled::read(&file, &library::choose(&file, None)?)?;
    Ok(adapted(network, &recordings, quiet_s)?.real)
}

fn recordings(args: &Args) -> anyhow::Result<Vec<Recording>> {
    if let Some(path) = &args.dataset {
        let recipe = library::choose(path, args.recipe.as_deref())?;
        return Ok(with_bar("reading", |_| labelled::read(path, &recipe))?);
    }
    if args.sessions == 0 {
        bail!("--sessions must be at least 1");
    }
    let plan = Plan { seed: args.seed, sessions: args.sessions, label: Label::Truth };
    let make = |progress: Told| match args.outside {
        true => Dataset::make_outside(plan, progress),
        false => Dataset::make_split(plan, args.part, progress),
    };
    let csv = with_bar("sessions", make)?.csv()?;
    // The same bytes that `tenax dataset` writes, read as a user's file is.
    let name = "array_dataset.csv";
    let recipe = library::choose(name.as_ref(), None)?;
    Ok(labelled::parse(csv.as_slice(), &recipe, name)?)
}

fn online_tasks(args: &Args) -> anyhow::Result<ExitCode> {
    let board = board(args)?;
    let tries = with_bar("tasks", |progress| online::tasks(args.seed, args.times, &board, progress))?;
    if args.report == Format::Json {
        out::say!("{}", serde_json::to_string_pretty(&tries)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    out::say!(
        "task  material    kept      slid, mm (bound)   peak, N (bound, needed)   kept by its controls: no reflex, constant grip; alone s1, s2, hebbian, mlp"
    )?;
    for row in online::rows(&tries) {
        let by = |name: &str| row.kept_by.get(name).copied().unwrap_or_default();
        out::say!(
            "{:<6}{:<12}{:>2} of {:<2}  {:>8.2} ({:>6.2})   {:>8.2} ({:>5.2}, {:>5.2})   {}, {}; {}, {}, {}, {}",
            row.task,
            row.material,
            row.kept,
            row.tries,
            row.distance_mm,
            row.bound_distance_mm,
            row.peak_force_n,
            row.bound_peak_force_n,
            row.needed_force_n,
            by("no reflex"),
            by("constant grip"),
            by("s1 alone"),
            by("s2 alone"),
            by("hebbian alone"),
            by("mlp alone")
        )?;
    }
    Ok(ExitCode::SUCCESS)
}

fn board(args: &Args) -> anyhow::Result<Board> {
    if args.host { Ok(Board::Host) } else { Board::emulated(&workspace::root()?) }
}
