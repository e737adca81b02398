//! `tenax train`: learns the force array's detector; `train emg` fits the wearer's model.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::{Context, ensure};
use tenax_frames::tool::{folder, format::Format, out, progress::with_bar, workspace};
use tenax_logic::array::COVARIANCE_WINDOW;
use tenax_sim::array::network::{self, Network};
use tenax_sim::array::{adapt, edges};
use tenax_sim::labelled::{self, Part, library};
use tenax_sim::scorer::Doing;

use super::People;
use crate::dataset::{Plan, session::Sizes};
use crate::evaluate::fit as emg_fit;
use crate::train::export;
use crate::train::features::{Recipe, Sequence, sequence};
use crate::train::fit::{self, FEW_OBJECTS, SHIPPED};
use crate::train::quantise::Quantised;
use crate::train::report::{Data, Report};
use crate::train::score::{Aim, Judged, score};
use crate::train::table::Table;

const EXAMPLES: &str = "\
Examples:
  tenax train                                     from the data set of `tenax dataset`, which is made if it is not there
  tenax train --dataset mine.csv --recipe r.toml  from recordings of your own; docs/array.md says how to write a recipe
  tenax train emg --recordings FOLDER             the constants of intent recognition, leaving out each person once";

/// The default file of `tenax dataset`.
const DATASET: &str = "out/array_dataset.csv";

/// Train the force array's slip detector from labelled recordings
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
pub struct Args {
    #[command(subcommand)]
    what: Option<What>,
    /// Labelled recordings to train on [default: out/array_dataset.csv of `tenax dataset`]
    #[arg(long, value_name = "FILE.csv")]
    dataset: Option<PathBuf>,
    /// How to read them: a recipe file, or the name of one in recipes/ [default: by the file's name]
    #[arg(long, value_name = "FILE.toml|NAME")]
    recipe: Option<String>,
    /// Folder for the network (Rust, JSON), its model card and the report
    #[arg(long, value_name = "DIR", default_value = "out/train")]
    out: PathBuf,
    /// Seed of the initial weights and of the training order
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How to print the report
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
    /// Copy the network to logic/src/array/network.in
    #[arg(long)]
    ship: bool,
}

#[derive(Debug, clap::Subcommand)]
enum What {
    /// Fit intent recognition to recorded EMG envelopes of people
    Emg(EmgArgs),
}

