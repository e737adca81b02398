//! The paper's online tasks (Bamshad 2023, section 6): pick and place, and a grasp kept while balls are poured in, ten
//! times each for four materials, with the whole fingertip closing the loop. The box has to be kept.

use std::collections::BTreeMap;

use anyhow::Context;
use rand::{SeedableRng, rngs::ChaCha8Rng};
use rayon::prelude::*;
use serde::Serialize;
use tenax_sim::array::material::SEEN;
use tenax_sim::jobs::{Job, Jobs, Told};
use tenax_sim::report::bound::Control;
use tenax_sim::session::{self, Board};

use crate::dataset::session::{Session, Sizes, sessions};
use crate::dataset::story::Story;

/// Repetitions of each task with each material.
pub const TIMES: usize = 10;
/// In the paper's order.
pub const TASKS: [Story; 2] = [Story::Pick, Story::Pour];

#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Figures {
    /// Way of the box in the hand and in the bound's, mm.
    pub distance_mm: f64,
    pub bound_distance_mm: f64,
    /// The greatest force of a finger, the bound's, and the least that would have held the box at its heaviest, N.
    pub peak_force_n: f64,
    pub bound_peak_force_n: f64,
    pub needed_force_n: f64,
}

#[derive(Clone, Debug, Serialize)]
pub struct Try {
    pub material: &'static str,
    /// `pick` or `pour`.
    pub task: &'static str,
    pub seed: u64,
    /// Whether the box stayed in the hand.
    pub kept: bool,
    /// Controls that kept it: without the reflex, in a constant grip of the same mean force, with each detector alone.
    pub kept_by: Vec<String>,
    #[serde(flatten)]
    pub figures: Figures,
}

/// The tries of one task with one material; means of their figures.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    pub material: &'static str,
    pub task: &'static str,
    pub tries: usize,
    pub kept: usize,
    #[serde(flatten)]
    pub figures: Figures,
    /// Tries that each control kept.
    pub kept_by: BTreeMap<String, usize>,
}

#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub rows: Vec<Row>,
    pub tries: Vec<Try>,
}

/// Tries everything, on all cores. `progress` is told the part that is done, 0 to 1.
///
/// Sessions are drawn from another seed than any data set's default, so no network has seen one of them. Fails if a board cannot be run.
pub fn tasks(seed: u64, times: usize, board: &Board, progress: Told) -> anyhow::Result<Vec<Try>> {
    let drawn = sessions(SEED_OFFSET + seed, Sizes { train: times, validation: 0, test: 0 });
    let jobs: Vec<(Story, &Session)> =
        TASKS.iter().flat_map(|&task| drawn.iter().map(move |session| (task, session))).collect();
    let all = Jobs::new(jobs.len(), progress);
    jobs.par_iter().map(|&(task, session)| attempt(task, session, board, all.begin())).collect()
}

/// Away from the seeds that anybody gives to a data set.
const SEED_OFFSET: u64 = 1 << 40;

fn attempt(task: Story, session: &Session, board: &Board, mut job: Job) -> anyhow::Result<Try> {
    let mut rng = ChaCha8Rng::seed_from_u64(session.seed);
    let scene = task.task_in(session, &mut rng)?;
    let mut told = |s: f64| job.at(s / scene.duration_s());
    let outcome = session::scene(&scene, session.seed, board, &mut told)?;
    let controls = session::controls::controls(&scene, session.seed, &outcome.truth);
    let report = outcome.report;
    let known = "a scene knows what became of its object";
    Ok(Try {
        material: session.material,
        task: task.name(),
        seed: session.seed,
        kept: Control::of(task.name(), &outcome.truth).kept,
        kept_by: controls.iter().filter(|own| own.kept).map(|own| own.name.clone()).collect(),
        figures: Figures {
            distance_mm: report.slip.distance_mm.context(known)?,
            bound_distance_mm: report.bound.distance_mm.context(known)?,
            peak_force_n: report.grip.peak_force_n.context(known)?,
            bound_peak_force_n: report.bound.peak_force_n.context(known)?,
            needed_force_n: report.grip.needed_force_n.unwrap_or(0.0),
        },
    })
}

/// The tries as a table: each task with each material.
pub fn rows(tries: &[Try]) -> Vec<Row> {
    let all = TASKS.iter().flat_map(|task| SEEN.iter().map(move |material| (task.name(), material.name)));
    let row = |(task, material)| {
        let own: Vec<&Try> =
            tries.iter().filter(|own| own.task == task && own.material == material).collect();
        let mean = |of: fn(&Figures) -> f64| {
            own.iter().map(|own| of(&own.figures)).sum::<f64>() / own.len().max(1) as f64
        };
        let mut kept_by: BTreeMap<String, usize> = BTreeMap::new();
        own.iter()
            .flat_map(|own| &own.kept_by)
            .for_each(|name| *kept_by.entry(name.clone()).or_default() += 1);
        Row {
            material,
            task,
            tries: own.len(),
            kept: own.iter().filter(|own| own.kept).count(),
            figures: Figures {
                distance_mm: mean(|own| own.distance_mm),
                bound_distance_mm: mean(|own| own.bound_distance_mm),
                peak_force_n: mean(|own| own.peak_force_n),
                bound_peak_force_n: mean(|own| own.bound_peak_force_n),
                needed_force_n: mean(|own| own.needed_force_n),
            },
            kept_by,
        }
    };
    all.map(row).collect()
}
