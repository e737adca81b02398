//! Who the board is, and what it began with.

use heapless::Vec;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use super::Setting;
use crate::words::Kept;

/// Settings that a message has room for.
pub const SETTINGS_MAX: usize = 64;
/// Bytes of what was kept, at most.
pub const KEPT_MAX: usize = 320;

/// Why the chip started.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum ResetCause {
    /// It was switched on, or the supply came back.
    #[default]
    PowerOn,
    /// Its reset pin: a button or a probe.
    Pin,
    /// By itself, in software.
    Software,
    /// The image panicked or the core faulted.
    Panic,
    /// The watchdog.
    Watchdog,
    /// Something else.
    Other,
}

/// The chip and the image, as they were when it started.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Identity {
    /// The first bytes of the image's build identifier, which the linker makes from its contents. 0: the host's own build.
    pub build: u64,
    /// The chip's unique number. 0: no chip.
    pub chip: [u32; 3],
    /// Why it started.
    pub reset: ResetCause,
}

/// What identifies the board: build, chip, schema of the messages, settings.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct About {
    /// Chip and image.
    pub identity: Identity,
    /// The [`SCHEMA`](super::SCHEMA) that its messages follow.
    pub schema: u64,
    /// Frames since the start.
    pub frames: u32,
    /// Every setting.
    pub settings: Vec<Setting, SETTINGS_MAX>,
}

/// Something that had outlived a power cut and was taken up at this start, as it lies in flash.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Restored {
    /// What.
    pub kept: Kept,
    /// Its bytes.
    pub payload: Vec<u8, KEPT_MAX>,
}

impl Restored {
    /// None of more bytes than [`KEPT_MAX`].
    #[must_use]
    pub fn of(kept: Kept, payload: &[u8]) -> Option<Self> {
        Some(Self { kept, payload: Vec::from_slice(payload).ok()? })
    }
}
