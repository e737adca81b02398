//! `tenax evaluate`: the force array's network, scored; and intent recognition on people.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::bail;
use rayon::prelude::*;
use tenax_frames::tool::{format::Format, out, progress::with_bar};
use tenax_sim::array::network::Network;
use tenax_sim::array::{adapt, readings};
use tenax_sim::labelled::{self, Part, Recording, library};

use super::People;
use crate::dataset::{Dataset, Plan, session::Sizes};
use crate::evaluate::{emg, report::Report, test_split};

const EXAMPLES: &str = "\
Examples:
  tenax evaluate                                   the shipped network on the test split of the built-in data set
  tenax evaluate --report json                     for programs
  tenax evaluate --dataset my.csv --recipe my.toml --network out/train
                                                   the network that `python -m tenax.train` has made of one's own
  tenax evaluate emg --recordings FOLDER           intent recognition on EMG envelopes of people";

/// Score the array's network on held-out data
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
    /// The network in this folder of `python -m tenax.train` instead of the one that ships
    #[arg(long, value_name = "DIR")]
    network: Option<PathBuf>,
    /// Seed of the built-in data set
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Size of the built-in data set: training sessions of each material; validation and test are in proportion
    #[arg(long, value_name = "N", default_value_t = Sizes::DEFAULT_TRAIN, conflicts_with = "dataset")]
    sessions: usize,
    /// Part of the built-in data set. Choose by validation; keep test for final scores
    #[arg(long, value_name = "train|validation|test", default_value = "test", conflicts_with = "dataset")]
    part: Part,
    /// How to print the scores
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
}

#[derive(Debug, clap::Subcommand)]
enum What {
    /// Score intent recognition on recorded EMG envelopes of two muscles
    Emg(EmgArgs),
}

#[derive(Debug, clap::Args)]
struct EmgArgs {
    #[command(flatten)]
    people: People,
    /// Only these people, by number
    #[arg(long, value_name = "P,P", value_delimiter = ',')]
    persons: Vec<u32>,
    /// Also score this many random electrode faults over people at rest
    #[arg(long, value_name = "N", default_value_t = 0)]
    faults: u32,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let shown = if let Some(What::Emg(EmgArgs { people, persons, faults })) = &args.what {
        people.report.show(&emg::evaluate(&people.recordings, persons, *faults, people.seed)?)
    } else {
        args.report.show(&network(args)?)
    };
    out::unless_closed(shown)?;
    Ok(ExitCode::SUCCESS)
}

fn network(args: &Args) -> anyhow::Result<Report> {
    let recordings = recordings(args)?;
    if recordings.is_empty() {
        bail!("the data has no recording that is called test");
    }
    let network = args.network.as_deref().map_or_else(|| Ok(Network::shipped()), Network::read)?;
    if args.dataset.is_some() {
        adapt::accept(&network, &recordings)?;
    }
    let judge = |recording: &Recording| network.judge(&readings(&recording.steps));
    let (logits, said): (Vec<_>, Vec<_>) = recordings.par_iter().map(judge).unzip();
    Ok(Report::new(&recordings, &said, &logits))
}

fn recordings(args: &Args) -> anyhow::Result<Vec<Recording>> {
    if let Some(path) = &args.dataset {
        let recipe = library::choose(path, args.recipe.as_deref())?;
        return Ok(test_split(labelled::read(path, &recipe)?));
    }
    if args.sessions == 0 {
        bail!("--sessions must be at least 1");
    }
    let plan = Plan { seed: args.seed, sessions: args.sessions };
    with_bar("sessions", |progress| Dataset::make(plan, Some(args.part), progress))?.recordings()
}
