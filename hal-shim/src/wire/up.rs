//! From the board: what it counts, what happens once, and the list of all messages.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use super::{About, Answer, Down, Raw, Restored, Senses, Slow};
use crate::behaviour::{Behaviour, Ending};
use crate::detector::DetectorSet;
use crate::words::{Calibration, Cause, Consent, Fault, GripMode, Kept, MotorStop};

/// Counters of the board since it was switched on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Counters {
    pub frames: u32,
    pub frames_lost: u32,
    pub overruns: u32,
    pub ticks: u32,
    /// Ticks that ended after the next frame had begun.
    pub ticks_late: u32,
    /// Telemetry messages dropped so as not to delay control.
    pub telemetry_dropped: u32,
    pub bad_frames: u32,
    /// Received frames that exceeded 500 commands a second: neither executed nor answered.
    pub commands_skipped: u32,
    /// The longest time that a frame took control, from its last code to the end of everything it caused, us.
    pub control_us_max: u32,
    /// The part of the core's time that control took since the counters before, per mille. What the serial line's tasks take
    /// is not in it.
    pub control_permille: u16,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Event {
    pub frame: u32,
    pub kind: EventKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum EventKind {
    Mode {
        from: GripMode,
        to: GripMode,
        cause: Cause,
    },
    Fault(Fault),
    /// A stroke ended with this estimate, from which S2 follows.
    Stroke {
        /// The peak of Ft/Fn before it slid, per mille.
        mu_s_permille: u16,
        s2_permille: u16,
    },
    /// More events happened in one tick than are kept; this many were lost.
    EventsLost(u16),
    /// Consent was given at the hand: the line's commands are carried out for a while.
    Armed(Consent),
    Disarmed,
    /// From here on the line's commands are carried out without consent (true), or with it only (false). Told at the start
    /// if it is so, and when the setting changes.
    LineTrusted(bool),
    Calibration(Calibration),
    /// From here on the reflex works without myosensors (true), or only with both (false). Told at the start if it is so, and
    /// when the setting changes.
    NoWearer(bool),
    Behaviour(Behaviour, Option<Ending>),
    /// The motor is stopped, for this reason, or may be driven again (None).
    Motor(Option<MotorStop>),
    Pulse {
        /// The margin of the last slow frame, mN ([`Forces::margin_mn`](super::Forces::margin_mn)). None where there was no ratio.
        margin_mn: Option<i32>,
        said: DetectorSet,
        believed: DetectorSet,
    },
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
#[allow(clippy::large_enum_variant, reason = "there is no heap to put the large one on")]
pub enum Up {
    Hello {
        frame_hz: u16,
        /// The fault that ended the run before. None: it was switched on.
        after: Option<Fault>,
    },
    Slow(Slow),
    Event(Event),
    Counters(Counters),
    Answer {
        of: u16,
        /// Sequence number of the last frame that was taken before the command.
        frame: u32,
        answer: Answer,
    },
    Saved {
        frame: u32,
        kept: Kept,
    },
    /// The board's identity and settings; sent once at the start, after `Hello`.
    About(About),
    /// A record that was read from flash; sent at the start if `stream-at-start-flag` is 1. With it and every later
    /// [`Raw`] and [`Taken`](Self::Taken), a replay repeats the decisions.
    Restored(Restored),
    /// Frames as they were sampled: see [`Down::Stream`](super::Down::Stream).
    Raw(Raw),
    /// Readings of every sensor: see [`Down::Stream`](super::Down::Stream).
    Senses(Senses),
    /// A command, before its answer, while frames are streamed.
    Taken {
        /// Sequence number of the first frame whose tick knows the command.
        before: u32,
        of: u16,
        command: Down,
    },
}
