//! `tenax learn`: a fingertip teaches itself slip from a camera, and shows what that is worth (Tada 2006, section III).
//!
//! A [`finger`] goes through lessons and held-out [`trial`]s on the host's logic ([`bench`]). Then it is tried in an hour of
//! [`holding`], and in lifts and pours with the [`reflex`]; other fingers are drawn.

pub mod bench;
pub mod finger;
pub mod holding;
pub mod reflex;
pub mod report;
pub mod trial;

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use bench::Bench;
use finger::Finger;
use holding::Holding;
use reflex::Three;
use report::Score;
use trial::{Setup, Trial};

/// Trials of a lesson (Tada 2006, section III-C).
pub const LESSONS: u64 = 7;
/// Held-out trials of each random finger.
const TRIALS_OF_OTHERS: u64 = 10;

#[derive(Clone, Debug)]
pub struct Options {
    pub seed: u64,
    pub trials: u64,
    pub minutes: u64,
    /// Lifts, and pours, with the reflex.
    pub lifts: u64,
    /// Random fingers.
    pub fingertips: u64,
}

impl Default for Options {
    fn default() -> Self {
        // 200 min are 3.1 h of holding: at most one false alarm in three hours is asked for.
        Self { seed: 1, trials: 50, minutes: 200, lifts: 20, fingertips: 20 }
    }
}

#[derive(Clone, Debug)]
pub struct Outcome {
    /// The largest output in a trial of the finger before it learned; 128 would be 1.
    pub untaught: u8,
    pub trials: Vec<Trial>,
    pub score: Score,
    /// The score of the same trials with equal weights in place of learned ones.
    pub equal: Score,
    pub holding: Holding,
    pub lifts: Vec<Three>,
    pub pours: Vec<Three>,
    /// Random fingers.
    pub others: Vec<Score>,
}

/// Told what is being done, and how much of it is over, 0 to 1.
pub type Progress<'a> = &'a (dyn Fn(&str, f64) + Sync);

/// Does all of it. Fails if a scene cannot be made.
pub fn run(options: &Options, progress: Progress) -> anyhow::Result<Outcome> {
    let &Options { seed: all, trials: count, minutes, lifts, fingertips, .. } = options;
    let finger = Finger::plain(all);
    let silent = held_out(&finger, Bench::default(), all, 1)?;
    let loudest = silent
        .iter()
        .flat_map(|trial| trial.outputs.as_flattened())
        .map(|output| output.unsigned_abs())
        .max();
    progress("learning", 0.0);
    let learned = taught(&finger, all)?;
    progress("held-out trials", 0.0);
    let equal = Score::of(&held_out(&finger, learned.equalised()?, all, count)?);
    progress("held-out trials", 0.5);
    let trials = held_out(&finger, learned.clone(), all, count)?;

    let over = AtomicU64::new(0);
    let step = |what: &str, count: u64| {
        progress(what, over.fetch_add(1, Ordering::Relaxed) as f64 / count as f64);
    };
    let holding = holding::hold(&finger, &learned, minutes, seed(all, 3, 0), &|| step("holding", minutes))?;
    progress("lifting and pouring", 0.0);
    let lifted = reflex::lifts(&finger, &learned, lifts, seed(all, 4, 0))?;
    let pours = reflex::pours(&finger, &learned, lifts, seed(all, 5, 0))?;
    over.store(0, Ordering::Relaxed);
    let others = (1..=fingertips).into_par_iter().map(|n| {
        let own = seed(all, 6, n);
        let finger = Finger::random(own);
        let trials = held_out(&finger, taught(&finger, own)?, own, TRIALS_OF_OTHERS)?;
        step("other fingers", fingertips);
        Ok(Score::of(&trials))
    });
    Ok(Outcome {
        untaught: loudest.unwrap_or(0),
        score: Score::of(&trials),
        equal,
        trials,
        holding,
        lifts: lifted,
        pours,
        others: others.collect::<anyhow::Result<_>>()?,
    })
}

/// A fingertip after its lessons. Fails if a scene cannot be made.
pub fn taught(finger: &Finger, all: u64) -> anyhow::Result<Bench> {
    let mut bench = Bench::default();
    for n in 0..LESSONS {
        bench.trial(Setup::new(finger, seed(all, 1, n), true)?);
    }
    Ok(bench)
}

fn held_out(finger: &Finger, mut bench: Bench, all: u64, count: u64) -> anyhow::Result<Vec<Trial>> {
    (0..count).map(|n| Ok(bench.trial(Setup::new(finger, seed(all, 2, n), false)?))).collect()
}

/// Room for a million of each.
const fn seed(all: u64, what: u64, n: u64) -> u64 {
    all.wrapping_mul(100).wrapping_add(what).wrapping_mul(1_000_000).wrapping_add(n)
}
