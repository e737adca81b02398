//! The scores of `tenax evaluate`. Other programs read the keys.

use std::collections::BTreeMap;

use serde::Serialize;
use tenax_frames::quantile::not_exceeded;
use tenax_sim::array::Verdicts;
use tenax_sim::array::pour::{Pour, card, pour};
use tenax_sim::array::real::Logits;
use tenax_sim::array::steps::{By, Steps};
use tenax_sim::labelled::Recording;
use tenax_sim::scorer::{Alarms, Card, Counts, Doing};

use super::roc::Roc;

/// Slips, counted by [`tenax_sim::scorer`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EventScores {
    #[serde(flatten)]
    pub slips: Counts,
    /// Time from macro onset to the detection, of those caught, ms: negative is early.
    pub latency_ms_p50: Option<f64>,
    pub latency_ms_p95: Option<f64>,
    /// Time from micro onset to the detection, of those caught, ms.
    pub after_micro_ms_p50: Option<f64>,
}

impl EventScores {
    fn of(card: &Card) -> Self {
        Self {
            slips: card.slips,
            latency_ms_p50: card.latency_ms(0.50),
            latency_ms_p95: card.latency_ms(0.95),
            after_micro_ms_p50: not_exceeded(card.after_micro_ms.iter().copied(), 0.50),
        }
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Pours alone: the headline. Null without pours.
    pub pour: Option<Pour>,
    /// Pours at other thresholds. Null without slip.
    pub roc: Option<Roc>,
    /// Steps of all recordings.
    #[serde(flatten)]
    pub all: Steps,
    pub events: EventScores,
    /// Detections that belong to no slip, an hour.
    pub false_per_hour: f64,
    pub false_by: BTreeMap<Doing, Alarms>,
    /// The worst first.
    pub by_material: By,
    pub by_session: By,
}

impl Report {
    pub fn new(recordings: &[Recording], said: &[Verdicts], logits: &[Logits]) -> Self {
        let mut all = Steps::default();
        let judged = || recordings.iter().zip(said);
        judged().for_each(|(recording, said)| all.take(&recording.steps, said));
        let card = card(judged());
        let pours: Vec<_> = judged().filter(|(recording, _)| recording.doing == Doing::Pour).collect();
        Self {
            pour: pour(&pours),
            roc: Roc::of(recordings, logits),
            all,
            events: EventScores::of(&card),
            false_per_hour: card.false_alarms.per_hour,
            false_by: card.false_by,
            by_material: By::of(judged().map(|(own, said)| (own.material.as_str(), own, said))),
            by_session: By::of(judged().map(|(own, said)| (own.session.as_str(), own, said))),
        }
    }
}
