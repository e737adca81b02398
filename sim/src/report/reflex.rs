//! What the reflex did, and whether there was a reason for it.

use serde::Serialize;
use tenax_hal_shim::wire::{Event, EventKind};
use tenax_hal_shim::words::GripMode;

use super::added::{Added, BEFORE_S, Sums};
use super::fate::Fate;
use crate::scorer::SlipSpan;
use crate::timeline::Timeline;

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Reflex {
    pub pulses: usize,
    /// Those of them that began where nothing slipped, a warning's too. Null where nobody knows when it slipped.
    pub without_slip: Option<usize>,
    #[serde(flatten)]
    pub sums: Sums,
}

impl Reflex {
    pub fn of(added: &Added, timeline: &Timeline, events: &[Event], truth: Option<&Fate>) -> Self {
        let pulses = events.iter().filter_map(|event| match event.kind {
            EventKind::Mode { to: GripMode::Slip | GripMode::Incipient, .. } => {
                Some(timeline.time_s(event.frame))
            }
            _ => None,
        });
        let pulses: Vec<f64> = pulses.collect();
        let answers = |t_s: f64, slip: &SlipSpan| {
            slip.macro_onset_s.is_some() && (slip.micro_onset_s - BEFORE_S..=slip.last_s()).contains(&t_s)
        };
        let without = |truth: &Fate| {
            pulses.iter().filter(|&&t_s| !truth.slips.iter().any(|slip| answers(t_s, slip))).count()
        };
        Self { pulses: pulses.len(), without_slip: truth.map(without), sums: added.sums(truth) }
    }
}

/// The margin of the grip: the shear that a finger could still carry before the object slides, mN.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Margin {
    /// The true one's least while the hand carried the object. Null where nobody knows it.
    pub least_mn: Option<f64>,
    pub last_mn: Option<f64>,
}

impl Margin {
    pub fn of(truth: Option<&Fate>) -> Self {
        let margin_mn = truth.and_then(|truth| truth.margin_n).map(|both| both.map(|n| n * 1e3));
        Self { least_mn: margin_mn.map(|[least, _]| least), last_mn: margin_mn.map(|[_, last]| last) }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Object {
    /// Whether the hand still had it, or let it go on purpose. Null where nobody knows.
    pub kept: Option<bool>,
    pub left_behind: Option<bool>,
    pub handed_over: Option<bool>,
    pub turned_deg: Option<f64>,
}

impl Object {
    pub fn of(truth: Option<&Fate>) -> Self {
        Self {
            kept: truth.map(Fate::kept),
            left_behind: truth.map(|truth| truth.left_behind),
            handed_over: truth.map(|truth| truth.handed_over),
            turned_deg: truth.map(|truth| truth.turned_rad.to_degrees()),
        }
    }
}
