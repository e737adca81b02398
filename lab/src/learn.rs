//! `tenax learn`: a fingertip teaches itself slip from a camera, and shows what that is worth (Tada 2006, section III).
//!
//! One [`finger`] goes through lessons and held-out [`trial`]s: on the host ([`bench`]), or as one [`chain`] on the
//! emulated board. There most commands are taken a tick later, for the line needs more time than the end of a frame leaves:
//! the hand moves half a millisecond later, and no code is quite what it would have been. So the two are compared by giving
//! the host's logic the image's own codes, and each command in the tick in which the image took it ([`Agreement`]).
//!
//! The fingertip that learned on the host is then tried there: in an hour of [`holding`], in a lift and a pour with the
//! [`reflex`], and on fingers made by chance.

pub mod bench;
pub mod chain;
pub mod control;
pub mod figures;
pub mod finger;
pub mod holding;
pub mod reflex;
pub mod report;
pub mod trial;

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use bench::Bench;
use control::Control;
use finger::Finger;
use holding::Holding;
use reflex::Three;
use report::{Safe, Score};
use tenax_sim::board::agreement::Agreement;
use tenax_sim::scorer::Verdict;
use tenax_sim::session::Board;
use trial::{Setup, Trial, Word};

/// Trials of a lesson (Tada 2006, section III-C).
pub const LESSONS: u64 = 7;
/// Duration of a trial that ends with the slip up, s from the lift on.
const SLIP_UP_S: f64 = 1.5;
/// Lifts of each finger made by chance with more force than the object needs.
const SAFE_LIFTS: u64 = 5;
/// Held-out trials of each finger made by chance.
const TRIALS_OF_OTHERS: u64 = 10;

#[derive(Clone, Debug)]
pub struct Options {
    pub seed: u64,
    pub trials: u64,
    pub minutes: u64,
    /// Lifts, and pours, with the reflex.
    pub lifts: u64,
    /// Fingers made by chance.
    pub fingertips: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            seed: 1,
            trials: 50,
            // 3.1 h: at most one false alarm in three hours is asked for.
            minutes: 200,
            lifts: 20,
            fingertips: 20,
        }
    }
}

#[derive(Clone, Debug)]
pub struct Outcome {
    pub options: Options,
    pub board: &'static str,
    /// Whether the board said what the host's logic says to the same codes and commands, tick for tick. None if the host
    /// ran the trials.
    pub agreement: Option<Agreement>,
    /// A trial of the finger before it learned: the largest output, 128 would be 1.
    pub untaught: u8,
    pub trials: Vec<Trial>,
    pub score: Score,
    /// The score of the same trials with equal weights in place of learned ones, on the host.
    pub equal: Score,
    pub holding: Holding,
    pub lifts: Vec<Three>,
    pub pours: Vec<Three>,
    pub others: Vec<Other>,
}

/// Told what is being done, and how much of it is over, 0 to 1.
pub type Progress<'a> = &'a (dyn Fn(&str, f64) + Sync);

/// Does all of it. Fails if a scene cannot be made or the board cannot be run.
pub fn run(options: &Options, board: &Board, progress: Progress) -> anyhow::Result<Outcome> {
    let finger = Finger::plain(options.seed);
    let mut untaught = Bench::default();
    let silent = untaught.trial(Setup::new(&finger, held_out(options.seed, 0), false)?);
    let loudest = silent.outputs.iter().flatten().map(|output| output.unsigned_abs()).max();

    let mut learned = Bench::default();
    for n in 0..LESSONS {
        learned.trial(Setup::new(&finger, lesson(options.seed, n), true)?);
        progress("learning", n as f64 / LESSONS as f64);
    }
    let equal = learned.controlled(Control::EqualWeights)?;
    let equal = Score::of(&trials_on_host(&finger, equal, options, progress)?);
    let (trials, agreement) = if matches!(board, Board::Host) {
        (trials_on_host(&finger, learned.clone(), options, progress)?, None)
    } else {
        let (trials, agreement) = on_board(&finger, options, board, progress)?;
        (trials, Some(agreement))
    };

    let over = AtomicU64::new(0);
    let holding = holding::hold(&finger, &learned, options.minutes, seed(options.seed, 3, 0), &|| {
        let over = over.fetch_add(1, Ordering::Relaxed);
        progress("holding", over as f64 / options.minutes as f64);
    })?;
    progress("lifting and pouring", 0.0);
    let lifts = reflex::lifts(&finger, &learned, options.lifts, seed(options.seed, 4, 0))?;
    let pours = reflex::pours(&finger, &learned, options.lifts, seed(options.seed, 5, 0))?;
    let over = AtomicU64::new(0);
    let others = (1..=options.fingertips).into_par_iter().map(|n| {
        let score = other(options, n);
        let over = over.fetch_add(1, Ordering::Relaxed);
        progress("other fingers", over as f64 / options.fingertips as f64);
        score
    });
    let others = others.collect::<anyhow::Result<Vec<Other>>>()?;
    Ok(Outcome {
        options: options.clone(),
        board: board.name(),
        agreement,
        untaught: loudest.unwrap_or(0),
        score: Score::of(&trials),
        equal,
        trials,
        holding,
        lifts,
        pours,
        others,
    })
}

