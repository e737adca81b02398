//! Recordings of a real array beside the scenes: what scenes cannot show.

use serde::Serialize;

use crate::labelled::Recording;

/// How a network does on recordings of a real array, each of which slips as a whole or not at all.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Real {
    /// Mean, over steps, of the part of slipping ones that was called slip and the part of the others that was not.
    pub balanced: f64,
    /// Probability that a step that slips has a higher logit than one that does not.
    pub auc: f64,
    /// The same of whole recordings by their mean logits.
    pub recordings_auc: f64,
    pub recordings: usize,
    /// Steps with a verdict.
    pub steps: usize,
}

/// Logits of the steps of one recording. None where the network has nothing to judge by yet.
pub type Logits = Vec<Option<i32>>;

impl Real {
    /// Of what was said; slip is a logit of at least `on`. None if there is only one kind of recording.
    pub fn of(recordings: &[Recording], logits: &[Logits], on: &[i32]) -> Option<Self> {
        let (mut steps, mut whole) = (Vec::new(), Vec::new());
        let (mut right, mut of) = ([0_usize; 2], [0_usize; 2]);
        for ((recording, logits), &on) in recordings.iter().zip(logits).zip(on) {
            let mut sum = (0.0, 0);
            for (step, logit) in recording.steps.iter().zip(logits) {
                let Some(logit) = *logit else { continue };
                let slip = usize::from(step.slip);
                of[slip] += 1;
                right[slip] += usize::from((logit >= on) == step.slip);
                steps.push((f64::from(logit), step.slip));
                sum = (sum.0 + f64::from(logit), sum.1 + 1);
            }
            if let (Some(step), true) = (recording.steps.first(), sum.1 > 0) {
                whole.push((sum.0 / f64::from(sum.1), step.slip));
            }
        }
        (of[0] > 0 && of[1] > 0).then(|| Self {
            balanced: (right[0] as f64 / of[0] as f64 + right[1] as f64 / of[1] as f64) / 2.0,
            auc: auc(&mut steps),
            recordings_auc: auc(&mut whole),
            recordings: whole.len(),
            steps: steps.len(),
        })
    }
}

/// Area under the ROC curve: the Mann-Whitney statistic, ties counting half. Sorts them by their score.
pub fn auc(scored: &mut [(f64, bool)]) -> f64 {
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    let slips = scored.iter().filter(|scored| scored.1).count() as f64;
    let rest = scored.len() as f64 - slips;
    let (mut below, mut won) = (0.0, 0.0);
    for tied in scored.chunk_by(|a, b| a.0 == b.0) {
        let slip = tied.iter().filter(|scored| scored.1).count() as f64;
        let other = tied.len() as f64 - slip;
        won += slip * (below + other / 2.0);
        below += other;
    }
    won / (slips * rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_area_is_the_share_of_pairs_in_order() {
        let mut scored = [(1.0, false), (2.0, true), (2.0, false), (3.0, true)];
        assert!((auc(&mut scored) - 0.875).abs() < 1e-12);
    }
}
