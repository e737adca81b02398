//! The hand's motor and fingers.

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{DeadTime, Millimetres, NewtonsMax, Play, Speed};

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Gripper {
    /// Fastest change of the opening.
    pub speed_mm_s: Speed,
    /// Force at which a finger stalls under the whole supply.
    pub force_n: NewtonsMax,
    /// From drive to motion, and from coast to rest.
    pub dead_time_ms: DeadTime,
    /// The widest opening.
    pub range_mm: Millimetres,
    /// The opening at the start.
    pub opening_mm: Spanned<Millimetres>,
    /// The least change of the opening, of a position-controlled gripper; 0 is none.
    pub step_mm: Play,
}
