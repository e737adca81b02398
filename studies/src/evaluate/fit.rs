//! Fits the constants of the wearer's model to recordings of people, and says what they are worth on people held apart.
//!
//! A search that begins at what ships: up to three constants change by up to 30 %, and a change that costs less on average over
//! people stays. Each person is also held apart once: fitted on the others, scored on the one.

use std::fmt;
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

use anyhow::ensure;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use serde::Serialize;
use tenax_logic::emg::constants::Fitted;
use tenax_logic::emg::fitted::FITTED;

use super::emg::recordings::Days;
use super::emg::{self, Person, Recordings, Score, person};

/// What a person's scores cost: windows that are not right, and those the wrong way, unanswered and false motions, which annoy more
/// than their share, and what is late.
fn cost(person: &Person) -> f64 {
    let of = |score: Option<Score>, false_motion: f64| {
        let Some(s) = score else { return 1.0 };
        let [wrong, late] = [s.close_wrong_way + s.open_wrong_way, (s.latency_s_p95 - 0.5).max(0.0)];
        (1.0 - s.close_right)
            + 1.5 * (1.0 - s.open_right)
            + 3.0 * (wrong + s.missed)
            + false_motion * s.false_per_hour.min(300.0)
            + 0.5 * late
            + 0.2 * s.latency_s_p50.max(0.0)
            + 0.1 * s.full_s_p95.min(3.0)
    };
    of(person.same_session, 0.01) + 0.3 * (of(person.other_posture, 0.003) + of(person.first_day_kept, 0.005))
}

/// What was found.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Mean cost of a person, of what ships and of what was found.
    pub cost: [f64; 2],
    /// The same of each person, fitted on the others.
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

fn changed(from: &Fitted, rng: &mut ChaCha8Rng) -> Fitted {
    let mut fitted = from.clone();
    let mut shipped = FITTED.clone();
    for _ in 0..rng.random_range(1..=3) {
        let n = rng.random_range(0..Fitted::COUNT);
        let most = *shipped.all_mut()[n] * 3;
        let value = &mut *fitted.all_mut()[n];
        *value = ((f64::from(*value) * rng.random_range(0.7..1.3)).round() as i32).clamp(1, most);
    }
    fitted
}

fn search(
    folk: &[(u32, &Days)],
    rounds: u32,
    seed: u64,
    step: &(dyn Fn() + Sync),
) -> ([f64; 2], &'static Fitted) {
    let mean = |fitted| {
        let costs = folk.par_iter().map(|(number, days)| cost(&person(fitted, *number, days)));
        costs.sum::<f64>() / folk.len() as f64
    };
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut best = &FITTED;
    let first = mean(best);
    let mut least = first;
    for _ in 0..rounds {
        let tried = kept(changed(best, &mut rng));
        let value = mean(tried);
        if value < least {
            (best, least) = (tried, value);
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
    let Recordings { people, .. } = Recordings::read(folder, None)?;
    ensure!(people.len() > 1, "{}: one person is not enough to hold one apart", folder.display());
    let all: Vec<(u32, &Days)> = people.iter().map(|(number, days)| (*number, days)).collect();
    let done = AtomicU32::new(0);
    let whole = f64::from(rounds) * (all.len() + 1) as f64;
    let step = &|| part(f64::from(done.fetch_add(1, Ordering::Relaxed)) / whole);
    let held: Vec<Person> = all
        .par_iter()
        .map(|&(number, days)| {
            let others: Vec<_> = all.iter().copied().filter(|other| other.0 != number).collect();
            person(search(&others, rounds, seed, step).1, number, days)
        })
        .collect();
    let held_cost: Vec<[f64; 2]> = all
        .iter()
        .zip(&held)
        .map(|((number, days), held)| [cost(&person(&FITTED, *number, days)), cost(held)])
        .collect();
    let (cost, fitted) = search(&all, rounds, seed, step);
    let file = file(fitted, &all, rounds, seed, cost, &held_cost);
    Ok(Report { cost, held_cost, held: emg::Report::of(held), file })
}

fn file(
    fitted: &Fitted,
    all: &[(u32, &Days)],
    rounds: u32,
    seed: u64,
    cost: [f64; 2],
    held: &[[f64; 2]],
) -> String {
    let persons: Vec<String> = all.iter().map(|(number, _)| number.to_string()).collect();
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

/// A table for people.
#[derive(Debug)]
pub struct Text<'a>(pub &'a Report);

impl fmt::Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(report) = self;
        let [first, least] = report.cost;
        writeln!(f, "everybody: a person's mean cost {first:.3} before, {least:.3} after")?;
        for (Person { person, .. }, [first, least]) in report.held.persons.iter().zip(&report.held_cost) {
            writeln!(
                f,
                "person {person} held apart: {first:.3} with what ships, {least:.3} fitted on the others"
            )?;
        }
        write!(f, "\neach person fitted on the others:\n{}", emg::Text(&report.held))
    }
}
