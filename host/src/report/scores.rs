//! Event scores (`docs/glossary.md`): a macro slip is caught if a detection falls between its micro onset and 50 ms after
//! its macro onset; a detection outside every slip is a false alarm. A detection is where a detector begins to say slip, or to
//! warn of it, and is believed.

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::wire::Event;

use super::fate::{Fate, SlipSpan};
use crate::timeline::Timeline;

/// How long after macro onset a detection still catches it, s.
pub const CAUGHT_WITHIN_S: f64 = 0.050;

/// The first macro slip, and the object's fate over the whole run.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Slip {
    /// When some of the contact began to slide, s.
    pub micro_onset_s: Option<f64>,
    /// When all of it did, s.
    pub macro_onset_s: Option<f64>,
    /// Whether any detector caught it.
    pub caught: Option<bool>,
    /// Detection minus macro onset, ms: negative is early.
    pub latency_ms: Option<f64>,
    /// How far the object slid in the whole run, mm.
    pub distance_mm: Option<f64>,
    /// Whether it was dropped.
    pub dropped: Option<bool>,
    /// Macro slips in the whole run that the wearer did not mean.
    pub macro_slips: Option<usize>,
    /// How many of them were caught.
    pub macro_slips_caught: Option<usize>,
}

impl Slip {
    /// Scores a run.
    #[must_use]
    pub fn of(timeline: &Timeline, truth: Option<&Fate>) -> Self {
        let Some(truth) = truth else {
            return Self::default();
        };
        let mut detections = DetectorId::ALL.map(|id| timeline.believed(id)).concat();
        detections.sort_by(f64::total_cmp);
        let macro_slips: Vec<&SlipSpan> =
            truth.slips.iter().filter(|slip| slip.macro_onset_s.is_some()).collect();
        let latency_s = |slip: &SlipSpan| {
            let onset = slip.macro_onset_s?;
            let window = slip.micro_onset_s..=onset + CAUGHT_WITHIN_S;
            detections.iter().find(|t| window.contains(t)).map(|t| t - onset)
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

/// One detector's part.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Detector {
    /// When it was first believed, s.
    pub first_s: Option<f64>,
    /// How often it began to speak and was believed.
    pub detections: usize,
    /// How often that was outside every slip, and not while the wearer moved the hand. Null where nobody knows when it
    /// slipped.
    pub false_alarms: Option<usize>,
    /// How often it began to speak, believed or not.
    pub said: usize,
    /// How often the reflex began to act on it.
    pub acted: usize,
}

/// The myoelectric gate's part; it has no false alarms here, since its truth is not slip.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Gate {
    /// When a muscle first became active, s.
    pub first_s: Option<f64>,
    /// How often one did.
    pub detections: usize,
    /// Never known.
    pub false_alarms: Option<usize>,
}

/// Every detector's.
#[derive(Clone, Debug, Default)]
pub struct Detectors {
    /// Those of slip.
    pub all: Vec<(DetectorId, Detector)>,
    /// The wearer's muscles.
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
    /// Scores a run.
    #[must_use]
    pub fn of(timeline: &Timeline, events: &[Event], truth: Option<&Fate>) -> Self {
        let slips = truth.map(|truth| truth.slips.as_slice());
        let wearer = timeline.wearer(events);
        Self {
            all: DetectorId::ALL.map(|id| (id, detector(timeline, id, slips))).into(),
            wearer: Gate { first_s: wearer.first().copied(), detections: wearer.len(), false_alarms: None },
        }
    }

    /// One of them.
    #[must_use]
    pub fn of_id(&self, id: DetectorId) -> Detector {
        self.all.iter().find(|(own, _)| *own == id).map_or_else(Detector::default, |(_, own)| own.clone())
    }
}

fn detector(timeline: &Timeline, id: DetectorId, slips: Option<&[SlipSpan]>) -> Detector {
    let believed = timeline.believed(id);
    Detector {
        first_s: believed.first().copied(),
        detections: believed.len(),
        false_alarms: slips.map(|slips| outside(&timeline.unmeant(id), slips)),
        said: timeline.said(id).len(),
        acted: timeline.acted(id).len(),
    }
}

/// How many of these instants belong to no slip.
fn outside(detections: &[f64], slips: &[SlipSpan]) -> usize {
    let in_slip = |t: f64| slips.iter().any(|slip| (slip.micro_onset_s..=last_s(slip)).contains(&t));
    detections.iter().filter(|&&t| !in_slip(t)).count()
}

/// Until when a detection belongs to this slip, s.
fn last_s(slip: &SlipSpan) -> f64 {
    slip.macro_onset_s.map_or(slip.end_s, |onset| slip.end_s.max(onset + CAUGHT_WITHIN_S))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLIP: SlipSpan = SlipSpan {
        micro_onset_s: 1.0,
        macro_onset_s: Some(1.1),
        end_s: 1.12,
        distance_mm: 1.0,
        meant: false,
    };

    #[test]
    fn a_detection_belongs_to_a_slip_from_its_micro_onset_to_50_ms_after_its_macro_onset() {
        assert_eq!(outside(&[0.99, 1.0, 1.1499, 1.16], &[SLIP]), 2);
    }
}
