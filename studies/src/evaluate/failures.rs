//! Where the array's detector may fail: twelve scenes, each with its score, with what the hand did then, and with its controls.

use anyhow::Context;
use rayon::prelude::*;
use serde::Serialize;
use tenax_logic::array::Reading;

use tenax_bench::array::events::stretches;
use tenax_bench::array::steps::Steps;
use tenax_bench::array::verdicts;

use super::ran;
use tenax_bench::jobs::{Jobs, Told};
use tenax_bench::report::bound::Control;
use tenax_bench::scorer::Card;
use tenax_bench::session::{self, Board};

/// The scenes: first the two that the others are the failures of.
pub const SCENES: [&str; 12] = [
    "array-pour",
    "array-disturb",
    "array-rotation",
    "array-slow",
    "array-dead",
    "array-stuck",
    "array-lost",
    "array-new-material",
    "array-load",
    "array-noisy",
    "array-saturated",
    "array-opening",
];

/// What came of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Its name.
    pub scene: &'static str,
    /// What the detector alone said, step by step.
    pub steps: Steps,
    /// Event scores of it.
    pub events: Card,
    /// Whether the object stayed in the hand. Null where the hand strokes a surface.
    pub kept: Option<bool>,
    /// How far it slid, mm, and with the bound.
    pub distance_mm: [Option<f64>; 2],
    /// The greatest force of a finger, N, and with the bound.
    pub peak_force_n: [Option<f64>; 2],
    /// Sensors that the board reported as lost.
    pub faults: Vec<String>,
    /// The same scene without the reflex, in a constant grip of the same mean force, with each detector alone. Empty where the hand
    /// holds nothing.
    pub controls: Vec<Control>,
}

/// Runs them all, on all cores, and scores what a `fresh` detector makes of what the board's converter read.
/// Fails if a board cannot be run.
pub fn rows<D: FnMut(&Reading) -> bool>(
    fresh: impl Fn() -> D + Sync,
    seed: u64,
    board: &Board,
    progress: Told,
) -> anyhow::Result<Vec<Row>> {
    let jobs = Jobs::new(SCENES.len(), progress);
    let row = |scene: &&'static str| {
        let file = session::load_scene(scene)?;
        let (mut job, mut ran) = (jobs.begin(), ran::Steps::default());
        let mut told = |s: f64| job.at(s / file.duration_s());
        let outcome = session::scene_with(&file, seed, board, &mut ran, &mut told)
            .with_context(|| format!("scene {scene}"))?;
        let steps = ran.steps;
        let said = verdicts(fresh(), &steps);
        let report = outcome.report;
        // As the controls count it: what stands on the table behind the hand is lost, too.
        let kept = report.grip.needed_force_n.map(|_| Control::of(scene, &outcome.truth).kept);
        let controls =
            kept.map(|_| session::controls::controls(&file, seed, &outcome.truth)).unwrap_or_default();
        let card = Card::of(&outcome.truth.slips, &stretches(ran::FIRST_S, &said), &outcome.truth.doing);
        Ok(Row {
            scene,
            steps: Steps::of(&steps, &said),
            events: card,
            kept,
            distance_mm: [report.slip.distance_mm, report.bound.distance_mm],
            peak_force_n: [report.grip.peak_force_n, report.bound.peak_force_n],
            faults: report.faults.iter().map(|fault| fault.what.clone()).collect(),
            controls,
        })
    };
    SCENES.par_iter().map(row).collect()
}