#[derive(Debug, clap::Args)]
struct EmgArgs {
    #[command(flatten)]
    people: People,
    /// Rounds of the search; each takes 0.1 s a person
    #[arg(long, value_name = "N", default_value_t = 600)]
    rounds: u32,
    /// Write the constants into the firmware's source
    #[arg(long)]
    ship: bool,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    if let Some(What::Emg(EmgArgs { people, rounds, ship })) = &args.what {
        let report =
            with_bar("fitting", |part| emg_fit::fit(&people.recordings, *rounds, people.seed, part))?;
        out::unless_closed(people.report.show(&report))?;
        if *ship {
            shipped("logic/src/emg/fitted.rs", report.file.as_bytes())?;
        }
        return Ok(ExitCode::SUCCESS);
    }
    let folder = folder::made(&args.out)?;
    let dataset = args.dataset.clone().unwrap_or_else(|| DATASET.into());
    if args.dataset.is_none() && !dataset.exists() {
        out::note!("no {DATASET} yet: making it");
        super::dataset::make(Plan { seed: 1, sessions: Sizes::DEFAULT_TRAIN }, &dataset)?;
    }
    // The matrices are small: a second thread costs more than it saves, and with one nothing depends on which is first.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let files = pool.install(|| train(&dataset, args))?;
    for (name, bytes) in &files {
        super::write(&folder.join(name), bytes)?;
    }
    if args.ship {
        shipped("logic/src/array/network.in", &fs::read(folder.join("network.in"))?)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Writes a Rust file of the project, formatted.
fn shipped(to: &str, bytes: &[u8]) -> anyhow::Result<()> {
    let to = workspace::root()?.join(to);
    super::write(&to, bytes)?;
    workspace::run(Command::new("rustfmt").args(["--edition", "2024"]).arg(&to))?;
    Ok(())
}

/// Learns a file, prints the report, and gives the files to write. The test part is not looked at.
fn train(path: &Path, args: &Args) -> anyhow::Result<[(&'static str, Vec<u8>); 4]> {
    let name = path.display().to_string();
    let recipe = library::choose(path, args.recipe.as_deref())?;
    let features = Recipe::of(&recipe);
    ensure!(!args.ship || features.window == COVARIANCE_WINDOW, "the firmware has another window");
    let bytes = fs::read(path).with_context(|| format!("{name}: cannot be read"))?;
    let mut recordings = labelled::parse(bytes.as_slice(), &recipe, &name)?;
    recordings.retain(|own| own.part != Some(Part::Test));
    let sequences: Vec<Sequence> = recordings.iter().map(|own| sequence(own, &features)).collect();
    ensure!(
        sequences.iter().any(|sequence| !sequence.features.is_empty()),
        "{name}: every recording is shorter than the windows, {} readings at 80 Hz",
        features.ready_after()
    );
    let is_learned = |part| matches!(part, None | Some(Part::Train));
    let learned: Vec<&Sequence> = sequences.iter().filter(|own| is_learned(own.part)).collect();
    // What is disturbed has more noise than its array, and no slip to be learned in it.
    let noise = recordings.iter().filter(|own| is_learned(own.part) && own.doing != Doing::Disturb);
    let noise = noise.map(|own| adapt::noise_samples(&own.steps));
    let noise = noise.fold([f64::INFINITY, 0.0], |[low, high], own| [low.min(own), own.max(high)]);
    let file = path.file_name().map_or(name, |file| file.to_string_lossy().into_owned());
    let data = Data::of(&file, &bytes, &learned);

    let (aim, candidates) = if sequences.iter().any(|own| own.part.is_some()) {
        (Aim::Pours, &SHIPPED[..])
    } else {
        (Aim::Balanced, &FEW_OBJECTS[..])
    };
    let trained = with_bar("training", |progress| {
        fit::fit(&sequences, candidates, aim, args.seed, &mut |part| progress(part))
    })?;
    let choice = trained.choice;
    let quantised = Quantised::of(&trained.network, &Table::of(learned.iter().copied()));
    let mut saved = export::saved(&quantised, &features, &choice, &data.sha256, noise);
    let is_validated = |part, doing| part == Some(Part::Validation) && doing == Doing::Pour;
    recordings.retain(|own| is_validated(own.part, own.doing));
    let edges = if recordings.is_empty() || !Network::WINDOWS.contains(&saved.window) {
        None
    } else {
        let network = Network::of(&saved)?;
        let judged: Vec<_> = recordings.iter().map(|own| (own, network.confidences(&own.steps))).collect();
        edges::choose(&judged)
    };
    if let Some(chosen) = &edges {
        saved.edges = chosen.edges;
    }
    let pours = || sequences.iter().filter(|own| is_validated(own.part, own.doing));
    let float = fit::judge(&trained.network, &Table::of(pours()));
    let mut exported = Judged::default();
    for own in pours() {
        exported.extend(&Judged { logits: quantised.logits(own)?, slips: own.slips.clone() });
    }
    let scored = |judged: &Judged| (!judged.slips.is_empty()).then(|| score(judged, choice.threshold));
    let report = Report {
        seed: args.seed,
        data,
        features,
        choice,
        threshold_permille: export::permille(&choice),
        edges,
        float: scored(&float),
        exported: scored(&exported),
    };
    out::unless_closed(args.report.show(&report))?;
    let about = format!(
        "Learned from `{}` (SHA-256 {}), seed {}; docs/array.md says how it is judged.",
        report.data.file, report.data.sha256, report.seed
    );
    Ok([
        ("network.in", export::rust(&saved, &features, &about).into_bytes()),
        (network::FILE, serde_json::to_vec(&saved)?),
        ("model-card.md", report.card().into_bytes()),
        ("report.json", serde_json::to_vec_pretty(&report)?),
    ])
}