fn trials_on_host(
    finger: &Finger,
    mut learned: Bench,
    options: &Options,
    progress: Progress,
) -> anyhow::Result<Vec<Trial>> {
    let mut trials = Vec::new();
    for n in 0..options.trials {
        trials.push(learned.trial(Setup::new(finger, held_out(options.seed, n), false)?));
        progress("held-out trials", n as f64 / options.trials as f64);
    }
    Ok(trials)
}

/// Lessons and trials as one chain on a board: the trials, and whether the host's logic says the same all the way.
fn on_board(
    finger: &Finger,
    options: &Options,
    board: &Board,
    progress: Progress,
) -> anyhow::Result<(Vec<Trial>, Agreement)> {
    let mut setups = Vec::new();
    for n in 0..LESSONS {
        setups.push(Setup::new(finger, lesson(options.seed, n), true)?);
    }
    for n in 0..options.trials {
        setups.push(Setup::new(finger, held_out(options.seed, n), false)?);
    }
    let chain = chain::Chain::new(setups);
    let all_s = tenax_scene::plant::Plant::duration_s(&chain);
    let (run, chain) = board.run(chain, &mut |s| progress("on the emulated board", s / all_s))?;
    let (agreement, host) = Agreement::with_host(&run);
    Ok((chain.trials(&run, &host).split_off(LESSONS as usize), agreement))
}

/// A finger made by chance.
#[derive(Clone, Debug, Default)]
pub struct Other {
    pub ratio: f64,
    pub score: Score,
    /// Lifts with more force than the object needs.
    pub safe: Safe,
}

fn other(options: &Options, n: u64) -> anyhow::Result<Other> {
    let own = seed(options.seed, 6, n);
    let finger = Finger::random(own);
    let mut bench = Bench::default();
    for n in 0..LESSONS {
        bench.trial(Setup::new(&finger, lesson(own, n), true)?);
    }
    let mut safe = Safe::default();
    for n in 0..SAFE_LIFTS {
        let setup = Setup::held(&finger, seed(own, 7, n))?;
        let trial = bench.clone().trial_for(SLIP_UP_S, setup);
        // One that slips all the same is none of these.
        if trial.slip_up().is_none() {
            safe.lifts += 1;
            let said =
                |word| trial.verdicts(word).iter().any(|verdict: &Verdict| verdict.from_s > trial.lift_s);
            safe.said += u64::from(said(Word::Any));
            safe.slip += u64::from(said(Word::Slip));
        }
    }
    let mut trials = Vec::new();
    for n in 0..TRIALS_OF_OTHERS {
        trials.push(bench.trial(Setup::new(&finger, held_out(own, n), false)?));
    }
    let score = Score::of(&trials);
    Ok(Other { ratio: finger.ratio(), score, safe })
}

fn lesson(all: u64, n: u64) -> u64 {
    seed(all, 1, n)
}

fn held_out(all: u64, n: u64) -> u64 {
    seed(all, 2, n)
}

/// Room for a million of each.
const fn seed(all: u64, what: u64, n: u64) -> u64 {
    all.wrapping_mul(100).wrapping_add(what).wrapping_mul(1_000_000).wrapping_add(n)
}
