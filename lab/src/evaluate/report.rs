//! The scores, with the keys that other programs read.

use std::collections::BTreeMap;

use serde::Serialize;

use super::draws::Draw;
use super::roc::Roc;
use tenax_sim::array::Verdicts;
use tenax_sim::array::pour::{Pour, card, pour};
use tenax_sim::array::real::Real;
use tenax_sim::array::steps::{By, Steps};
use tenax_sim::labelled::Recording;
use tenax_sim::scorer::{Alarms, Card, Counts, Doing};

/// Slips, counted by [`tenax_sim::scorer`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EventScores {
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

/// The same network without a look-back queue.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Without {
    /// Steps that it missed.
    pub missed: usize,
    /// Steps that it called slip and were none.
    #[serde(rename = "false")]
    pub false_steps: usize,
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
    #[serde(flatten)]
    pub all: Steps,
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
    pub fn new(recordings: &[Recording], said: &[Verdicts], said_without: &[Verdicts]) -> Self {
        let (mut all, mut without) = (Steps::default(), Steps::default());
        for ((recording, said), said_without) in recordings.iter().zip(said).zip(said_without) {
            all.take(&recording.steps, said);
            without.take(&recording.steps, said_without);
        }
        let card = card(recordings.iter().zip(said));
        let judged = || recordings.iter().zip(said);
        Self {
            pour: pour(&judged().filter(|(recording, _)| recording.doing == Doing::Pour).collect::<Vec<_>>()),
            roc: None,
            real: None,
            all,
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
