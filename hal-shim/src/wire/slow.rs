//! The messages of each slow frame (12.5 ms, 80 a second) with all its decisions; and the network's state.

use heapless::Vec;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use super::{TickRecord, samples};
use crate::behaviour::Behaviour;
use crate::channel::{COUNT, FRAMES_PER_SLOW_FRAME, PVDF_COUNT, STRAIN_COUNT};
use crate::detector::{DetectorId, Evidence};
use crate::words::{Codes, GripMode, Line, NoLesson};

/// Inputs of the network: films, then strain gauges.
pub const RECEPTORS: usize = PVDF_COUNT + STRAIN_COUNT;
pub const NETWORK_OUTPUTS: usize = 2;

/// The force sensor's readings of a slow frame (Prosthesis, section 4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Forces {
    /// Fn of Prosthesis, section 4, mN: `2 sqrt(A^2 + B^2 + C^2 + D^2)`, which is the load only if the quadrants are equal.
    pub fn_mn: i32,
    /// The load, mN: the sum of the quadrants. Ceiling, contact and pulses use it.
    pub load_mn: i32,
    pub fx_mn: i32,
    pub fy_mn: i32,
    /// Shear force Ft, mN, not negative.
    pub ft_mn: i32,
    /// Ft/Fn, per mille. None while the load is below `loaded-mn`, or too few quadrants carry it.
    pub ratio_permille: Option<u16>,
}

impl Forces {
    /// The margin of the grip, mN: S2 x Fn - Ft, the shear that the finger could still carry. None while there is no ratio.
    pub fn margin_mn(&self, s2_permille: u16) -> Option<i32> {
        self.ratio_permille?;
        // A force is below 2^17 mN.
        let bears_mn = self.fn_mn.clamp(0, 1 << 17).unsigned_abs() * u32::from(s2_permille) / 1_000;
        Some(bears_mn as i32 - self.ft_mn)
    }
}

pub const DETECTORS_MAX: usize = 8;

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Slow {
    /// Sequence number of its last frame.
    pub frame: u32,
    pub ticks: [TickRecord; FRAMES_PER_SLOW_FRAME as usize],
    pub mode: GripMode,
    pub forces: Option<Forces>,
    /// Direction of the shear, mrad from x towards y, -3142 to 3142 (Tada 2006: of the slip). None while there is no ratio.
    pub shear_mrad: Option<i16>,
    pub s2_permille: u16,
    /// Envelopes above rest, mV. None while the sensor gives no number.
    pub flexor_mv: Option<i16>,
    pub extensor_mv: Option<i16>,
    /// Whether a myosensor is active, its hold time included.
    pub wearer_active: bool,
    /// Codes that the network is learning. None: no lesson.
    pub lesson: Option<Codes>,
    pub evidence: Vec<(DetectorId, Evidence), DETECTORS_MAX>,
    /// Checksum ([`SamplesSum`](super::SamplesSum)) of every valid sample of the slow frame's ticks, to compare the
    /// input of board and replay.
    pub samples_sum: u32,
    pub line: Line,
    pub behaviour: Option<Behaviour>,
}

/// State of the network (Tada 2006, equations 3 to 6).
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct NetworkState {
    /// Sequence number of the last frame in it.
    pub frame: u32,
    /// Weights, a row for each output; 2^27 is 1.
    pub weights: [[i32; RECEPTORS]; NETWORK_OUTPUTS],
    /// Activations, 2^14 is 1: films 0 to 1, strain gauges -1 to 1.
    pub activations: [i16; RECEPTORS],
    pub updates: u32,
    /// Age of the teacher's newest picture, ms; None before the first.
    pub teacher_age_ms: Option<u16>,
    pub no_lesson: Option<NoLesson>,
}

/// Readings of every sensor, 80 times a second, on request: see [`Down::Stream`](super::Down::Stream).
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Senses {
    pub frame: u32,
    /// The last sample of every channel, in the order of [`CHANNELS`](crate::channel::CHANNELS): strain gauges, quadrants,
    /// taxels, myosensors, opening and motor current are as old as their slot.
    #[serde(with = "samples")]
    pub samples: [u16; COUNT],
    /// The vibration envelope of each film, in samples (14 bits).
    pub films: [u16; PVDF_COUNT],
}
