//! Fits the constants of the wearer's model to recordings of people by a random search, and scores them on each person who was left out. A
//! change stays if it costs less and makes no person, no [promise](promises) and no drawn fault worse.

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
use super::emg::faults;
use super::emg::interval::Interval;
use super::emg::recordings::Days;
use super::emg::score::Count;
use super::emg::trial::{Kind, Trial, Trials};
use super::emg::{self, Recordings, Score, person};

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

    fn cost(&self, fitted: &'static Fitted) -> f64 {
        let of = |kind: Kind, false_motion: f64| {
            let own = self.trials.iter().filter(|(trial, _)| trial.kind == kind);
            let counts: Vec<Count> =
                own.map(|(trial, heard)| trial.counted(&trial.decide(fitted, heard))).collect();
            Count::sum(&counts).score().map_or(1.0, |score| cost(&score, false_motion))
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

/// Round figures to begin at.
static PLAIN: Fitted = Fitted {
    mean_frames: 8,
    begins: [600, 600],
    ends: [400, 400],
    hysteresis: 250,
    least_end: 200,
    fall: 300,
    least_fall: 1_000,
    crest_frames: 320,
    rise: 300,
    least_rise: 500,
    least_spreads: 3,
    place_begins: 500,
    place_stays: [600, 400],
    dwell: [3, 3, 3, 3],
    rest_frames: 320,
    after_frames: [32, 64],
    after_dwell: 8,
    firmer: 200,
    both: 300,
    busy: 600,
};

/// A change that makes anybody's cost higher than by this does not stay.
const WORSE: f64 = 0.005;
/// Faults that are drawn over the people who are fitted on, and what each of them costs that opens the hand.
const FAULTS: u32 = 400;
const OPENS: f64 = 20.0;

#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub cost: [f64; 2],
    /// Each person with constants that were fitted to the others, from round figures.
    pub held_one: emg::Report,
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

/// Costs of the people, each by itself, then of the promises and faults. None as soon as one of them is worse than before.
fn costs(
    folk: &[&Wearer],
    promises: &Promises,
    fitted: &'static Fitted,
    before: Option<&[f64]>,
) -> Option<Vec<f64>> {
    let mut all = Vec::new();
    let mut is_worse = |cost: f64| {
        let worse = before.is_some_and(|before| cost > before[all.len()] + WORSE);
        all.push(cost);
        worse
    };
    if folk.iter().any(|wearer| is_worse(wearer.cost(fitted) / folk.len() as f64))
        || is_worse(promises.cost(fitted))
    {
        return None;
    }
    let trials: Vec<&Trial> = folk.iter().flat_map(|own| own.trials.iter().map(|own| &own.0)).collect();
    let drawn = faults::draw(fitted, &trials, FAULTS, 1).all;
    (!is_worse(OPENS * drawn.dropped as f64 / drawn.cases.max(1) as f64)).then_some(all)
}

fn search(
    folk: &[&Wearer],
    promises: &Promises,
    (rounds, seed): (u32, u64),
    from: &'static Fitted,
    step: &(dyn Fn() + Sync),
) -> ([f64; 2], &'static Fitted) {
    let sum = |costs: &[f64]| costs.iter().sum::<f64>();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut steps = [0.2; Fitted::COUNT];
    let mut best = from;
    let mut least = costs(folk, promises, best, None).unwrap_or_default();
    let first = sum(&least);
    for _ in 0..rounds {
        let (tried, which) = changed(best, &steps, &mut rng);
        let tried = kept(tried);
        let mut better = false;
        if let Some(all) = costs(folk, promises, tried, Some(&least)) {
            better = sum(&all) < sum(&least);
            // What changes nothing may stay: it is a way out of a plain.
            if sum(&all) <= sum(&least) {
                (best, least) = (tried, all);
            }
        }
        for n in which {
            let factor: f64 = if better { 1.6 } else { 0.95 };
            steps[n] = (steps[n] * factor).clamp(0.02, 0.6);
        }
        step();
    }
    ([first, sum(&least)], best)
}

/// Searches for `rounds`, once with everybody and once without each person; `part` gets the part that is done. Fails if there are not at
/// least two people, or a recording cannot be read.
pub fn fit(folder: &Path, rounds: u32, seed: u64, part: &(dyn Fn(f64) + Sync)) -> anyhow::Result<Report> {
    let Recordings { people, sessions } = Recordings::read(folder)?;
    ensure!(people.len() > 1, "{}: one person is not enough to hold one apart", folder.display());
    let promises = Promises::of(&sessions);
    let wearers: Vec<Wearer> = people.iter().map(|(&number, days)| Wearer::of(number, days)).collect();
    let all: Vec<&Wearer> = wearers.iter().collect();
    let done = AtomicU32::new(0);
    let whole = f64::from(rounds) * (all.len() + 1) as f64;
    let step = &|| part(f64::from(done.fetch_add(1, Ordering::Relaxed)) / whole);
    let without = |&own: &&Wearer| {
        let others: Vec<&Wearer> = all.iter().copied().filter(|other| other.number != own.number).collect();
        let fitted = search(&others, &promises, (rounds, seed), &PLAIN, step).1;
        person(fitted, own.number, own.days)
    };
    let held_one = emg::Report::of(all.par_iter().map(without).collect());
    let (cost, fitted) = search(&all, &promises, (rounds, seed), &FITTED, step);
    let file = file(fitted, &all, (rounds, seed), cost, &held_one);
    Ok(Report { cost, held_one, file })
}

fn row(name: &str, score: Option<Score>, interval: Option<Interval>) -> String {
    let (Some(score), Some(Interval { low, high })) = (score, interval) else { return String::new() };
    let of = |what: &str, value: fn(&Score) -> f64| {
        format!("{what} {:.3} ({:.3} to {:.3})", value(&score), value(&low), value(&high))
    };
    let values = [
        of("closes right", |own| own.close_right),
        of("wrong way", |own| own.close_wrong_way),
        of("opens right", |own| own.open_right),
        of("wrong way", |own| own.open_wrong_way),
        of("missed", |own| own.missed),
        of("false an hour", |own| own.false_per_hour),
    ];
    format!("//! - {name}: {}\n", values.join(", "))
}

fn file(
    fitted: &Fitted,
    all: &[&Wearer],
    (rounds, seed): (u32, u64),
    [first, least]: [f64; 2],
    held: &emg::Report,
) -> String {
    let persons: Vec<String> = all.iter().map(|wearer| wearer.number.to_string()).collect();
    let rows = [
        row("same session", held.scores.same_session, held.intervals.same_session),
        row("other posture", held.scores.other_posture, held.intervals.other_posture),
        row("first day's calibration kept", held.scores.first_day_kept, held.intervals.first_day_kept),
    ];
    format!(
        "//! The constants of the wearer's model. Written by `cargo tenax train emg --ship`; do not edit.\n//!\n\
         //! Model card. Fitted on persons {} of a folder of recordings as `docs/emg.md` describes, read 240 times a second as the\n\
         //! board reads, calibrated from two repetitions of a session; with {FAULTS} faults drawn over them and what `promises.rs` has:\n\
         //! {rounds} rounds of a random search, seed {seed}, from the constants before. Cost {first:.3} to {least:.3}.\n//!\n\
         //! Fitted anew on all but one, from round figures, and scored on that one; median (95 % interval, people and sessions drawn\n\
         //! again):\n//!\n{}\nuse super::constants::Fitted;\n\n/// The constants of the model that the image runs.\n\
         pub static FITTED: Fitted = {fitted:?};\n",
        persons.join(", "),
        rows.concat(),
    )
}
