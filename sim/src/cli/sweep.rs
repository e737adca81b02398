//! `tenax sweep`: many scenes with many seeds, on one machine or many.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::drawn;
use crate::sweep::{self, Seeds, Shard};
use tenax_frames::tool::folder;
use tenax_frames::tool::format::Format;
use tenax_frames::tool::out;
use tenax_frames::tool::progress::with_bar;
use tenax_scene::drawn::{Family, nth};

const EXAMPLES: &str = "\
Examples:
  tenax sweep --seeds 1..5                 every scene with five seeds on all cores, then the summary
  tenax sweep --seeds 1..5 --scenes glass,my.toml
  tenax sweep --seeds 1..5 --shard 3/16 --out DIR
                                           the third of sixteen shards; a second start continues it
  tenax sweep --seeds 1..5 --shard $SLURM_ARRAY_TASK_ID/16 --out DIR
                                           as a job of an array; in Kubernetes
                                           $((JOB_COMPLETION_INDEX + 1))/16
  tenax sweep merge DIR                    runs.jsonl, summary.json and the summary of all shards:
                                           the same bytes, however many there were
  tenax sweep --drawn 200 --seed 7         worlds that nobody chose, beside a causal oracle, by family
  tenax sweep --family splash --seed 7 --print 3
                                           one of them as a scene file";

/// Run scenes with many seeds on the host's build of the logic: bound, force and fate of each.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
pub struct Args {
    #[command(subcommand)]
    what: Option<What>,
    /// Scenes by name or file, or all of `tenax run --list`
    #[arg(long, value_name = "all|NAME|FILE.toml,...", value_delimiter = ',', default_value = "all")]
    scenes: Vec<String>,
    /// Seeds of every noise: one, several, or the first and the last
    #[arg(long, value_name = "N|FIRST..LAST,...", value_delimiter = ',', default_value = "1..5")]
    seeds: Vec<Seeds>,
    /// Run only this shard, such as 3/16, without a merge [default: all shards, then a merge]
    #[arg(long, value_name = "N/OF")]
    shard: Option<Shard>,
    /// Run so many drawn worlds instead, all families in turn
    #[arg(long, value_name = "N", conflicts_with_all = ["scenes", "seeds", "shard", "out"])]
    drawn: Option<u32>,
    /// What drawn worlds are drawn from: 1 to 999 are for choosing, others for scoring
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Only drawn worlds of this family
    #[arg(long, value_name = "NAME")]
    family: Option<Family>,
    /// Print this drawn world as a scene file instead, from 0
    #[arg(long, value_name = "K", conflicts_with = "drawn")]
    print: Option<u32>,
    /// Folder with one file a run; existing runs are not repeated
    #[arg(long, value_name = "DIR", default_value = "out/sweep")]
    out: PathBuf,
    /// How to print the summary
    #[arg(long, value_enum, default_value_t = Format::Text, global = true)]
    report: Format,
}

#[derive(Debug, clap::Subcommand)]
enum What {
    /// Merge shards into the first of these folders
    Merge {
        #[arg(value_name = "DIR", required = true)]
        folders: Vec<PathBuf>,
    },
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    if let Some(n) = args.print {
        out::unless_closed(out::print(format_args!("{}", nth(args.family, args.seed, n).text)))?;
        return Ok(ExitCode::SUCCESS);
    }
    if let Some(count) = args.drawn {
        let scores = with_bar("worlds", |told| drawn::scores(args.family, args.seed, count, told))?;
        out::unless_closed(args.report.show(&drawn::Report::new(args.seed, &scores)?))?;
        return Ok(ExitCode::SUCCESS);
    }
    let summary = if let Some(What::Merge { folders }) = &args.what {
        sweep::merge(folders)?
    } else {
        let folder = folder::made(&args.out)?;
        let seeds: Vec<u64> = args.seeds.iter().flat_map(|seeds| seeds.0.iter().copied()).collect();
        let ran = with_bar("sweep", |told| sweep::run(&args.scenes, &seeds, args.shard, &folder, told))?;
        out::note!("  {ran} runs done now");
        if args.shard.is_some() {
            return Ok(ExitCode::SUCCESS);
        }
        sweep::merge(&[folder])?
    };
    out::unless_closed(args.report.show(&summary))?;
    Ok(ExitCode::SUCCESS)
}
