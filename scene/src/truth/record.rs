//! What the log of a world is made of.

use crate::file::sections::Intent;

/// One slip of the object through the fingers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slip {
    /// When the run of micro slips that led to it began, s: the first element that let go, with no pause longer than
    /// [`MICRO_PAUSE_S`](super::MICRO_PAUSE_S) since. With rigid contact (L0) this is the macro onset.
    pub micro_onset_s: f64,
    /// When all of it slid, s.
    pub macro_onset_s: f64,
    /// When it stuck again or was lost, s. None while it goes on.
    pub end_s: Option<f64>,
    pub distance_mm: f64,
    /// Whether the wearer was opening the hand, so that it was meant.
    pub meant: bool,
}

/// Micro slips with no pause longer than [`MICRO_PAUSE_S`](super::MICRO_PAUSE_S) between two of them, which led to no slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MicroRun {
    /// When the first element let go, s.
    pub begin_s: f64,
    /// When the last did, s.
    pub end_s: f64,
}

/// A wish of the wearer, from its first instant to its last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    /// What they wanted; None is rest.
    pub intent: Option<Intent>,
    pub begin_s: f64,
    /// To, s. None while it goes on.
    pub end_s: Option<f64>,
}

/// A myosensor's pin over its threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Activity {
    /// Index in [`CHANNELS`](tenax_hal_shim::channel::CHANNELS).
    pub channel: usize,
    /// When the pin rose over [`MYO_ON_MV`](super::MYO_ON_MV) above rest, s.
    pub on_s: f64,
    /// When it fell under [`MYO_OFF_MV`](super::MYO_OFF_MV), s. None while it is over.
    pub off_s: Option<f64>,
}

/// One row of the trace.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    pub t_s: f64,
    /// Normal force of each finger, N.
    pub grip_n: f64,
    /// Shear on the sensed fingertip, N.
    pub shear_n: f64,
    /// Mass of the object, kg; 0 while a surface is stroked.
    pub mass_kg: f64,
    /// Height of the object over where it stood, mm; while a surface is stroked, the way of the probe.
    pub position_mm: f64,
    /// Speed of the object over the pad, mm/s.
    pub slide_mm_s: f64,
    pub sticks: bool,
    /// The part of the contact's area that sticks.
    pub stuck_part: f64,
    /// How far the object has turned about the pads, rad.
    pub pitch_rad: f64,
    /// The least grip force of each finger that would hold at this instant, N; 0 while the hand does not carry.
    pub needed_n: f64,
    /// The shear that each finger could still carry before it slides, N: friction times grip force above the need. 0 while the
    /// hand does not carry.
    pub margin_n: f64,
}
