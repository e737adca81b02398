//! Fits the constants of the wearer's model to recordings of people, and says what they are worth on people held apart.
//!
//! A search that begins at what ships: up to three constants change, each by a step that grows with success and shrinks with failure,
//! and a change that costs less stays. It costs what people would mind, on average over them, and far more to break one of the
//! [promises](promises). Each person is also held apart once: fitted on the others, scored on the one.

mod promises;

use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

use anyhow::ensure;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use serde::Serialize;
use tenax_logic::emg::constants::Fitted;
use tenax_logic::emg::decide::Electrode;
use tenax_logic::emg::fitted::FITTED;

use self::promises::Promises;
use super::emg::recordings::Days;
use super::emg::score::Count;
use super::emg::trial::{Kind, Trial, Trials};
use super::emg::{self, Recordings, Score, person};

/// A person's trials, and what the electrodes say in each.
struct Wearer<'a> {
    number: u32,
    days: &'a Days,
    trials: Vec<(Trial<'a>, Vec<[Electrode; 2]>)>,
}

impl<'a> Wearer<'a> {
    fn of(number: u32, days: &'a Days) -> Self {
        let heard = |trial: Trial<'a>| {
            let heard = trial.hear();
            (trial, heard)
        };
        Self { number, days, trials: Trials::of(days).all.into_iter().map(heard).collect() }
    }

    /// What this wearer's scores cost: windows that are not right, and those the wrong way, unanswered and false motions, which annoy
    /// more than their share, and what is late.
    fn cost(&self, fitted: &'static Fitted) -> f64 {
        let of = |kind: Kind, false_motion: f64| {
            let mut count = Count::default();
            for (trial, heard) in self.trials.iter().filter(|(trial, _)| trial.kind == kind) {
                trial.count(&trial.decide(fitted, heard), &mut count);
            }
            count.score().map_or(1.0, |score| cost(&score, false_motion))
        };
        of(Kind::SameSession, 0.01) + 0.3 * (of(Kind::OtherPosture, 0.003) + of(Kind::FirstDayKept, 0.005))
    }
}

fn cost(s: &Score, false_motion: f64) -> f64 {
    (1.0 - s.close_right)
        + 1.5 * (1.0 - s.open_right)
        + 3.0 * (s.close_wrong_way + s.open_wrong_way + s.missed)
        + false_motion * s.false_per_hour.min(300.0)
        + 0.5 * (s.latency_s_p95 - 0.5).max(0.0)
        + 0.2 * s.latency_s_p50.max(0.0)
}

/// What was found.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Mean cost of a person, and of the promises, of what ships and of what was found.
    pub cost: [f64; 2],
    /// The same of each person alone, with what ships and fitted on the others.
    pub held_cost: Vec<[f64; 2]>,
    /// What was fitted on the others, on each person.
    pub held: emg::Report,
    /// The file, `logic/src/emg/fitted.rs`.
    pub file: String,
}

/// Constants live as long as the search: a few hundred bytes each.
fn kept(fitted: Fitted) -> &'static Fitted {
    Box::leak(Box::new(fitted))
}

/// Changes some constants: by which part each, as a rule, is in `steps`. Which ones were changed.
fn changed(from: &Fitted, steps: &[f64; Fitted::COUNT], rng: &mut ChaCha8Rng) -> (Fitted, Vec<usize>) {
    let (mut fitted, mut shipped) = (from.clone(), FITTED.clone());
    let mut which = Vec::new();
    for _ in 0..rng.random_range(1..=3) {
        let n = rng.random_range(0..Fitted::COUNT);
        let most = *shipped.all_mut()[n] * 3;
        let value = &mut *fitted.all_mut()[n];
        let by = f64::from(*value) * steps[n] * rng.random_range(-1.5..1.5);
        // At least one: a small constant would stay for ever.
        let by = if by.abs() < 1.0 { by.signum() } else { by.round() };
        *value = (*value + by as i32).clamp(1, most);
        which.push(n);
    }
    (fitted, which)
}

