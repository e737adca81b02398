//! Bootstrap intervals of a median over a few people: people are drawn again, and of each as many sessions, 1,000 times.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use serde::Serialize;

use super::score::{Count, Score};
use super::trial::Kind;

const DRAWS: usize = 1_000;
/// Between which parts of the draws an interval lies.
const PARTS: [f64; 2] = [0.025, 0.975];

#[derive(Clone, Debug)]
pub(in crate::evaluate) struct Sessions(pub Vec<(Kind, Count)>);

impl Sessions {
    fn of(&self, kind: Kind) -> Vec<&Count> {
        self.0.iter().filter(|own| own.0 == kind).map(|own| &own.1).collect()
    }

    pub fn score(&self, kind: Kind) -> Option<Score> {
        Count::sum(self.of(kind)).score()
    }
}

/// Between which two a median lies, each number by itself, with 95 %.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Interval {
    pub low: Score,
    pub high: Score,
}

impl Interval {
    /// The interval of the median over these people; None without people.
    pub(in crate::evaluate) fn of(people: &[Sessions], kind: Kind) -> Option<Self> {
        let people: Vec<Vec<&Count>> =
            people.iter().map(|own| own.of(kind)).filter(|own| !own.is_empty()).collect();
        if people.is_empty() {
            return None;
        }
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut again = || {
            let person = |rng: &mut ChaCha8Rng| {
                let own = &people[rng.random_range(0..people.len())];
                Count::sum((0..own.len()).map(|_| own[rng.random_range(0..own.len())])).score()
            };
            Score::quantile(&(0..people.len()).filter_map(|_| person(&mut rng)).collect::<Vec<_>>(), 0.5)
        };
        let medians: Vec<Score> = (0..DRAWS).filter_map(|_| again()).collect();
        let [low, high] = PARTS.map(|part| Score::quantile(&medians, part));
        Some(Self { low: low?, high: high? })
    }
}
