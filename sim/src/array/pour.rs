//! The score of pours, the paper's task.

use serde::Serialize;

use super::steps::{By, Steps};
use super::{Verdicts, events};
use crate::labelled::Recording;
use crate::scorer::Card;

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Pour {
    pub balanced: f64,
    pub accuracy: f64,
    /// Part of the steps that slipped; 1 less this is the accuracy of who always says 'never'.
    pub prevalence: f64,
    /// Part of the macro slips that a detection began in by 50 ms after macro onset. Null if nothing slipped.
    pub caught_50ms: Option<f64>,
    pub false_per_hour: f64,
    /// Missed steps in 2800.
    pub missed_2800: f64,
    /// False ones in 2800.
    pub false_2800: f64,
    pub steps: usize,
    pub slips: usize,
    pub by_material: By,
}

pub fn card<'a>(judged: impl Iterator<Item = (&'a Recording, &'a Verdicts)>) -> Card {
    let mut card = Card::default();
    for (recording, said) in judged {
        card.add(&events::card(recording, said));
    }
    card
}

/// Scores pours. None if there are none.
pub fn pour(judged: &[(&Recording, &Verdicts)]) -> Option<Pour> {
    let mut all = Steps::default();
    for (recording, said) in judged {
        all.take(&recording.steps, said);
    }
    let card = card(judged.iter().copied());
    let per_2800 = |count: usize| 2_800.0 * count as f64 / all.steps.max(1) as f64;
    (all.steps > 0).then(|| Pour {
        balanced: all.balanced,
        accuracy: all.accuracy,
        prevalence: all.prevalence,
        caught_50ms: card.caught_part(),
        false_per_hour: card.false_alarms.per_hour,
        missed_2800: per_2800(all.missed),
        false_2800: per_2800(all.false_steps),
        steps: all.steps,
        slips: card.slips.count,
        by_material: By::of(
            judged.iter().map(|(recording, said)| (recording.material.as_str(), *recording, *said)),
        ),
    })
}
