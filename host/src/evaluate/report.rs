//! The scores, with the keys that other programs read.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};
use tenax_hal_shim::channel::SLOW_HZ;

use super::Verdicts;
use super::events::Events;
use crate::labelled::{Recording, Step};

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
}

impl Steps {
    /// Of one recording.
    #[must_use]
    pub fn of(steps: &[Step], verdicts: &[bool]) -> Self {
        let mut counted = Self::default();
        counted.take(steps, verdicts);
        counted
    }

    fn take(&mut self, steps: &[Step], verdicts: &[bool]) {
        for (step, &said) in steps.iter().zip(verdicts) {
            self.steps += 1;
            self.missed += usize::from(step.slip && !said);
            self.false_steps += usize::from(!step.slip && said);
        }
        let wrong = (self.missed + self.false_steps) as f64;
        self.accuracy = 1.0 - wrong / self.steps.max(1) as f64;
    }
}

/// Slips, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EventScores {
    /// All of them.
    pub count: usize,
    /// Those that were detected within 50 ms of their first step.
    pub caught: usize,
    /// Median time from the first step of a slip to the step that was called slip, ms.
    pub latency_ms_p50: Option<f64>,
    /// The time that 95 % of those caught do not exceed, ms.
    pub latency_ms_p95: Option<f64>,
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
        all.sort_by(|(_, a), (_, b)| a.accuracy.total_cmp(&b.accuracy));
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
    /// Steps of all recordings.
    pub steps: usize,
    /// Those that slipped and were not called slip.
    pub missed: usize,
    /// Those that did not slip and were called slip.
    #[serde(rename = "false")]
    pub false_steps: usize,
    /// Part of them that is right.
    pub accuracy: f64,
    /// Their slips.
    pub events: EventScores,
    /// Detections that belong to no slip, an hour.
    pub false_per_hour: f64,
    /// By material, the worst first.
    pub by_material: By,
    /// By session, the worst first.
    pub by_session: By,
    /// The network without look-back, on the same steps.
    pub without_lookback: Without,
}

impl Report {
    /// Scores what was said of recordings, by the network that ships and by the one without look-back.
    #[must_use]
    pub fn new(recordings: &[Recording], said: &[Verdicts], said_without: &[Verdicts]) -> Self {
        let (mut all, mut without, mut events) = (Steps::default(), Steps::default(), Events::default());
        for ((recording, said), said_without) in recordings.iter().zip(said).zip(said_without) {
            all.take(&recording.steps, said);
            without.take(&recording.steps, said_without);
            events.take(&recording.steps, said);
        }
        let hours = all.steps as f64 / f64::from(SLOW_HZ) / 3_600.0;
        let judged = || recordings.iter().zip(said);
        let Steps { steps, missed, false_steps, accuracy } = all;
        Self {
            steps,
            missed,
            false_steps,
            accuracy,
            events: EventScores {
                count: events.count,
                caught: events.latencies_ms.len(),
                latency_ms_p50: events.latency_ms(0.50),
                latency_ms_p95: events.latency_ms(0.95),
            },
            false_per_hour: if hours > 0.0 { events.false_alarms as f64 / hours } else { 0.0 },
            by_material: By::of(
                judged().map(|(recording, said)| (recording.material.as_str(), recording, said)),
            ),
            by_session: By::of(
                judged().map(|(recording, said)| (recording.session.as_str(), recording, said)),
            ),
            without_lookback: Without { missed: without.missed, false_steps: without.false_steps },
        }
    }
}
