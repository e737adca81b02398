//! Operating points: the scores of pours at every threshold.

use rayon::prelude::*;
use serde::Serialize;
use tenax_sim::array::Verdicts;
use tenax_sim::array::pour::{Pour, pour};
use tenax_sim::array::real::{Logits, auc};
use tenax_sim::labelled::Recording;
use tenax_sim::scorer::Doing;

/// False steps in 2800 at the curve's points.
const FALSE_2800: [f64; 14] =
    [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 36.0, 60.0, 100.0, 150.0, 200.0, 300.0, 450.0, 700.0];

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Point {
    /// Slip is a logit of at least this.
    pub logit: i32,
    pub recall: f64,
    pub precision: f64,
    pub balanced: f64,
    /// Missed and false steps in 2800.
    pub missed_2800: f64,
    pub false_2800: f64,
    /// Part of the slips with a detection by 50 ms after macro onset.
    pub caught_50ms: f64,
    /// Detections that belong to no slip, an hour.
    pub false_per_hour: f64,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Roc {
    /// Probability that a step that slips has a higher logit than one that does not.
    pub auc: f64,
    /// Mean precision over all recalls; guessing has the prevalence.
    pub average_precision: f64,
    pub best_balanced: Point,
    /// By rising false steps.
    pub points: Vec<Point>,
}

impl Roc {
    /// None where no step of the pours slips, or every one does.
    pub fn of(recordings: &[Recording], logits: &[Logits]) -> Option<Self> {
        let pours: Vec<(&Recording, &Logits)> =
            recordings.iter().zip(logits).filter(|(own, _)| own.doing == Doing::Pour).collect();
        let mut scored: Vec<(f64, bool)> = pours
            .iter()
            .flat_map(|(own, logits)| own.steps.iter().zip(*logits))
            .filter_map(|(step, logit)| Some((f64::from((*logit)?), step.slip)))
            .collect();
        let steps: usize = pours.iter().map(|(own, _)| own.steps.len()).sum();
        let slips = scored.iter().filter(|own| own.1).count();
        if slips == 0 || slips == scored.len() {
            return None;
        }
        let auc = auc(&mut scored);
        // Sorted by that, the lowest logit first.
        let rest: Vec<f64> = scored.iter().rev().filter(|own| !own.1).map(|own| own.0).collect();
        let at = |false_2800: f64| {
            rest.get((false_2800 * steps as f64 / 2_800.0) as usize).map(|&logit| logit as i32 + 1)
        };
        let points: Vec<Point> =
            FALSE_2800.par_iter().filter_map(|&own| at(own)).filter_map(|on| point(&pours, on)).collect();
        let best_balanced =
            points.iter().copied().max_by(|a, b| a.balanced.total_cmp(&b.balanced)).unwrap_or_default();
        Some(Self { auc, average_precision: average_precision(&scored), best_balanced, points })
    }
}

fn point(pours: &[(&Recording, &Logits)], on: i32) -> Option<Point> {
    let said: Vec<Verdicts> = pours
        .iter()
        .map(|(_, logits)| logits.iter().map(|logit| logit.is_some_and(|logit| logit >= on)).collect())
        .collect();
    let judged: Vec<(&Recording, &Verdicts)> = pours.iter().map(|own| own.0).zip(&said).collect();
    let Pour { balanced, prevalence, caught_50ms, false_per_hour, missed_2800, false_2800, .. } =
        pour(&judged)?;
    let right_2800 = 2_800.0 * prevalence - missed_2800;
    let called_2800 = right_2800 + false_2800;
    Some(Point {
        logit: on,
        recall: right_2800 / (2_800.0 * prevalence),
        precision: if called_2800 > 0.0 { right_2800 / called_2800 } else { 1.0 },
        balanced,
        missed_2800,
        false_2800,
        caught_50ms: caught_50ms.unwrap_or_default(),
        false_per_hour,
    })
}

/// The area under precision over recall. `scored` is sorted, the lowest first.
fn average_precision(scored: &[(f64, bool)]) -> f64 {
    let (mut called, mut right, mut sum) = (0.0, 0.0, 0.0);
    for tied in scored.chunk_by(|a, b| a.0 == b.0).rev() {
        let slips = tied.iter().filter(|own| own.1).count() as f64;
        called += tied.len() as f64;
        right += slips;
        sum += slips * right / called;
    }
    if right > 0.0 { sum / right } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_sim::labelled::Step;

    /// A pour that slips in steps 100 to 139, with logits that know it but for noise of `off`.
    fn judged(off: i32) -> (Vec<Recording>, Vec<Logits>) {
        let steps: Vec<Step> =
            (0..400).map(|n| Step { samples: [0; 10], slip: (100..140).contains(&n) }).collect();
        let logits = steps
            .iter()
            .enumerate()
            .map(|(n, step)| Some(if step.slip { 100 } else { 0 } + (n as i32 * 7 % 13 - 6) * off))
            .collect();
        (vec![Recording { doing: Doing::Pour, ..Recording::of_steps("pour", steps) }], vec![logits])
    }

    #[test]
    fn who_knows_has_every_area_and_who_guesses_the_prevalence() {
        let (recordings, logits) = judged(1);
        let knows = Roc::of(&recordings, &logits).unwrap();
        assert!((knows.auc - 1.0).abs() < 1e-12 && (knows.average_precision - 1.0).abs() < 1e-12);
        assert!(knows.points.iter().all(|point| point.recall == 1.0));
        let guesses = vec![vec![Some(0); 400]];
        let guesses = Roc::of(&recordings, &guesses).unwrap();
        assert!((guesses.auc - 0.5).abs() < 1e-12 && (guesses.average_precision - 0.1).abs() < 1e-12);
    }

    #[test]
    fn more_false_steps_are_never_fewer_right_ones() {
        let (recordings, logits) = judged(15);
        let roc = Roc::of(&recordings, &logits).unwrap();
        assert!(roc.points.len() > 5 && roc.auc < 1.0);
        for pair in roc.points.windows(2) {
            assert!(pair[1].recall >= pair[0].recall && pair[1].false_2800 >= pair[0].false_2800, "{pair:?}");
        }
        assert!(roc.best_balanced.balanced >= roc.points[0].balanced);
    }
}