fn search(
    folk: &[&Wearer],
    promises: &Promises,
    rounds: u32,
    seed: u64,
    step: &(dyn Fn() + Sync),
) -> ([f64; 2], &'static Fitted) {
    let cost_of = |fitted, enough: f64| {
        let broken = promises.cost(fitted);
        if broken >= enough {
            return broken;
        }
        let costs = folk.par_iter().map(|wearer| wearer.cost(fitted));
        costs.sum::<f64>() / folk.len() as f64 + broken
    };
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut steps = [0.2; Fitted::COUNT];
    let mut best = &FITTED;
    let first = cost_of(best, f64::INFINITY);
    let mut least = first;
    for _ in 0..rounds {
        let (tried, which) = changed(best, &steps, &mut rng);
        let tried = kept(tried);
        let value = cost_of(tried, least);
        // What changes nothing may stay: it is a way out of a plain.
        let better = value < least;
        if value <= least {
            (best, least) = (tried, value);
        }
        for n in which {
            let factor: f64 = if better { 1.6 } else { 0.95 };
            steps[n] = (steps[n] * factor).clamp(0.02, 0.6);
        }
        step();
    }
    ([first, least], best)
}

/// Searches for `rounds`, once with everybody and once without each person; `part` hears which part is done.
///
/// # Errors
/// If there are not at least two people, or a recording cannot be read.
pub fn fit(folder: &Path, rounds: u32, seed: u64, part: &(dyn Fn(f64) + Sync)) -> anyhow::Result<Report> {
    let Recordings { people, sessions } = Recordings::read(folder, None)?;
    ensure!(people.len() > 1, "{}: one person is not enough to hold one apart", folder.display());
    let promises = Promises::of(&sessions);
    let wearers: Vec<Wearer> = people.iter().map(|(&number, days)| Wearer::of(number, days)).collect();
    let all: Vec<&Wearer> = wearers.iter().collect();
    let done = AtomicU32::new(0);
    let whole = f64::from(rounds) * (all.len() + 1) as f64;
    let step = &|| part(f64::from(done.fetch_add(1, Ordering::Relaxed)) / whole);
    let held: Vec<(&Wearer, &'static Fitted)> = all
        .par_iter()
        .map(|&wearer| {
            let others: Vec<_> = all.iter().copied().filter(|other| other.number != wearer.number).collect();
            (wearer, search(&others, &promises, rounds, seed, step).1)
        })
        .collect();
    let held_cost: Vec<[f64; 2]> =
        held.iter().map(|(wearer, fitted)| [wearer.cost(&FITTED), wearer.cost(fitted)]).collect();
    let persons = held.iter().map(|(wearer, fitted)| person(fitted, wearer.number, wearer.days)).collect();
    let (cost, fitted) = search(&all, &promises, rounds, seed, step);
    let file = file(fitted, &all, rounds, seed, cost, &held_cost);
    Ok(Report { cost, held_cost, held: emg::Report::of(persons), file })
}

fn file(
    fitted: &Fitted,
    all: &[&Wearer],
    rounds: u32,
    seed: u64,
    cost: [f64; 2],
    held: &[[f64; 2]],
) -> String {
    let persons: Vec<String> = all.iter().map(|wearer| wearer.number.to_string()).collect();
    let costs: Vec<String> = held.iter().map(|[first, least]| format!("{first:.2} to {least:.2}")).collect();
    let [first, least] = cost;
    format!(
        "//! The constants of the wearer's model. Written by `cargo tenax train emg --ship`; do not edit.\n//!\n\
         //! Model card. Fitted on persons {} of a folder of recordings as `docs/emg.md` describes, read 240 times a second as the\n\
         //! board reads, calibrated from two repetitions of each session: {rounds} rounds of a random search, seed {seed}, from the\n\
         //! constants before. Mean cost {first:.2} to {least:.2}; each person fitted on the others, in turn: {}.\n\n\
         use super::constants::Fitted;\n\n/// What the board decides with.\npub static FITTED: Fitted = {fitted:?};\n",
        persons.join(", "),
        costs.join(", "),
    )
}
