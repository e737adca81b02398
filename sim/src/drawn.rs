//! Scores on drawn worlds: what the hand kept, pressed and let slide, beside a causal oracle and the bound.

use anyhow::Context;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::{Map, Value};
use tenax_frames::quantile::{middle, not_exceeded};
use tenax_scene::drawn::{Drawn, Family, nth};

use crate::jobs::{Jobs, Told};
use crate::session::{self, Board, controls};

/// Worlds in which the oracle slides further than half a pad are not scored for losses, mm.
pub const HALF_PAD_MM: f64 = 9.0;
const HARDEST: usize = 10;

/// One world's outcome.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    pub family: &'static str,
    pub index: u32,
    /// The oracle holds it within half a pad.
    pub accepted: bool,
    pub kept: bool,
    pub slid_mm: f64,
    pub slid_mm_oracle: f64,
    pub peak_n: f64,
    pub peak_n_oracle: f64,
    /// The bound's peak.
    pub needed_n: Option<f64>,
    /// Peak force over the bound's. Null if the run lost the object.
    pub peak_over_needed: Option<f64>,
    pub without_need_n: f64,
    /// Ticks in which the reflex drove the motor while a muscle was active.
    pub reflex_while_active: u64,
}

impl Score {
    /// Runs the world on the host's logic and under the oracle. Fails if it is no scene.
    pub fn of(drawn: &Drawn) -> anyhow::Result<Self> {
        let file = drawn.scene()?;
        let outcome = session::scene(&file, drawn.noise_seed, &Board::Host, &mut |_| {})?;
        let oracle = controls::oracle(&file, drawn.noise_seed);
        let report = outcome.report;
        Ok(Self {
            family: drawn.family.name(),
            index: drawn.index,
            accepted: oracle.kept() && oracle.distance_mm <= HALF_PAD_MM,
            kept: outcome.truth.kept(),
            slid_mm: outcome.truth.distance_mm,
            slid_mm_oracle: oracle.distance_mm,
            peak_n: outcome.truth.peak_grip_n.unwrap_or(0.0),
            peak_n_oracle: oracle.peak_grip_n.unwrap_or(0.0),
            needed_n: report.bound.peak_force_n,
            peak_over_needed: report.bound.peak_force_ratio,
            without_need_n: report.added.added_without_need_n.unwrap_or(0.0),
            reflex_while_active: report.wearer.reflex_while_active,
        })
    }

    const fn is_lost(&self) -> bool {
        self.accepted && !self.kept
    }
}

/// Scores of a family, or of all worlds.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Row {
    pub worlds: usize,
    /// Part of the worlds that the oracle does not hold within half a pad; the rows below but the last two leave them out.
    pub rejected: f64,
    pub lost_where_oracle_keeps: f64,
    pub peak_over_needed_median: Option<f64>,
    pub peak_over_needed_p95: Option<f64>,
    pub slid_mm_p95: Option<f64>,
    pub slid_mm_p95_oracle: Option<f64>,
    /// A world, of all.
    pub without_need_n: f64,
    pub reflex_while_active: u64,
}

impl Row {
    fn of<'a>(scores: impl Iterator<Item = &'a Score>) -> Self {
        let all: Vec<&Score> = scores.collect();
        let fair: Vec<&Score> = all.iter().copied().filter(|score| score.accepted).collect();
        let part = |some: usize, of: usize| some as f64 / of.max(1) as f64;
        let peaks = || fair.iter().filter_map(|score| score.peak_over_needed);
        Self {
            worlds: all.len(),
            rejected: part(all.len() - fair.len(), all.len()),
            lost_where_oracle_keeps: part(fair.iter().filter(|score| score.is_lost()).count(), fair.len()),
            peak_over_needed_median: middle(peaks()),
            peak_over_needed_p95: not_exceeded(peaks(), 0.95),
            slid_mm_p95: not_exceeded(fair.iter().map(|score| score.slid_mm), 0.95),
            slid_mm_p95_oracle: not_exceeded(fair.iter().map(|score| score.slid_mm_oracle), 0.95),
            without_need_n: all.iter().map(|score| score.without_need_n).sum::<f64>()
                / all.len().max(1) as f64,
            reflex_while_active: all.iter().map(|score| score.reflex_while_active).sum(),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    pub seed: u64,
    pub total: Row,
    /// By name, in the order of [`Family::ALL`].
    pub families: Map<String, Value>,
    /// Every world that was lost where the oracle keeps it.
    pub lost: Vec<Score>,
    /// The worlds with the highest peak over what is needed, at most ten.
    pub hardest: Vec<Score>,
}

/// Runs `count` worlds side by side.
/// Fails if a range leads out of what a scene file may say.
pub fn scores(family: Option<Family>, seed: u64, count: u32, told: Told<'_>) -> anyhow::Result<Vec<Score>> {
    let jobs = Jobs::new(count as usize, told);
    let one = |n| {
        let _done = jobs.begin();
        let drawn = nth(family, seed, n);
        Score::of(&drawn).with_context(|| format!("world {} of {}", drawn.index, drawn.family.name()))
    };
    (0..count).into_par_iter().with_max_len(1).map(one).collect()
}

impl Report {
    pub fn new(seed: u64, scores: &[Score]) -> anyhow::Result<Self> {
        let of = |family: Family| scores.iter().filter(move |score| score.family == family.name());
        let drawn = Family::ALL.into_iter().filter(|&family| of(family).next().is_some());
        let row = |family: Family| Ok((family.name().to_owned(), serde_json::to_value(Row::of(of(family)))?));
        let over = |score: &Score| score.peak_over_needed.filter(|_| score.accepted).unwrap_or(0.0);
        let mut hardest: Vec<&Score> = scores.iter().collect();
        hardest.sort_by(|a, b| over(b).total_cmp(&over(a)));
        Ok(Self {
            seed,
            total: Row::of(scores.iter()),
            families: drawn.map(row).collect::<anyhow::Result<_>>()?,
            lost: scores.iter().filter(|score| score.is_lost()).cloned().collect(),
            hardest: hardest.into_iter().take(HARDEST).cloned().collect(),
        })
    }
}
