//! The hand's motor and fingers.

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{DeadTime, Millimetres, NewtonsMax, Play, Speed};

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Gripper {
    pub speed_mm_s: Speed,
    pub force_n: NewtonsMax,
    pub dead_time_ms: DeadTime,
    pub range_mm: Millimetres,
    pub opening_mm: Spanned<Millimetres>,
    /// The least change of the opening, of a position-controlled gripper; 0 is none.
    pub step_mm: Play,
}
