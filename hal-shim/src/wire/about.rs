//! Identity of the board, and the records that it restored at its start.

use heapless::Vec;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use super::Setting;
use crate::words::Kept;

pub const SETTINGS_MAX: usize = 64;
pub const KEPT_MAX: usize = 320;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum ResetCause {
    /// Power-up: it was switched on, or the supply came back.
    #[default]
    PowerOn,
    /// Its reset pin: a button or a probe.
    Pin,
    Software,
    /// The image panicked or the core faulted.
    Panic,
    Watchdog,
    Other,
}

/// Chip, image and cause of the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Identity {
    /// The first bytes of the image's build identifier, which the linker makes from its contents. 0: the host's own build.
    pub build: u64,
    /// The chip's unique number. 0: no chip.
    pub chip: [u32; 3],
    pub reset: ResetCause,
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct About {
    pub identity: Identity,
    /// The [`SCHEMA`](super::SCHEMA) that its messages follow.
    pub schema: u64,
    pub frames: u32,
    pub settings: Vec<Setting, SETTINGS_MAX>,
}

/// A record that was restored at this start, as it lies in flash.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Restored {
    pub kept: Kept,
    pub payload: Vec<u8, KEPT_MAX>,
}

impl Restored {
    /// The message of a record; None if it has more bytes than [`KEPT_MAX`].
    pub fn of(kept: Kept, payload: &[u8]) -> Option<Self> {
        Some(Self { kept, payload: Vec::from_slice(payload).ok()? })
    }
}
