//! One run: from what is to be run, on which board, to its report and its figure.

pub mod controls;
mod witness;

use std::borrow::Cow;
use std::path::Path;
#[cfg(feature = "emulator")]
use std::path::PathBuf;
use std::sync::atomic::Ordering::Relaxed;
use std::time::Instant;

use anyhow::{Context, bail, ensure};
use tenax_frames::link::{Captured, Clock};
use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::wire::Up;
use tenax_logic::emg::model::EmgModel;
use tenax_scene::plant::Plant;
use tenax_scene::{SceneFile, World, builtin};

use self::witness::{Drawn, Witness};
#[cfg(feature = "emulator")]
use crate::board::emulated;
use crate::board::kept::model_of;
use crate::board::simulated::{Grips, frames_in, seconds_of};
use crate::board::{Recorder, Run, Summary, simulated};
use crate::input;
use crate::plot::sheet::Sheet;

use crate::figure::figure;
use crate::live::{Served, Use};
use crate::replay::{ReplayPlant, library};
use crate::report::fate::Fate;
use crate::report::replay::Replay;
use crate::report::{Report, Subject};
use crate::timeline::Timeline;

pub const DEFAULT_SCENE: &str = "glass";
const STOPPED: &str = "stopped before its end: there is no report";

#[derive(Clone, Debug)]
pub enum Board {
    Host,
    #[cfg(feature = "emulator")]
    Emulated {
        image: PathBuf,
        options: emulated::Options,
    },
}

impl Board {
    /// The emulated board with the image of the workspace at `root`, built if it is not yet.
    #[cfg(feature = "emulator")]
    pub fn emulated(root: &Path) -> anyhow::Result<Self> {
        Ok(Self::Emulated { image: crate::image::build(root)?, options: emulated::Options::default() })
    }

    #[cfg(not(feature = "emulator"))]
    pub fn emulated(_root: &Path) -> anyhow::Result<Self> {
        bail!(
            "this `tenax` was built without the emulator: use `cargo tenax ...` in a checkout, or add --host"
        )
    }

    pub const fn name(&self) -> &'static str {
        match self {
            Self::Host => "host",
            #[cfg(feature = "emulator")]
            Self::Emulated { .. } => "emulated",
        }
    }

    /// Connects a plant, runs it to its end and keeps everything. `progress` hears of the virtual time that has gone by, s.
    pub fn run<P: Plant + 'static>(
        &self,
        plant: P,
        progress: &mut dyn FnMut(f64),
    ) -> anyhow::Result<(Run, P)> {
        let mut run = Run::default();
        let (summary, plant) = self.record(plant, &mut run, progress)?;
        run.summary = summary;
        Ok((run, plant))
    }

    /// Connects a plant and runs it to its end; `recorder` is told of the run as it goes.
    pub fn record<P: Plant + 'static>(
        &self,
        plant: P,
        recorder: &mut dyn Recorder,
        progress: &mut dyn FnMut(f64),
    ) -> anyhow::Result<(Summary, P)> {
        match self {
            Self::Host => {
                let began = Instant::now();
                let (mut summary, plant) =
                    simulated::record(plant, Grips::Reflex(DetectorSet::ALL), recorder, progress);
                summary.wall_s = began.elapsed().as_secs_f64();
                Ok((summary, plant))
            }
            #[cfg(feature = "emulator")]
            Self::Emulated { image, options } => emulated::record(image, plant, options, recorder, progress),
        }
    }
}

#[derive(Clone, Debug)]
pub struct Outcome {
    pub run: Summary,
    pub report: Report,
    pub figure: Sheet,
    pub truth: Fate,
}

pub fn load_scene(asked: &str) -> anyhow::Result<SceneFile> {
    if let Some((name, text)) = builtin().iter().chain(builtin::parts()).find(|(name, _)| *name == asked) {
        return Ok(SceneFile::parse(text, &format!("scenes/{name}.toml"))?);
    }
    let path = Path::new(asked);
    if !path.exists() {
        let names: Vec<&str> = builtin().iter().map(|(name, _)| *name).collect();
        bail!("no scene is called {asked}, and there is no such file; the scenes are {}", names.join(", "));
    }
    let text = input::text(path).with_context(|| format!("cannot read {asked}"))?;
    // What a scene stands on is one of the program's or lies beside it.
    let beside = |name: &str| {
        let file = path.with_file_name(format!("{name}.toml"));
        Some((file.display().to_string(), Cow::Owned(input::text(&file).ok()?)))
    };
    Ok(SceneFile::parse_upon(&text, asked, &|name| builtin::find(name).or_else(|| beside(name)))?)
}

pub fn scene(
    file: &SceneFile,
    seed: u64,
    board: &Board,
    progress: &mut dyn FnMut(f64),
) -> anyhow::Result<Outcome> {
    scene_served(file, seed, board, Use::default(), &mut (), progress)
}

