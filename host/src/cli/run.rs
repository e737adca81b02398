//! `tenax run`: a scene or a recording on a board; report and figure.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Context;

use super::format::Format;
use super::progress::Progress;
use super::workspace;
use crate::plot::{draw, png};
use crate::replay::Recording;
use crate::report::text::Text;
use crate::session::{self, Board, Outcome};

/// Run a scene or a recording on a board; report and draw it.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Run the host's own build of the logic: no image, no emulator
    #[arg(long)]
    host: bool,
    /// A scene file, or the name of one that `tenax scenes` lists
    #[arg(long, value_name = "FILE.toml|NAME", default_value = session::DEFAULT_SCENE, conflicts_with = "replay")]
    scene: String,
    /// Play a recording (CSV) instead of a scene
    #[arg(long, value_name = "RECORDING.csv")]
    replay: Option<PathBuf>,
    /// How the recording's columns reach the pins: a recipe file, or the name of one in recipes/ [default: by its name]
    #[arg(long, value_name = "FILE.toml|NAME", requires = "replay")]
    recipe: Option<String>,
    /// Seed of every noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How to print the report
    #[arg(long, value_enum, default_value_t = Format::Text)]
    report: Format,
    /// Where the figure, the report and the serial line's bytes are written
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
}

pub fn main(args: &Args) -> anyhow::Result<ExitCode> {
    let board = if args.host { Board::Host } else { Board::emulated(&workspace::root()?)? };
    let outcome = match &args.replay {
        Some(path) => {
            let recording = Recording::read(path)?;
            let mut progress = Progress::new("replay", recording.duration_s());
            session::replay(path, args.recipe.as_deref(), args.seed, &board, &mut |s| progress.at(s))?
        }
        None => {
            let file = session::load_scene(&args.scene)?;
            let mut progress = Progress::new(&file.name, file.duration_s());
            session::scene(&file, args.seed, &board, &mut |s| progress.at(s))?
        }
    };
    let files = write(&args.out, &outcome)?;
    args.report.print(&Text(&outcome.report), &outcome.report)?;
    // On stderr, so that a program that reads the report reads nothing else.
    for file in files {
        eprintln!("  {:<14}{}", "written", file.display());
    }
    Ok(ExitCode::SUCCESS)
}

/// Writes everything that a run leaves, and says where.
fn write(folder: &Path, outcome: &Outcome) -> anyhow::Result<Vec<PathBuf>> {
    let cannot = |path: &Path| format!("cannot write {}", path.display());
    fs::create_dir_all(folder).with_context(|| cannot(folder))?;
    let svg = draw::svg(&outcome.figure)?;
    let stem =
        Path::new(&outcome.report.scene).file_stem().map_or("run".into(), |stem| stem.to_string_lossy());
    let mut contents = vec![
        ("png", png::png(&svg)?),
        ("svg", svg.into_bytes()),
        ("json", serde_json::to_vec_pretty(&outcome.report)?),
    ];
    if !outcome.run.line.is_empty() {
        contents.push(("line.bin", outcome.run.line.clone()));
    }
    let mut files = Vec::new();
    for (extension, bytes) in contents {
        let path = folder.join(format!("{stem}.{extension}"));
        fs::write(&path, bytes).with_context(|| cannot(&path))?;
        files.push(path);
    }
    Ok(files)
}
