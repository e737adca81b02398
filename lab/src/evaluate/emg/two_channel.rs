//! Short recordings of two muscles, one movement each, `emg_two_channel_[LETTER_]MOVEMENT[N].csv`. A session is calibrated from each choice
//! of one rest, one held movement that closes and one that opens, and scored on the others.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::Context;
use serde::Serialize;
use tenax_logic::emg::constants::Fitted;
use tenax_logic::emg::decide::{Decide, Wish};
use tenax_logic::emg::mains::mains_of;
use tenax_logic::emg::model::{EmgModel, Refusal};
use tenax_logic::emg::trust::Quality;
use tenax_logic::emg::{Emg, Verdict};
use tenax_sim::replay::Recipe;
use tenax_sim::replay::meaning::Motion;
use tenax_sim::replay::muscles::{Muscles, calibrate};

pub(super) const PREFIX: &str = "emg_two_channel_";
/// Window of a score, s.
const WINDOW_S: f64 = 0.25;
/// The delay of the front end's 4 Hz low-pass, s; the recordings begin within a contraction.
const FRONT_END_S: f64 = 0.056;

#[derive(Clone, Debug)]
pub struct Movement {
    pub name: String,
    wants: Wish,
    never: Vec<Wish>,
    muscles: Muscles,
}

#[derive(Clone, Debug)]
pub struct Session {
    /// Its letter; the first has none.
    pub name: String,
    pub movements: Vec<Movement>,
    pub calibrations: Vec<Calibrated>,
}

/// A choice of repetitions to calibrate from: rest, close, open.
#[derive(Clone, Debug)]
pub struct Calibrated {
    choice: [usize; 3],
    pub model: Result<EmgModel, Refusal>,
}

const fn wish(motion: Motion) -> Wish {
    match motion {
        Motion::Rest => Wish::Rest,
        Motion::Close => Wish::Close,
        Motion::Open => Wish::Open,
    }
}

impl Movement {
    fn read(path: &Path, name: &str) -> anyhow::Result<Self> {
        let recipe = Recipe::for_file(path)?.context("no recipe is for it")?.recipe;
        let file = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let meaning = recipe.meaning_of(file);
        Ok(Self {
            name: name.to_owned(),
            wants: meaning.map_or(Wish::Rest, |meaning| wish(meaning.wants)),
            never: meaning.map_or_else(Vec::new, |meaning| meaning.never.iter().copied().map(wish).collect()),
            muscles: Muscles::read(path, None, 1)?,
        })
    }

    fn is_held(&self) -> bool {
        !self.name.ends_with("dynamic")
    }

    fn is_scored(&self) -> bool {
        self.is_held() && self.wants != Wish::Rest
    }

    pub fn is_rest(&self) -> bool {
        self.wants == Wish::Rest && self.never.len() == 2
    }

    pub fn heard_with(&self, gains: [f64; 2]) -> Self {
        let mut heard = self.clone();
        for (_, pair) in &mut heard.muscles.pairs {
            for (uv, gain) in pair.iter_mut().zip(gains) {
                *uv = uv.map(|uv| (f64::from(uv) * gain) as i32);
            }
        }
        heard
    }

    pub fn play(&self, mut emg: Emg) -> Played<'_> {
        let mut doubts = Vec::new();
        let mut was = [Quality::Good; 2];
        let mut verdicts = Vec::with_capacity(self.muscles.pairs.len());
        for &(t_s, pair) in &self.muscles.pairs {
            verdicts.push((t_s, emg.take(pair)));
            for (channel, before) in was.iter_mut().enumerate() {
                if let Some(window) = emg.window(channel).copied() {
                    emg.hear(channel, mains_of(&window));
                }
                let quality = emg.quality(channel);
                if quality != *before {
                    *before = quality;
                    doubts.push((t_s, channel, quality));
                }
            }
        }
        Played { movement: self, verdicts, doubts }
    }

    /// Begins of its windows, s.
    fn windows(&self) -> impl Iterator<Item = f64> + Clone {
        let count = (self.muscles.duration_s / WINDOW_S + 0.01) as u32;
        (0..count).map(|n| FRONT_END_S + f64::from(n) * WINDOW_S)
    }
}

#[derive(Clone, Debug)]
pub struct Played<'a> {
    movement: &'a Movement,
    pub verdicts: Vec<(f64, Verdict)>,
    /// When a channel's quality became this.
    pub doubts: Vec<(f64, usize, Quality)>,
}