/// As [`scene`], with the board's line used so. `progress` hears of an infinite time while the bound is searched.
pub fn scene_served(
    file: &SceneFile,
    seed: u64,
    board: &Board,
    line: Use,
    recorder: &mut dyn Recorder,
    progress: &mut dyn FnMut(f64),
) -> anyhow::Result<Outcome> {
    let span_s = (0.0, seconds_of(frames_in(file.duration_s())));
    let world = World::new(file, seed);
    let calibrated = world.calibrated().as_ref().map(model_of).transpose()?;
    let plant = line.of(Drawn::new(world, span_s));
    let mut witness = Witness::new(0.0, span_s, calibrated.as_ref());
    witness.judge.deaf = file.lifts().collect();
    let (run, Served { mut plant, line }) = board.record(plant, &mut (&mut witness, recorder), progress)?;
    ensure!(!line.stop.load(Relaxed), STOPPED);
    plant.draw();
    let truth = Fate { grips: std::mem::take(&mut plant.grips), ..Fate::of(plant.world.truth(), file) };
    progress(f64::INFINITY);
    let bound = (!line.without_bound).then(|| controls::bound(file, seed, &truth));
    witness.sketch.needs = Some(plant.needs);
    let (report, mut figure, _) =
        told(&file.name, board.name(), seed, &run, witness, [Some(&truth), bound.as_ref()]);
    figure.subtitle = format!("{}; {}", file.title, figure.subtitle);
    Ok(Outcome { run, report, figure, truth })
}

pub fn replay(
    path: &Path,
    recipe: Option<&str>,
    seed: u64,
    board: &Board,
    progress: &mut dyn FnMut(f64),
) -> anyhow::Result<Outcome> {
    replay_served(path, (recipe, None), Use::default(), seed, board, &mut (), progress)
}

/// Plays a recording by a recipe, its name or file, or by the one that the recording's name calls for; of a wearer whose calibration
/// this is.
pub fn replay_served(
    path: &Path,
    (recipe, calibrated): (Option<&str>, Option<EmgModel>),
    line: Use,
    seed: u64,
    board: &Board,
    recorder: &mut dyn Recorder,
    progress: &mut dyn FnMut(f64),
) -> anyhow::Result<Outcome> {
    let (recording, named) = library::read(path, recipe)?;
    let mut plant = ReplayPlant::of(&recording, named.as_ref(), seed)?;
    plant.calibrated = calibrated;
    let (zero_s, end_s) = (plant.time_zero_s(), plant.time_zero_s() + plant.duration_s());
    // Of the rows held before and after, as much as shows where the recording begins and ends.
    let margin_s = (0.05 * recording.duration_s()).max(0.02);
    let last_s = recording.first_s() + recording.duration_s();
    let span_s = (zero_s.max(recording.first_s() - margin_s), end_s.min(last_s + margin_s));
    let mut witness = Witness::new(zero_s, span_s, calibrated.as_ref());
    let (run, served) = board.record(line.of(plant), &mut (&mut witness, recorder), progress)?;
    ensure!(!served.line.stop.load(Relaxed), STOPPED);
    let scene = name_of(path);
    let (mut report, mut figure, timeline) = told(&scene, board.name(), seed, &run, witness, [None; 2]);
    let lead_in_s = recording.first_s() - zero_s;
    report.replay = Some(Replay::new(&recording, named.as_ref(), lead_in_s, &timeline, &report.wearer)?);
    if let Some(named) = &named {
        figure.subtitle = format!("{} ({}), {}", named.recipe.title, named.name, figure.subtitle);
    }
    Ok(Outcome { run, report, figure, truth: Fate::default() })
}

/// The report of a recording, in the file's time.
pub fn recorded(name: &str, captured: &Captured) -> anyhow::Result<Outcome> {
    let mut clock = Clock::default();
    let mut messages = Vec::new();
    for (_, came_ns, frame) in captured.frames() {
        let Ok(heard) = frame else { continue };
        let message = heard.received.message;
        clock.hear(&message, came_ns);
        let at = match &message {
            Up::Slow(slow) => clock.at(slow.frame),
            Up::Event(event) => clock.at(event.frame),
            _ => continue,
        };
        messages.push((at, message));
    }
    let mut slows = messages.iter().filter(|(_, message)| matches!(message, Up::Slow(_))).map(|(at, _)| *at);
    let Some(first) = slows.next() else { bail!("{name} has no slow frame: it is no board's line") };
    let last = slows.next_back().unwrap_or(first);
    // A figure's frames have 32 bits.
    let zero = if last >= i64::from(u32::MAX) { first } else { 0 };
    let in_figure = |at: i64| (at - zero).max(0) as u32;
    let span_s = (seconds_of(in_figure(first)), seconds_of(in_figure(last) + 1));
    let mut run = Summary { virtual_s: span_s.1 - span_s.0, ..Summary::default() };
    let mut witness = Witness::new(0.0, span_s, None);
    for (at, mut message) in messages {
        match &mut message {
            Up::Slow(slow) => slow.frame = in_figure(at),
            Up::Event(event) => event.frame = in_figure(at),
            _ => {}
        }
        run.take(message, &mut witness);
    }
    let (report, figure, _) = told(name, "recorded", 0, &run, witness, [None; 2]);
    Ok(Outcome { run, report, figure, truth: Fate::default() })
}

fn told(
    scene: &str,
    board: &'static str,
    seed: u64,
    run: &Summary,
    witness: Witness,
    [truth, bound]: [Option<&Fate>; 2],
) -> (Report, Sheet, Timeline) {
    let Witness { timeline, judge, added, sketch } = witness;
    let subject =
        Subject { scene, board, seed, run, timeline: &timeline, judge: &judge, added: &added, truth, bound };
    (Report::new(&subject), figure(&subject, sketch), timeline)
}

pub fn name_of(recording: &Path) -> String {
    recording
        .file_name()
        .map_or_else(|| recording.display().to_string(), |name| name.to_string_lossy().into_owned())
}
