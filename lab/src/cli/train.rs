//! `tenax train`: learns the force array's detector, in a package of its own that nothing else compiles; and fits the wearer's model.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::{Context, bail};

use tenax_frames::tool::folder;
use tenax_frames::tool::out;
use super::people::People;
use tenax_frames::tool::progress::with_bar;
use tenax_frames::tool::workspace;
use tenax_sim::labelled::{self, library};
use crate::evaluate::fit;

const EXAMPLES: &str = "\
Examples:
  tenax train                                     from the data set of `tenax dataset`, which is made if it is not there
  tenax train --dataset mine.csv --recipe r.toml  from recordings of your own; docs/training.md says how to write a recipe
  tenax train --dataset basic.csv --recipe biotac --test solids.csv
  tenax train emg --recordings FOLDER             the constants of intent recognition, leaving out each person once";

/// Where `tenax dataset` writes if nothing else is said.
const DATASET: &str = "out/array_dataset.csv";

/// Train the force array's slip detector from labelled recordings.
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
    /// Further recordings (same recipe), used for scoring only; may be given more than once
    #[arg(long, value_name = "FILE.csv")]
    test: Vec<PathBuf>,
    /// Where the network (Rust), its model card and the report are written
    #[arg(long, value_name = "DIR", default_value = "out/train")]
    out: PathBuf,
    /// Seed of the initial weights and of the training order
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How to print the report: text or json
    #[arg(long, default_value = "text", value_parser = ["text", "json"])]
    report: String,
    /// Also score on the test part of the data: once, for a network to be shipped
    #[arg(long)]
    open_test: bool,
    /// Train on the paper's 76 features only, as a control
    #[arg(long)]
    paper_only: bool,
    /// Copy network and card to logic/src/array/shipped.rs and docs/
    #[arg(long)]
    ship: bool,
}

/// What is fitted instead of the force array's network.
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

fn emg(args: &EmgArgs) -> anyhow::Result<ExitCode> {
    let People { recordings, seed, report: format } = &args.people;
    let report = with_bar("fitting", |part| fit::fit(recordings, args.rounds, *seed, part))?;
    out::unless_closed(format.show(&report))?;
    if args.ship {
        let to = workspace::root()?.join("logic/src/emg/fitted.rs");
        std::fs::write(&to, &report.file).with_context(|| format!("cannot write {}", to.display()))?;
        workspace::run(Command::new("rustfmt").args(["--edition", "2024"]).arg(&to))?;
        out::note!("  {:<14}{}", "shipped", to.display());
    }
    Ok(ExitCode::SUCCESS)
}

/// What `--ship` puts where.
const SHIPPED: [(&str, &str); 2] =
    [("network.rs", "logic/src/array/shipped.rs"), ("model-card.md", "docs/model-card.md")];

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    if let Some(What::Emg(args)) = &args.what {
        return emg(args);
    }
    folder::made(&args.out)?;
    let dataset = match &args.dataset {
        Some(file) => file.clone(),
        None => built_in()?,
    };
    let files = || std::iter::once(&dataset).chain(&args.test);
    with_bar("reading", |_| files().try_for_each(|file| readable(file, &dataset, args.recipe.as_deref())))?;
    let mut command = Command::new("cargo");
    command.args(["run", "--release", "--ignore-rust-version", "--package", "tenax-train"]);
    if !std::io::stderr().is_terminal() {
        command.arg("--quiet");
    }
    command.arg("--manifest-path").arg(workspace::root()?.join("Cargo.toml")).arg("--");
    command.arg("--dataset").arg(dataset);
    if let Some(recipe) = &args.recipe {
        command.args(["--recipe", recipe]);
    }
    for file in &args.test {
        command.arg("--test").arg(file);
    }
    command.arg("--out").arg(&args.out).args(["--seed", &args.seed.to_string(), "--report", &args.report]);
    for (is_set, flag) in [(args.open_test, "--open-test"), (args.paper_only, "--paper-only")] {
        if is_set {
            command.arg(flag);
        }
    }
    // The matrices are small: a second thread costs more than it saves, and with one nothing depends on who was first.
    command.env("RAYON_NUM_THREADS", "1");
    out::note!("the first time, the training package is compiled: a few minutes");
    let status = command.status()?;
    if status.success() && args.ship {
        ship(args)?;
    }
    // It has said what is wrong.
    Ok(status.code().and_then(|code| u8::try_from(code).ok()).map_or(ExitCode::from(2), ExitCode::from))
}

/// Reads a file as the training will, so that a mistake in it is said before anything is compiled or learned.
fn readable(file: &Path, dataset: &Path, recipe: Option<&str>) -> anyhow::Result<()> {
    // Files to score on have the recipe of those to learn from.
    labelled::read(file, &library::choose(dataset, recipe)?)?;
    Ok(())
}

fn ship(args: &Args) -> anyhow::Result<()> {
    for (name, to) in SHIPPED {
        let to = workspace::root()?.join(to);
        std::fs::copy(args.out.join(name), &to).with_context(|| format!("cannot write {}", to.display()))?;
        out::note!("  {:<14}{}", "shipped", to.display());
        if to.extension().is_some_and(|extension| extension == "rs") {
            workspace::run(Command::new("rustfmt").args(["--edition", "2024"]).arg(&to))?;
        }
    }
    Ok(())
}

/// The built-in data set, made if it is not there.
fn built_in() -> anyhow::Result<PathBuf> {
    let file = PathBuf::from(DATASET);
    if !file.exists() {
        out::note!("no {DATASET} yet: making it");
        let made = Command::new(std::env::current_exe()?).args(["dataset", "--out", DATASET]).status()?;
        if !made.success() {
            bail!("`tenax dataset` failed; its message is above");
        }
    }
    Ok(file)
}
