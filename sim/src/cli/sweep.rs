//! `tenax sweep`: many scenes with many seeds, or worlds that are drawn.

use std::process::ExitCode;

use crate::drawn;
use crate::sweep::{Seeds, Summary};
use tenax_frames::tool::format::Format;
use tenax_frames::tool::out;
use tenax_frames::tool::progress::with_bar;
use tenax_scene::drawn::{Family, nth};

const EXAMPLES: &str = "\
Examples:
  tenax sweep --seeds 1..5                 every scene with five seeds on all cores, then the summary
  tenax sweep --seeds 1..5 --scenes glass,my.toml
  tenax sweep --drawn 200 --seed 7         worlds that nobody chose, beside a causal oracle, by family
  tenax sweep --family splash --seed 7 --print 3
                                           one of them as a scene file";

/// Run scenes with many seeds on the host's build of the logic: bound, force and fate of each.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Scenes by name or file, or all of `tenax run --list`
    #[arg(long, value_name = "all|NAME|FILE.toml,...", value_delimiter = ',', default_value = "all")]
    scenes: Vec<String>,
    /// Seeds of every noise: one, several, or the first and the last
    #[arg(long, value_name = "N|FIRST..LAST,...", value_delimiter = ',', default_value = "1..5")]
    seeds: Vec<Seeds>,
    /// Run so many drawn worlds instead, all families in turn
    #[arg(long, value_name = "N", conflicts_with_all = ["scenes", "seeds"])]
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
    /// How to print the summary
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let shown = if let Some(n) = args.print {
        out::print(format_args!("{}", nth(args.family, args.seed, n).text))
    } else if let Some(count) = args.drawn {
        let scores = with_bar("worlds", |told| drawn::scores(args.family, args.seed, count, told))?;
        args.report.show(&drawn::Report::new(args.seed, &scores)?)
    } else {
        let seeds: Vec<u64> = args.seeds.iter().flat_map(|seeds| seeds.0.iter().copied()).collect();
        args.report.show(&with_bar("sweep", |told| Summary::run(&args.scenes, &seeds, told))?)
    };
    out::unless_closed(shown)?;
    Ok(ExitCode::SUCCESS)
}
