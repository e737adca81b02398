//! Readings of every sensor, 80 times a second, on request: see [`Down::Stream`](super::Down::Stream).

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use super::samples;
use crate::channel::{COUNT, PVDF_COUNT};

/// The readings at an instant.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Senses {
    /// Sequence number of the last frame in it.
    pub frame: u32,
    /// The last sample of every channel, in the order of [`CHANNELS`](crate::channel::CHANNELS): strain gauges, quadrants,
    /// taxels, myosensors, opening and motor current are as old as their slot.
    #[serde(with = "samples")]
    pub samples: [u16; COUNT],
    /// The vibration envelope of each film, in samples (14 bits).
    pub films: [u16; PVDF_COUNT],
}
