//! `tenax-train`: what `tenax train` starts.
#![forbid(unsafe_code)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, ensure};
use clap::{Parser, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use tenax_sim::array::adapt;
use tenax_sim::array::edges::{self, Chosen};
use tenax_sim::array::network::{Network, Saved};
use tenax_sim::labelled::recipe::ArrayRecipe;
use tenax_sim::labelled::{self, Part, Recording, library};
use tenax_sim::scorer::Doing;
use crate::train::candidates;
use crate::train::export;
use crate::train::features::{self, Recipe, Sequence};
use crate::train::fit::{self, Trained};
use crate::train::quantise::Quantised;
use crate::train::report::{Data, Report, Test};
use crate::train::score::{Aim, Judged};
use crate::train::table::Table;

/// Train the force array's slip detector.
#[derive(Debug, Parser)]
#[command(name = "tenax-train", version)]
struct Args {
    /// Labelled recordings to train on
    #[arg(long, value_name = "FILE.csv")]
    dataset: PathBuf,
    /// How to read them: a recipe file, or the name of one in recipes/ [default: by the file's name]
    #[arg(long, value_name = "FILE.toml|NAME")]
    recipe: Option<String>,
    /// Further recordings (same recipe), used for scoring only; may be given more than once
    #[arg(long, value_name = "FILE.csv")]
    test: Vec<PathBuf>,
    /// Where the network, its model card and the report are written
    #[arg(long, value_name = "DIR", default_value = "out/train")]
    out: PathBuf,
    /// Seed of the initial weights and of the training order
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How to print the report
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
    /// Also score on the test part of the data: once, for a network to be shipped
    #[arg(long)]
    open_test: bool,
    /// Train on the paper's 76 features only, as a control
    #[arg(long)]
    paper_only: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people
    Text,
    /// For programs
    Json,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> anyhow::Result<()> {
    let recipe = library::choose(&args.dataset, args.recipe.as_deref())?;
    let features = Recipe { paper_only: args.paper_only, ..features_of(&recipe) };
    let Loaded { data, sequences, noise_samples, pours: recorded_pours } =
        load(&args.dataset, &recipe, &features, args.open_test)?;
    let bar = bar();
    bar.set_message("training");
    let parts = sequences.iter().any(|sequence| sequence.part.is_some());
    let (aim, candidates) = if parts {
        (Aim::Pours, candidates::SHIPPED.to_vec())
    } else {
        (Aim::Balanced, candidates::FEW_OBJECTS.to_vec())
    };
    let trained =
        fit::fit(&sequences, &candidates, aim, args.seed, &mut |part| bar.set_position((1e3 * part) as u64))?;
    bar.finish_and_clear();
    let mut tests: Vec<Sequence> =
        sequences.iter().filter(|own| args.open_test && own.part == Some(Part::Test)).cloned().collect();
    let pours = sequences.iter().filter(|own| own.part == Some(Part::Validation) && own.doing == Doing::Pour);
    let pours: Vec<Sequence> = pours.cloned().collect();
    let mut test_data = None;
    for path in &args.test {
        let more = load(path, &recipe, &features, true)?;
        tests.extend(more.sequences);
        test_data = Some(more.data);
    }
    let learned: Vec<&Sequence> =
        sequences.iter().filter(|s| matches!(s.part, None | Some(Part::Train))).collect();
    let quantised = Quantised::of(&trained.network, &Table::of(learned.iter().copied()), 8);
    let mut saved = export::saved(&quantised, &features, &trained.choice, &data.sha256, noise_samples);
    let chosen = choose_edges(&saved, &recorded_pours)?;
    if let Some(Chosen { edges, .. }) = chosen {
        saved.edges = edges;
    }
    let report = Report {
        seed: args.seed,
        data,
        test_data,
        features,
        choice: trained.choice,
        threshold_permille: export::permille(&trained.choice),
        edges: chosen,
        sizes: candidates::sizes(trained.choice.candidate.look_back),
        validation: test_quantised(&trained, &quantised, &pours)?,
        float: test(&trained, &tests),
        quantised: test_quantised(&trained, &quantised, &tests)?,
        quantised_16: {
            let wide = Quantised::of(&trained.network, &Table::of(learned.iter().copied()), 16);
            test_quantised(&trained, &wide, &tests)?
        },
    };
    let about = format!(
        "Learned from `{}` (SHA-256 {}), seed {}; docs/model-card.md has its scores.",
        report.data.file, report.data.sha256, report.seed
    );
    let rust = export::rust(&quantised, &features, &trained.choice, saved.edges, &about);
    let json = serde_json::to_vec_pretty(&report)?;
    match args.report {
        Format::Text => print!("{}", report.card()),
        Format::Json => println!("{}", String::from_utf8_lossy(&json)),
    }
    let files = [
        ("network.rs", rust.into_bytes()),
        (tenax_sim::array::network::FILE, serde_json::to_vec(&saved)?),
        ("model-card.md", report.card().into_bytes()),
        ("report.json", json),
    ];
    write(&args.out, &files)
}

/// What the recipe says of features; what it does not say is the firmware's.
fn features_of(recipe: &ArrayRecipe) -> Recipe {
    let given = &recipe.features;
    let frames = |frames: &Option<toml::Spanned<u8>>, default: usize| {
        frames.as_ref().map_or(default, |frames| usize::from(*frames.get_ref()))
    };
    let window = frames(&given.window, Recipe::FIRMWARE.window);
    Recipe {
        lag: frames(&given.lag, Recipe::FIRMWARE.lag),
        window,
        // Figure 6 varies them together.
        spectrum: match window {
            1 => 10,
            2..=5 => 20,
            _ => 40,
        },
        covariance_knee: given.covariance_knee.unwrap_or(Recipe::FIRMWARE.covariance_knee),
        spectrum_knee: given.spectrum_knee.unwrap_or(Recipe::FIRMWARE.spectrum_knee),
        structure_knee: given.structure_knee.unwrap_or(Recipe::FIRMWARE.structure_knee),
        paper_only: false,
    }
}

struct Loaded {
    data: Data,
    sequences: Vec<Sequence>,
    /// The least and the greatest noise of the recordings to learn from.
    noise_samples: [f64; 2],
    /// The pours of the validation part, as they were recorded.
    pours: Vec<Recording>,
}

/// Reads a file; with `test`, its test part, too.
fn load(path: &Path, recipe: &ArrayRecipe, features: &Recipe, test: bool) -> anyhow::Result<Loaded> {
    let name = path.display().to_string();
    let bytes = fs::read(path).with_context(|| format!("{name}: cannot be read"))?;
    let mut recordings = labelled::parse(bytes.as_slice(), recipe, &name)?;
    recordings.retain(|own| test || own.part != Some(Part::Test));
    let sequences: Vec<Sequence> =
        recordings.iter().map(|recording| features::sequence(recording, features)).collect();
    ensure!(
        sequences.iter().any(|sequence| !sequence.features.is_empty()),
        "{name}: every recording is shorter than the windows, {} readings at 80 Hz",
        features.ready_after()
    );
    // What is disturbed has more noise than its array, and no slip to be learned in it.
    let may_learn = recordings
        .iter()
        .filter(|own| matches!(own.part, None | Some(Part::Train)) && own.doing != Doing::Disturb);
    let noise = may_learn.map(|own| adapt::noise_samples(&own.steps));
    let noise_samples = noise.fold([f64::INFINITY, 0.0], |[low, high], own| [low.min(own), own.max(high)]);
    let file = path.file_name().map_or(name.clone(), |file| file.to_string_lossy().into_owned());
    let learned = sequences.iter().filter(|s| matches!(s.part, None | Some(Part::Train)));
    let data = Data::of(&file, &bytes, learned);
    recordings.retain(|own| own.part == Some(Part::Validation) && own.doing == Doing::Pour);
    Ok(Loaded { data, sequences, noise_samples, pours: recordings })
}

/// The edges that serve the validation's pours best. None if there are no pours, or a window that only training knows.
fn choose_edges(saved: &Saved, pours: &[Recording]) -> anyhow::Result<Option<Chosen>> {
    if pours.is_empty() || !Network::WINDOWS.contains(&saved.window) {
        return Ok(None);
    }
    let network = Network::of(saved)?;
    let judged: Vec<_> = pours.iter().map(|own| (own, network.confidences(&own.steps))).collect();
    Ok(edges::choose(&judged))
}

fn test(trained: &Trained, tests: &[Sequence]) -> Option<Test> {
    let judged: Vec<Judged> =
        tests.iter().map(|sequence| fit::judge(&trained.network, &Table::of([sequence]))).collect();
    (!tests.is_empty())
        .then(|| Test::of(&tests.iter().collect::<Vec<_>>(), &judged, trained.choice.threshold))
}

fn test_quantised(
    trained: &Trained,
    quantised: &Quantised,
    tests: &[Sequence],
) -> anyhow::Result<Option<Test>> {
    let mut judged = Vec::new();
    for sequence in tests {
        let logits = quantised.logits(sequence)?;
        let slips = sequence.slips[sequence.slips.len() - logits.len()..].to_vec();
        judged.push(Judged { logits, slips });
    }
    let tests: Vec<&Sequence> = tests.iter().collect();
    Ok((!tests.is_empty()).then(|| Test::of(&tests, &judged, trained.choice.threshold)))
}

/// Drawn to a terminal only.
fn bar() -> ProgressBar {
    let bar = ProgressBar::new(1_000);
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %, {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

fn write(folder: &Path, files: &[(&str, Vec<u8>)]) -> anyhow::Result<()> {
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    for (name, bytes) in files {
        let path = folder.join(name);
        fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
        eprintln!("  {:<14}{}", "written", path.display());
    }
    Ok(())
}
