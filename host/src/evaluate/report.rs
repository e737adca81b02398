//! The scores, with the keys that other programs read.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};

use super::draws::Draw;
use super::real::Real;
use super::roc::Roc;
use super::{Verdicts, events};
use crate::labelled::{Recording, Step};
use crate::scorer::{Alarms, Card, Counts, Doing};

/// Steps, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Steps {
    /// All of them.
    pub steps: usize,
    /// Slipped, and were not called slip.
    pub missed: usize,
    /// Did not slip, and were called slip.
    #[serde(rename = "false")]
    pub false_steps: usize,
    /// Part of them that is right.
    pub accuracy: f64,
    /// Mean of the part of slipping steps that was called slip and the part of the others that was not.
    pub balanced: f64,
    /// Part of them that slipped: who always says 'never' has all the others right.
    pub prevalence: f64,
    #[serde(skip)]
    slipped: usize,
}

impl Steps {
    /// Of one recording.
    #[must_use]
    pub fn of(steps: &[Step], verdicts: &[bool]) -> Self {
        let mut counted = Self::default();
        counted.take(steps, verdicts);
        counted
    }

    /// Adds those of another.
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

/// Slips, counted by [`crate::scorer`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EventScores {
    /// What became of them.
    #[serde(flatten)]
    pub slips: Counts,
    /// Median time from macro onset to the detection, of those caught, ms: negative is early.
    pub latency_ms_p50: Option<f64>,
    /// The time that 95 % of those caught do not exceed, ms.
    pub latency_ms_p95: Option<f64>,
    /// Median time from micro onset to the detection, of those caught, ms.
    pub after_micro_ms_p50: Option<f64>,
}

impl EventScores {
    fn of(card: &Card) -> Self {
        let after_micro = Card { latencies_ms: card.after_micro_ms.clone(), ..Card::default() };
        Self {
            slips: card.slips,
            latency_ms_p50: card.latency_ms(0.50),
            latency_ms_p95: card.latency_ms(0.95),
            after_micro_ms_p50: after_micro.latency_ms(0.50),
        }
    }
}

/// Pours alone: the paper's task.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Pour {
    /// Mean of the part of slipping steps that was called slip and the part of the others that was not.
    pub balanced: f64,
    /// Part of the steps that is right.
    pub accuracy: f64,
    /// Part of the steps that slipped; 1 less this is the accuracy of who always says 'never'.
    pub prevalence: f64,
    /// Part of the macro slips that a detection began in by 50 ms after macro onset. Null if nothing slipped.
    pub caught_50ms: Option<f64>,
    /// Detections that belong to no slip, an hour.
    pub false_per_hour: f64,
    /// Missed steps in 2800 (the paper: 103 with look-back, 162 without).
    pub missed_2800: f64,
    /// False ones in 2800 (the paper: 36 with look-back, 47 without).
    pub false_2800: f64,
    /// Steps.
    pub steps: usize,
    /// Macro slips.
    pub slips: usize,
    /// Those steps by material, the worst first.
    pub by_material: By,
}

/// The same network without a look-back queue.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Without {
    /// Steps that it missed.
    pub missed: usize,
    /// Steps that it called slip and were none.
    #[serde(rename = "false")]
    pub false_steps: usize,
}

/// Scores by what their recordings share, the worst first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct By(pub Vec<(String, Steps)>);

impl By {
    fn of<'a>(judged: impl Iterator<Item = (&'a str, &'a Recording, &'a Verdicts)>) -> Self {
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

/// The report of `tenax evaluate`. Its keys are stable.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Pours alone: the headline. Null if the data has none.
    pub pour: Option<Pour>,
    /// What the network makes of pours at other thresholds. Null if that was not asked.
    pub roc: Option<Roc>,
    /// Recordings of a real array. Null where they are not present.
    pub real: Option<Real>,
    /// Steps of all recordings.
    pub steps: usize,
    /// Those that slipped and were not called slip.
    pub missed: usize,
    /// Those that did not slip and were called slip.
    #[serde(rename = "false")]
    pub false_steps: usize,
    /// Part of them that is right.
    pub accuracy: f64,
    /// Mean of the part of slipping steps that was called slip and the part of the others that was not.
    pub balanced: f64,
    /// Part of them that slipped.
    pub prevalence: f64,
    /// Their slips.
    pub events: EventScores,
    /// Detections that belong to no slip, an hour.
    pub false_per_hour: f64,
    /// The same by what was done in the recordings.
    pub false_by: BTreeMap<Doing, Alarms>,
    /// By material, the worst first.
    pub by_material: By,
    /// By session, the worst first.
    pub by_session: By,
    /// The network without look-back, on the same steps.
    pub without_lookback: Without,
    /// Pours against each quantity that the built-in data set draws, the one that matters most first.
    pub by_draw: Vec<Draw>,
}

impl Report {
    /// Scores what was said of recordings, by a network and by the one without look-back.
    #[must_use]
    pub fn new(recordings: &[Recording], said: &[Verdicts], said_without: &[Verdicts]) -> Self {
        let (mut all, mut without) = (Steps::default(), Steps::default());
        for ((recording, said), said_without) in recordings.iter().zip(said).zip(said_without) {
            all.take(&recording.steps, said);
            without.take(&recording.steps, said_without);
        }
        let card = card(recordings.iter().zip(said));
        let judged = || recordings.iter().zip(said);
        let Steps { steps, missed, false_steps, accuracy, balanced, prevalence, .. } = all;
        Self {
            pour: pour(&judged().filter(|(recording, _)| recording.doing == Doing::Pour).collect::<Vec<_>>()),
            roc: None,
            real: None,
            steps,
            missed,
            false_steps,
            accuracy,
            balanced,
            prevalence,
            events: EventScores::of(&card),
            false_per_hour: card.false_alarms.per_hour,
            false_by: card.false_by,
            by_material: By::of(
                judged().map(|(recording, said)| (recording.material.as_str(), recording, said)),
            ),
            by_session: By::of(
                judged().map(|(recording, said)| (recording.session.as_str(), recording, said)),
            ),
            without_lookback: Without { missed: without.missed, false_steps: without.false_steps },
            by_draw: Vec::new(),
        }
    }
}

fn card<'a>(judged: impl Iterator<Item = (&'a Recording, &'a Verdicts)>) -> Card {
    let mut card = Card::default();
    for (recording, said) in judged {
        card.add(&events::card(recording, said));
    }
    card
}

/// Scores pours. None if there are none.
#[must_use]
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
