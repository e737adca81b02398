//! The two edges of a verdict: the confidence at which slip begins, and the one at which it is over. With one edge for both, a
//! confidence that trembles about it makes one alarm after the other.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::Verdicts;
use super::pour::{Pour, pour};
use crate::labelled::Recording;

const FALSE_PER_HOUR_MAX: f64 = 60.0;
/// False steps in 2800: the paper's 36, less a fifth for sessions that edges are not chosen on.
const FALSE_2800_MAX: f64 = 29.0;
/// Confidences that are tried for the first edge and for the second, per mille.
const ON: std::ops::Range<u16> = 500..1_000;
const OFF: std::ops::Range<u16> = 50..1_000;
const STEP: usize = 25;

/// How confident a detector is in each step of a recording, per mille; None where it has nothing to judge by.
pub type Confidences = Vec<Option<u16>>;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Edges {
    pub on_permille: u16,
    pub off_permille: u16,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Chosen {
    #[serde(flatten)]
    pub edges: Edges,
    pub pour: Pour,
}

/// The edges with the best balanced accuracy below both limits, and their scores. None if there are none.
pub fn choose(pours: &[(&Recording, Confidences)]) -> Option<Chosen> {
    let all: Vec<Edges> = ON
        .step_by(STEP)
        .flat_map(|on_permille| {
            let offs = OFF.step_by(STEP).filter(move |&off| off <= on_permille);
            offs.map(move |off_permille| Edges { on_permille, off_permille })
        })
        .collect();
    let scored = all.par_iter().filter_map(|&edges| Some(Chosen { edges, pour: score(pours, edges)? }));
    let quiet = scored
        .filter(|own| own.pour.false_per_hour <= FALSE_PER_HOUR_MAX && own.pour.false_2800 <= FALSE_2800_MAX);
    quiet.max_by(|a, b| a.pour.balanced.total_cmp(&b.pour.balanced))
}

fn score(pours: &[(&Recording, Confidences)], edges: Edges) -> Option<Pour> {
    let said: Vec<Verdicts> = pours.iter().map(|(_, confidences)| verdicts(confidences, edges)).collect();
    pour(&pours.iter().map(|own| own.0).zip(&said).collect::<Vec<_>>())
}

fn verdicts(confidences: &Confidences, edges: Edges) -> Verdicts {
    let mut slip = false;
    let mut verdict = |confidence: &Option<u16>| {
        let from = if slip { edges.off_permille } else { edges.on_permille };
        slip = confidence.is_some_and(|confidence| confidence >= from);
        slip
    };
    confidences.iter().map(&mut verdict).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labelled::Step;
    use crate::scorer::Doing;

    /// A pour that slips in steps 1000 to 1099 and one false spike, with a confidence that trembles while it slips.
    fn trembling() -> (Recording, Confidences) {
        let steps: Vec<Step> =
            (0..4_800).map(|n| Step { samples: [0; 10], slip: (1_000..1_100).contains(&n) }).collect();
        let of = |n: usize| match n {
            1_000..1_100 if n.is_multiple_of(2) => 900,
            1_000..1_100 => 600,
            _ if n % 100 == 50 => 700,
            _ => 100,
        };
        let confidences = (0..4_800).map(|n| Some(of(n))).collect();
        (Recording { doing: Doing::Pour, ..Recording::of_steps("pour", steps) }, confidences)
    }

    #[test]
    fn two_edges_keep_a_slip_that_one_loses_or_is_loud_with() {
        let (recording, confidences) = trembling();
        let pours = [(&recording, confidences)];
        let Chosen { edges, pour: best } = choose(&pours).unwrap();
        assert!(edges.on_permille > 700 && edges.off_permille <= 600, "{edges:?}");
        assert!((best.balanced - 1.0).abs() < 1e-9 && best.false_per_hour == 0.0, "{best:?}");
        let one = |at| score(&pours, Edges { on_permille: at, off_permille: at }).unwrap();
        assert!(one(800).balanced < 0.76, "half of the steps");
        assert!(one(600).false_per_hour > FALSE_PER_HOUR_MAX, "every spike");
    }
}
