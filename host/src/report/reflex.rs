//! What the reflex did, and whether there was a reason for it.

use serde::Serialize;
use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::wire::{Event, EventKind, Slow};
use tenax_hal_shim::words::{Cause, DriveSource, GripMode};

use super::fate::Fate;
use crate::board::Recorder;
use crate::timeline::{Timeline, ticks};

/// The force that a pulse added is there after this long, frames: the motor's dead time and the settling.
const SETTLED_FRAMES: u32 = FRAME_HZ * 15 / 100;
/// A pulse that begins this long before a micro onset answers that slip, s: a warning sees it come.
const BEFORE_S: f64 = 0.050;

/// The reflex's part of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Reflex {
    /// Closing pulses that answered slip or a warning of it.
    pub pulses: usize,
    /// Pulses that answered slip where there was none. Null where nobody knows when it slipped.
    pub without_slip: Option<usize>,
    /// Load that the reflex added on a finger, as its force sensor measured it, N.
    pub added_force_n: f64,
}

/// Measures what the reflex adds while a run goes.
#[derive(Clone, Debug, Default)]
pub struct Added {
    load_n: Option<f64>,
    /// The load when the reflex began to close, the greatest since, and the last frame in which it closed.
    episode: Option<(f64, f64, u32)>,
    added_n: f64,
}

impl Recorder for Added {
    fn slow(&mut self, slow: &Slow) {
        let load_n = slow.forces.map(|forces| f64::from(forces.load_mn) / 1e3);
        let last = ticks(slow).filter(|(_, tick)| tick.source == DriveSource::Reflex).last();
        match (last, &mut self.episode) {
            (Some((frame, _)), Some((_, _, closed))) => *closed = frame,
            (Some((frame, _)), None) => {
                self.episode = self.load_n.or(load_n).map(|load_n| (load_n, load_n, frame));
            }
            (None, _) => {}
        }
        self.load_n = load_n.or(self.load_n);
        if let Some((before_n, most_n, closed)) = &mut self.episode {
            *most_n = most_n.max(self.load_n.unwrap_or(0.0));
            if slow.wearer_active || slow.frame > *closed + SETTLED_FRAMES {
                self.added_n += *most_n - *before_n;
                self.episode = None;
            }
        }
    }
}

impl Reflex {
    /// Judges a run.
    #[must_use]
    pub fn of(added: &Added, timeline: &Timeline, events: &[Event], truth: Option<&Fate>) -> Self {
        let pulses = events.iter().filter_map(|event| match event.kind {
            EventKind::Mode { to: GripMode::Slip | GripMode::Incipient, cause, .. } => {
                Some((timeline.time_s(event.frame), cause))
            }
            _ => None,
        });
        let pulses: Vec<(f64, Cause)> = pulses.collect();
        let answers_none = |t_s: f64, truth: &Fate| {
            !truth.slips.iter().any(|slip| {
                slip.macro_onset_s.is_some() && (slip.micro_onset_s - BEFORE_S..=slip.last_s()).contains(&t_s)
            })
        };
        let without = |truth: &Fate| {
            let of_slip = pulses.iter().filter(|(_, cause)| matches!(cause, Cause::Slip(_)));
            of_slip.filter(|(t_s, _)| answers_none(*t_s, truth)).count()
        };
        let running_n = added.episode.map_or(0.0, |(before_n, most_n, _)| most_n - before_n);
        Self {
            pulses: pulses.len(),
            without_slip: truth.map(without),
            added_force_n: added.added_n + running_n,
        }
    }
}

/// What became of the object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Object {
    /// Whether the hand still had it, or let it go on purpose. Null where nobody knows.
    pub kept: Option<bool>,
    /// Whether the hand rose without it.
    pub left_behind: Option<bool>,
    /// Whether another hand has taken it.
    pub handed_over: Option<bool>,
    /// How far it had turned in the hand at the end, degrees.
    pub turned_deg: Option<f64>,
}

impl Object {
    /// Judges a run.
    #[must_use]
    pub fn of(truth: Option<&Fate>) -> Self {
        Self {
            kept: truth.map(|truth| !truth.dropped && !truth.left_behind),
            left_behind: truth.map(|truth| truth.left_behind),
            handed_over: truth.map(|truth| truth.handed_over),
            turned_deg: truth.map(|truth| truth.turned_rad.to_degrees()),
        }
    }
}
