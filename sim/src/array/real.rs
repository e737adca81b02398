//! Recordings of a real array beside the scenes: what scenes cannot show.

use std::collections::BTreeMap;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use serde::Serialize;

use super::adapt::Judged;

/// How often recordings are drawn again, and between which of those draws an interval of 95 % lies.
const DRAWS: usize = 1_000;
const INTERVAL: [usize; 2] = [25, 974];

/// How a network does on recordings of a real array, each of which slips as a whole or not at all: all its calibrations together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Real {
    /// Mean, over steps, of the part of slipping ones that was called slip and the part of the others that was not.
    pub balanced: f64,
    /// Between which two it lies, with 95 %, if recordings of either kind are drawn again.
    pub balanced_interval: [f64; 2],
    /// Probability that a step that slips has a higher logit than one that does not.
    pub auc: f64,
    pub auc_interval: [f64; 2],
    /// The same of whole recordings by their mean logits.
    pub recordings_auc: f64,
    /// Calibrations, the balanced accuracy of the worst one, and of the best.
    pub calibrations: usize,
    pub balanced_by_calibration: [f64; 2],
    pub recordings: usize,
    /// Of them, those in which nothing slips: each is scored in the calibrations that do not use it.
    pub quiet: usize,
    /// Steps with a verdict.
    pub steps: usize,
}

/// Logits of the steps of one recording. None where the network has nothing to judge by yet.
pub type Logits = Vec<Option<i32>>;

/// A recording in all calibrations that score it.
#[derive(Default)]
struct Own {
    slips: bool,
    right: usize,
    steps: usize,
}

impl Real {
    /// Of what was said in each calibration. None if there is only one kind of recording.
    pub fn of(calibrations: &[Judged]) -> Option<Self> {
        let mut places = BTreeMap::new();
        let (mut all, mut scored, mut whole) = (Vec::<Own>::new(), Vec::new(), Vec::new());
        let mut by_calibration = Vec::new();
        for Judged { recordings, logits, on } in calibrations {
            let mut alone: Vec<Own> = Vec::new();
            for ((recording, logits), &on) in recordings.iter().zip(logits).zip(on) {
                let judged = || {
                    recording
                        .steps
                        .iter()
                        .zip(logits)
                        .filter_map(|(step, logit)| Some((step.slip, (*logit)?)))
                };
                let steps = judged().count();
                let Some(slips) = judged().next().map(|own| own.0) else { continue };
                let right = judged().filter(|&(slip, logit)| (logit >= on) == slip).count();
                let place = *places.entry((&recording.session, &recording.name)).or_insert(all.len());
                if place == all.len() {
                    all.push(Own { slips, ..Own::default() });
                }
                all[place].right += right;
                all[place].steps += steps;
                scored.extend(judged().map(|(slip, logit)| (f64::from(logit), slip, place)));
                whole.push((judged().map(|(_, logit)| f64::from(logit)).sum::<f64>() / steps as f64, slips));
                alone.push(Own { slips, right, steps });
            }
            by_calibration.push(balanced(&alone, &vec![1.0; alone.len()]));
        }
        let of = |slips: bool| -> Vec<usize> { (0..all.len()).filter(|&n| all[n].slips == slips).collect() };
        let kinds = [of(false), of(true)];
        if kinds.iter().any(Vec::is_empty) {
            return None;
        }
        scored.sort_by(|a, b| a.0.total_cmp(&b.0));
        let once = vec![1.0; all.len()];
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut draws = [Vec::new(), Vec::new()];
        for _ in 0..DRAWS {
            let mut weights = vec![0.0; all.len()];
            for kind in &kinds {
                kind.iter().for_each(|_| weights[kind[rng.random_range(0..kind.len())]] += 1.0);
            }
            draws[0].push(balanced(&all, &weights));
            draws[1].push(area(&scored, &weights));
        }
        let [balanced_interval, auc_interval] = draws.map(|mut draws| {
            draws.sort_by(f64::total_cmp);
            INTERVAL.map(|n| draws[n])
        });
        let finite = || by_calibration.iter().copied().filter(|own| own.is_finite());
        Some(Self {
            balanced: balanced(&all, &once),
            balanced_interval,
            auc: area(&scored, &once),
            auc_interval,
            recordings_auc: auc(&mut whole),
            calibrations: calibrations.len(),
            balanced_by_calibration: [finite().fold(1.0, f64::min), finite().fold(0.0, f64::max)],
            recordings: all.len(),
            quiet: kinds[0].len(),
            steps: scored.len(),
        })
    }
}

/// Mean of the parts of the steps of either kind that are right, each recording so many times.
fn balanced(all: &[Own], weights: &[f64]) -> f64 {
    let (mut right, mut of) = ([0.0; 2], [0.0; 2]);
    for (own, weight) in all.iter().zip(weights) {
        right[usize::from(own.slips)] += weight * own.right as f64;
        of[usize::from(own.slips)] += weight * own.steps as f64;
    }
    (right[0] / of[0] + right[1] / of[1]) / 2.0
}

/// Area under the ROC curve: the Mann-Whitney statistic, ties counting half. Sorts them by their score.
pub fn auc(scored: &mut [(f64, bool)]) -> f64 {
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    area(&scored.iter().map(|&(score, slip)| (score, slip, 0)).collect::<Vec<_>>(), &[1.0])
}

/// The same of what is sorted, each step with the weight that its third number is the place of.
fn area(sorted: &[(f64, bool, usize)], weights: &[f64]) -> f64 {
    let (mut below, mut slips, mut won) = (0.0, 0.0, 0.0);
    for tied in sorted.chunk_by(|a, b| a.0 == b.0) {
        let of =
            |kind: bool| -> f64 { tied.iter().filter(|own| own.1 == kind).map(|own| weights[own.2]).sum() };
        let (slip, other) = (of(true), of(false));
        won += slip * (below + other / 2.0);
        below += other;
        slips += slip;
    }
    won / (slips * below)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labelled::{Recording, Step};

    #[test]
    fn the_area_is_the_share_of_pairs_in_order() {
        let mut scored = [(1.0, false), (2.0, true), (2.0, false), (3.0, true)];
        assert!((auc(&mut scored) - 0.875).abs() < 1e-12);
    }

    /// Two quiet recordings, of which each calibration scores the other one, and three that slip; one quiet one is called slip.
    #[test]
    fn each_recording_counts_in_the_calibrations_that_score_it() {
        let recording =
            |name: &str, slip: bool| Recording::of_steps(name, vec![Step { samples: [0; 10], slip }; 10]);
        let judged = |quiet: &str, logit: i32| Judged {
            recordings: [quiet, "a", "b", "c"].map(|name| recording(name, name != quiet)).to_vec(),
            logits: [logit, 5, 6, 7].map(|logit| vec![Some(logit); 10]).to_vec(),
            on: vec![5; 4],
        };
        let real = Real::of(&[judged("t1", 0), judged("t2", 6)]).unwrap();
        assert_eq!((real.calibrations, real.recordings, real.quiet, real.steps), (2, 5, 2, 80));
        assert!((real.balanced - 0.75).abs() < 1e-12 && real.balanced_by_calibration == [0.5, 1.0]);
        // Of its three pairs the quiet recording that is called slip wins one and ties one.
        assert!((real.auc - 4.5 / 6.0).abs() < 1e-12 && (real.recordings_auc - real.auc).abs() < 1e-12);
        assert!(real.balanced_interval == [0.5, 1.0] && real.auc_interval[0] < real.auc);
        assert!(Real::of(&[Judged::default()]).is_none());
    }
}
