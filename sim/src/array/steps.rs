//! Steps of recordings, counted by whether what was said of them is right.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};

use super::Verdicts;
use crate::labelled::{Recording, Step};

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Steps {
    pub steps: usize,
    /// Slipping steps that were not called slip.
    pub missed: usize,
    #[serde(rename = "false")]
    pub false_steps: usize,
    pub accuracy: f64,
    /// Mean of the parts of the slipping and of the other steps that are right.
    pub balanced: f64,
    pub prevalence: f64,
    #[serde(skip)]
    slipped: usize,
}

impl Steps {
    pub fn take(&mut self, steps: &[Step], verdicts: &[bool]) {
        for (step, &said) in steps.iter().zip(verdicts) {
            self.steps += 1;
            self.slipped += usize::from(step.slip);
            self.missed += usize::from(step.slip && !said);
            self.false_steps += usize::from(!step.slip && said);
        }
        let right = |wrong: usize, of: usize| 1.0 - wrong as f64 / of.max(1) as f64;
        self.accuracy = right(self.missed + self.false_steps, self.steps);
        self.prevalence = self.slipped as f64 / self.steps.max(1) as f64;
        // Where there is only one kind of step there is nothing to balance.
        self.balanced = if self.slipped == 0 || self.slipped == self.steps {
            self.accuracy
        } else {
            (right(self.missed, self.slipped) + right(self.false_steps, self.steps - self.slipped)) / 2.0
        };
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct By(pub Vec<(String, Steps)>);

impl By {
    pub fn of<'a>(judged: impl Iterator<Item = (&'a str, &'a Recording, &'a Verdicts)>) -> Self {
        let mut all: BTreeMap<&str, Steps> = BTreeMap::new();
        for (name, recording, verdicts) in judged {
            all.entry(name).or_default().take(&recording.steps, verdicts);
        }
        let mut all: Vec<_> = all.into_iter().map(|(name, steps)| (name.to_owned(), steps)).collect();
        all.sort_by(|(_, a), (_, b)| a.balanced.total_cmp(&b.balanced));
        Self(all)
    }
}

impl Serialize for By {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, steps)| (name, steps)))
    }
}
