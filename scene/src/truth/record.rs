//! Entries of the log of a world.

use crate::file::sections::Intent;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slip {
    pub micro_onset_s: f64,
    pub macro_onset_s: f64,
    /// When it stuck again or was lost, s. None while it goes on.
    pub end_s: Option<f64>,
    pub distance_mm: f64,
    pub meant: bool,
}

/// Micro slips with no pause longer than [`MICRO_PAUSE_S`](super::MICRO_PAUSE_S) between two of them, which led to no slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MicroRun {
    pub begin_s: f64,
    pub end_s: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    /// None is rest.
    pub intent: Option<Intent>,
    pub begin_s: f64,
    /// To, s. None while it goes on.
    pub end_s: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Activity {
    /// Index in [`CHANNELS`](tenax_hal_shim::channel::CHANNELS).
    pub channel: usize,
    pub on_s: f64,
    /// When it fell under [`MYO_OFF_MV`](super::MYO_OFF_MV), s. None while it is over.
    pub off_s: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    pub t_s: f64,
    pub grip_n: f64,
    pub shear_n: f64,
    pub mass_kg: f64,
    pub position_mm: f64,
    pub slide_mm_s: f64,
    pub sticks: bool,
    pub stuck_part: f64,
    pub pitch_rad: f64,
    /// The least grip force of each finger that would hold at this instant, N; 0 while the hand does not carry.
    pub needed_n: f64,
    pub margin_n: f64,
}
