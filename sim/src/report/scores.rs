//! Event scores of a run, by [`crate::scorer`]. A detection is where a detector begins to say slip, or to warn of it, and is
//! believed.

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::wire::Event;

use super::fate::Fate;
use crate::scorer::{Card, Outcome, SlipSpan, Verdict, false_alarms_s, outcome};
use crate::timeline::Timeline;

#[derive(Clone, Debug, Default, Serialize)]
pub struct Slip {
    pub micro_onset_s: Option<f64>,
    pub macro_onset_s: Option<f64>,
    pub caught: Option<bool>,
    /// Detection minus macro onset, ms: negative is early.
    pub latency_ms: Option<f64>,
    pub distance_mm: Option<f64>,
    pub dropped: Option<bool>,
    pub macro_slips: Option<usize>,
    pub macro_slips_caught: Option<usize>,
}

const WARNS: [DetectorId; 1] = [DetectorId::S2];

impl Slip {
    pub fn of(timeline: &Timeline, truth: Option<&Fate>) -> Self {
        let Some(truth) = truth else {
            return Self::default();
        };
        let of_slip = DetectorId::ALL.into_iter().filter(|id| !WARNS.contains(id));
        let verdicts: Vec<Vec<Verdict>> = of_slip.map(|id| timeline.verdicts(id)).collect();
        let macro_slips: Vec<&SlipSpan> =
            truth.slips.iter().filter(|slip| slip.macro_onset_s.is_some() && !slip.meant).collect();
        // Whoever caught it first.
        let latency_s = |slip: &SlipSpan| {
            let onset_s = slip.macro_onset_s?;
            let caught = |verdicts: &Vec<Verdict>| match outcome(slip, onset_s, verdicts) {
                Outcome::Caught(latency_s) => Some(latency_s),
                _ => None,
            };
            verdicts.iter().filter_map(caught).min_by(f64::total_cmp)
        };
        let caught = macro_slips.iter().filter(|slip| latency_s(slip).is_some()).count();
        let first = macro_slips.first().copied();
        Self {
            micro_onset_s: first.map(|slip| slip.micro_onset_s),
            macro_onset_s: first.and_then(|slip| slip.macro_onset_s),
            caught: first.map(|slip| latency_s(slip).is_some()),
            latency_ms: first.and_then(latency_s).map(|s| s * 1e3),
            distance_mm: Some(truth.distance_mm),
            dropped: Some(truth.dropped),
            macro_slips: Some(macro_slips.len()),
            macro_slips_caught: Some(caught),
        }
    }
}

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Detector {
    pub first_s: Option<f64>,
    pub detections: usize,
    /// Detections outside every slip, and not while the wearer moved the hand. Null where the truth is not known.
    pub false_alarms: Option<usize>,
    pub said: usize,
    pub acted: usize,
    /// Event scores: slips by outcome, false alarms by what was going on. Null where the truth is not known.
    pub events: Option<Card>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Gate {
    pub first_s: Option<f64>,
    pub detections: usize,
    pub false_alarms: Option<usize>,
}

#[derive(Clone, Debug, Default)]
pub struct Detectors {
    pub all: Vec<(DetectorId, Detector)>,
    pub wearer: Gate,
}

impl Serialize for Detectors {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.all.len() + 1))?;
        for (id, detector) in &self.all {
            map.serialize_entry(id.name(), detector)?;
        }
        map.serialize_entry("wearer", &self.wearer)?;
        map.end()
    }
}

impl Detectors {
    pub fn of(timeline: &Timeline, events: &[Event], truth: Option<&Fate>) -> Self {
        let wearer = timeline.wearer(events);
        Self {
            all: DetectorId::ALL.map(|id| (id, detector(timeline, id, truth))).into(),
            wearer: Gate { first_s: wearer.first().copied(), detections: wearer.len(), false_alarms: None },
        }
    }

    pub fn of_id(&self, id: DetectorId) -> Detector {
        self.all.iter().find(|(own, _)| *own == id).map_or_else(Detector::default, |(_, own)| own.clone())
    }
}

fn detector(timeline: &Timeline, id: DetectorId, truth: Option<&Fate>) -> Detector {
    let believed = timeline.believed(id);
    let verdicts = timeline.verdicts(id);
    Detector {
        first_s: believed.first().copied(),
        detections: believed.len(),
        false_alarms: truth.map(|truth| false_alarms_s(&truth.slips, &verdicts).len()),
        said: timeline.said(id).len(),
        acted: timeline.acted(id).len(),
        events: truth.map(|truth| Card::of(&truth.slips, &verdicts, &truth.doing)),
    }
}