impl Played<'_> {
    /// The longest stretch of what must not be, ms.
    pub fn wrong_ms(&self) -> u32 {
        let longest_s = |&wish: &Wish| {
            let (mut longest_s, mut since) = (0.0f64, None);
            for &(t_s, verdict) in &self.verdicts {
                if verdict.wish == wish {
                    longest_s = longest_s.max(t_s - *since.get_or_insert(t_s) + 1.0 / 240.0);
                } else {
                    since = None;
                }
            }
            longest_s
        };
        (self.movement.never.iter().map(longest_s).fold(0.0, f64::max) * 1e3).round() as u32
    }

    pub fn windows(&self) -> Option<[u32; 2]> {
        let wants = self.movement.wants;
        let is_right = |from_s: &f64| {
            let own = self.verdicts.iter().filter(|(t_s, _)| (*from_s..from_s + WINDOW_S).contains(t_s));
            let (mut agreeing, mut all) = (0, 0);
            for (_, verdict) in own {
                all += 1;
                agreeing += u32::from(verdict.wish == wants);
            }
            2 * agreeing > all
        };
        self.movement.is_scored().then(|| {
            let windows = self.movement.windows();
            [windows.clone().filter(is_right).count() as u32, windows.count() as u32]
        })
    }
}

pub(super) fn sessions(files: &[PathBuf]) -> anyhow::Result<Vec<Session>> {
    let mut sessions: BTreeMap<String, Vec<Movement>> = BTreeMap::new();
    for path in files {
        let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        let Some(name) = stem.strip_prefix(PREFIX) else { continue };
        // Another session than the first has a letter.
        let (session, name) = match name.split_once('_') {
            Some((letter, rest)) if letter.len() == 1 => (letter, rest),
            _ => ("", name),
        };
        let movement = Movement::read(path, name).with_context(|| path.display().to_string())?;
        sessions.entry(session.to_owned()).or_default().push(movement);
    }
    Ok(sessions.into_iter().map(|(name, movements)| Session::new(name, movements)).collect())
}

#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Its letter; the first has none.
    pub session: String,
    /// Choices of repetitions to calibrate from, and those of them that were refused.
    pub calibrations: usize,
    pub refused: usize,
    /// Windows of 0.25 s of held movements, not calibrated from, that move the hand the right way, over all calibrations.
    pub right: f64,
    pub worst_right: f64,
    /// The longest motion that must not be, ms, over all calibrations, by movement.
    pub wrong_ms: BTreeMap<String, u32>,
    /// Doubts of a sensor: each of these is a muscle.
    pub doubts: usize,
}

impl Session {
    fn new(name: String, movements: Vec<Movement>) -> Self {
        let mut session = Self { name, movements, calibrations: Vec::new() };
        let held = |is_one: fn(&Movement) -> bool| -> Vec<usize> {
            let movements = session.movements.iter().enumerate();
            movements.filter(|(_, own)| own.is_held() && is_one(own)).map(|(n, _)| n).collect()
        };
        let (closes, opens) = (held(|own| own.wants == Wish::Close), held(|own| own.wants == Wish::Open));
        let mut calibrations = Vec::new();
        for rest in held(Movement::is_rest) {
            for &close in &closes {
                for &open in &opens {
                    let choice = [rest, close, open];
                    let model = calibrate(choice.map(|n| &session.movements[n].muscles));
                    calibrations.push(Calibrated { choice, model });
                }
            }
        }
        session.calibrations = calibrations;
        session
    }

    fn others(&self, choice: [usize; 3]) -> impl Iterator<Item = &Movement> {
        let movements = self.movements.iter().enumerate();
        movements.filter(move |(n, _)| !choice.contains(n)).map(|(_, movement)| movement)
    }

    /// Scores every calibration on what it was not taken from.
    pub fn score(&self, fitted: &'static Fitted) -> Report {
        let mut report = Report {
            session: self.name.clone(),
            calibrations: self.calibrations.len(),
            refused: 0,
            right: 0.0,
            worst_right: 1.0,
            wrong_ms: BTreeMap::new(),
            doubts: 0,
        };
        let (mut right, mut all) = (0, 0);
        for calibrated in &self.calibrations {
            let Ok(model) = &calibrated.model else {
                report.refused += 1;
                continue;
            };
            let (mut own_right, mut own_all) = (0, 0);
            for movement in self.others(calibrated.choice) {
                let played = movement.play(Emg::of(Decide::with(fitted, Some(model))));
                report.doubts += played.doubts.len();
                if !movement.never.is_empty() {
                    let longest = report.wrong_ms.entry(movement.name.clone()).or_default();
                    *longest = played.wrong_ms().max(*longest);
                }
                if let Some([windows, of]) = played.windows() {
                    (own_right, own_all) = (own_right + windows, own_all + of);
                }
            }
            report.worst_right = report.worst_right.min(f64::from(own_right) / f64::from(own_all.max(1)));
            (right, all) = (right + own_right, all + own_all);
        }
        report.right = f64::from(right) / f64::from(all.max(1));
        report
    }
}
