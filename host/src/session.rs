//! One run: from what is to be run, on which board, to its report and its figure.

use std::path::Path;
#[cfg(feature = "emulator")]
use std::path::PathBuf;

use anyhow::{Context, bail};
use tenax_scene::plant::Plant;
use tenax_scene::{SceneFile, World, builtin};

#[cfg(feature = "emulator")]
use crate::board::emulated;
use crate::board::{Run, simulated};
use crate::plot::{Figure, panels};
use crate::replay::{Recording, ReplayPlant, library};
use crate::report::fate::Fate;
use crate::report::replay::Replay;
use crate::report::{Report, Subject};
use crate::timeline::Timeline;

/// The scene that is run when none is asked for.
pub const DEFAULT_SCENE: &str = "glass";

/// Who runs the logic.
#[derive(Clone, Debug)]
pub enum Board {
    /// The host's own build of it.
    Host,
    /// The real image, instruction by instruction.
    #[cfg(feature = "emulator")]
    Emulated {
        /// Its ELF file.
        image: PathBuf,
        /// How to run it.
        options: emulated::Options,
    },
}

impl Board {
    /// The emulated board with the image of the workspace at `root`, built if it is not yet.
    #[cfg(feature = "emulator")]
    pub fn emulated(root: &Path) -> anyhow::Result<Self> {
        Ok(Self::Emulated { image: crate::image::build(root)?, options: emulated::Options::default() })
    }

    /// Says how to get an emulated board.
    #[cfg(not(feature = "emulator"))]
    pub fn emulated(_root: &Path) -> anyhow::Result<Self> {
        bail!(
            "this `tenax` was built without the emulator: use `cargo tenax ...` in a checkout, or add --host"
        )
    }

    /// What it is called in reports.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Host => "host",
            #[cfg(feature = "emulator")]
            Self::Emulated { .. } => "emulated",
        }
    }

    /// Connects a plant and runs it to its end. `progress` hears of the virtual time that has gone by, s.
    pub fn run<P: Plant + 'static>(
        &self,
        plant: P,
        progress: &mut dyn FnMut(f64),
    ) -> anyhow::Result<(Run, P)> {
        match self {
            Self::Host => Ok(simulated::run(plant, progress)),
            #[cfg(feature = "emulator")]
            Self::Emulated { image, options } => emulated::run(image, plant, options, progress),
        }
    }
}

/// What a run leaves.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What the board left behind.
    pub run: Run,
    /// The report.
    pub report: Report,
    /// The figure.
    pub figure: Figure,
}

/// A scene by its name in the repository, or by its file.
pub fn load_scene(asked: &str) -> anyhow::Result<SceneFile> {
    if let Some((name, text)) = builtin().iter().find(|(name, _)| *name == asked) {
        return Ok(SceneFile::parse(text, &format!("scenes/{name}.toml"))?);
    }
    let path = Path::new(asked);
    if !path.exists() {
        let names: Vec<&str> = builtin().iter().map(|(name, _)| *name).collect();
        bail!("no scene is called {asked}, and there is no such file; the scenes are {}", names.join(", "));
    }
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {asked}"))?;
    Ok(SceneFile::parse(&text, asked)?)
}

/// Runs a scene, and its oracle beside it.
pub fn scene(
    file: &SceneFile,
    seed: u64,
    board: &Board,
    progress: &mut dyn FnMut(f64),
) -> anyhow::Result<Outcome> {
    let (run, world) = board.run(World::new(file, seed), progress)?;
    // The oracle's is always the host's: it is a bound on the gripper, not on the image.
    let (_, oracle) = simulated::run_oracle(World::new(file, seed), &mut |_| {});
    let (truth, oracle) = (Fate::of(world.truth()), Fate::of(oracle.truth()));
    let subject = Subject {
        scene: &file.name,
        board: board.name(),
        seed,
        run: &run,
        zero_s: 0.0,
        truth: Some(&truth),
        oracle: Some(&oracle),
    };
    let report = Report::new(&subject);
    let mut figure = panels::figure(&subject, (0.0, run.virtual_s));
    figure.subtitle = format!("{}; {}", file.title, figure.subtitle);
    Ok(Outcome { run, report, figure })
}

/// Plays a recording. Without a recipe, the one that its name calls for.
pub fn replay(
    path: &Path,
    recipe: Option<&str>,
    seed: u64,
    board: &Board,
    progress: &mut dyn FnMut(f64),
) -> anyhow::Result<Outcome> {
    let recording = Recording::read(path)?;
    let named = library::choose(&recording, path, recipe)?;
    let plant = match &named {
        Some(named) => ReplayPlant::new(&recording, &named.recipe, seed)
            .with_context(|| format!("recipe {}", named.name))?,
        None => ReplayPlant::plain(&recording, seed)?,
    };
    let (zero_s, end_s) = (plant.time_zero_s(), plant.time_zero_s() + plant.duration_s());
    let (run, _) = board.run(plant, progress)?;
    let scene = path
        .file_name()
        .map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
    let subject =
        Subject { scene: &scene, board: board.name(), seed, run: &run, zero_s, truth: None, oracle: None };
    let mut report = Report::new(&subject);
    let lead_in_s = recording.first_s() - zero_s;
    let timeline = Timeline::new(&run, zero_s);
    report.replay = Some(Replay::new(&recording, named.as_ref(), lead_in_s, timeline, &report.wearer)?);
    // Of the rows held before and after, as much as shows where the recording begins and ends.
    let margin_s = (0.05 * recording.duration_s()).max(0.02);
    let last_s = recording.first_s() + recording.duration_s();
    let span_s = (zero_s.max(recording.first_s() - margin_s), end_s.min(last_s + margin_s));
    let mut figure = panels::figure(&subject, span_s);
    if let Some(named) = &named {
        figure.subtitle = format!("{} ({}), {}", named.recipe.title, named.name, figure.subtitle);
    }
    Ok(Outcome { run, report, figure })
}
