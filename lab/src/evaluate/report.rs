//! The scores of `tenax evaluate`. Other programs read the keys.

use std::collections::BTreeMap;

use serde::Serialize;
use tenax_frames::quantile::not_exceeded;
use tenax_sim::array::Verdicts;
use tenax_sim::array::pour::{Pour, card, pour};
use tenax_sim::array::real::{self, Logits};
use tenax_sim::array::steps::{By, Steps};
use tenax_sim::labelled::Recording;
use tenax_sim::scorer::{Alarms, Counts, Doing};

/// Slips, counted by [`tenax_sim::scorer`]. Latencies are of those caught, ms; from macro onset, negative is early.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EventScores {
    #[serde(flatten)]
    pub slips: Counts,
    pub latency_ms_p50: Option<f64>,
    pub latency_ms_p95: Option<f64>,
    pub after_micro_ms_p50: Option<f64>,
}

#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Pours alone: the headline. Null without pours.
    pub pour: Option<Pour>,
    /// Probability that a step of a pour that slips has a higher logit than one that does not. Null without both kinds.
    pub auc: Option<f64>,
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
            auc: auc(recordings, logits),
            all,
            events: EventScores {
                slips: card.slips,
                latency_ms_p50: card.latency_ms(0.50),
                latency_ms_p95: card.latency_ms(0.95),
                after_micro_ms_p50: not_exceeded(card.after_micro_ms.iter().copied(), 0.50),
            },
            false_per_hour: card.false_alarms.per_hour,
            false_by: card.false_by,
            by_material: By::of(judged().map(|(own, said)| (own.material.as_str(), own, said))),
            by_session: By::of(judged().map(|(own, said)| (own.session.as_str(), own, said))),
        }
    }
}

fn auc(recordings: &[Recording], logits: &[Logits]) -> Option<f64> {
    let pours = recordings.iter().zip(logits).filter(|(own, _)| own.doing == Doing::Pour);
    let steps = pours.flat_map(|(own, logits)| own.steps.iter().zip(logits));
    let mut scored: Vec<(f64, bool)> =
        steps.filter_map(|(step, logit)| Some((f64::from((*logit)?), step.slip))).collect();
    let slips = scored.iter().filter(|own| own.1).count();
    (0 < slips && slips < scored.len()).then(|| real::auc(&mut scored))
}
