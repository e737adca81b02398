//! Answers to commands, identity of the board, and what it kept over a reset.

use heapless::Vec;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use super::{NetworkState, samples};
use crate::channel::COUNT;
use crate::words::{Fault, Kept};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Refusal {
    OutOfRange {
        min: i32,
        max: i32,
    },
    Loaded,
    SensorLost,
    WearerActive,
    UnknownSetting,
    /// The command could move the hand or bears on its safety, and there is no consent.
    NotArmed,
    /// Only reading is answered before a session is open: see [`Down::Hello`](super::Down::Hello).
    NoSession,
    /// The sequence number of this frame, or the nonce of this opening, was used before.
    Replayed,
    /// The line has driven the hand, or silenced the reflex, for too long: an active muscle, consent or waiting as long renews the time.
    HeldTooLong,
    /// A setting of the transaction was refused, or one before it is missing: none is set.
    Incomplete,
}

/// A setting's number (`tenax_logic::setting::SettingId`) and its value, in its unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Setting {
    pub id: u8,
    pub value: i32,
}

pub const SETTINGS_PER_ANSWER: usize = 16;

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
#[allow(clippy::large_enum_variant, reason = "there is no heap to put the large one on")]
pub enum Answer {
    Done,
    Refused(Refusal),
    /// To [`Down::Get`](super::Down::Get) and [`Down::Set`](super::Down::Set): the value that is in force now.
    Setting(Setting),
    /// To [`Down::Settings`](super::Down::Settings). Fewer than [`SETTINGS_PER_ANSWER`] are the last.
    Settings(Vec<Setting, SETTINGS_PER_ANSWER>),
    /// To [`Down::Samples`](super::Down::Samples): the last sample of every channel, in the order of
    /// [`CHANNELS`](crate::channel::CHANNELS).
    Samples(#[serde(with = "samples")] [u16; COUNT]),
    Network(NetworkState),
    /// To [`Down::Hello`](super::Down::Hello): the number that [`Down::Open`](super::Down::Open) must return.
    Nonce(u32),
    About(About),
    Last(Last),
}

pub const SETTINGS_MAX: usize = 64;
pub const KEPT_MAX: usize = 320;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum ResetCause {
    #[default]
    PowerOn,
    Pin,
    Software,
    Panic,
    Watchdog,
    Other,
}

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

pub const PIECE_MAX: usize = 256;

pub const WHY_MAX: usize = 48;

/// A piece of the board's last messages before a fault ended its last run.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Last {
    /// The fault. None: nothing is kept.
    pub after: Option<Fault>,
    /// Place of the fault in ASCII: source line of a panic, address of a core fault. Empty: unknown.
    pub why: Vec<u8, WHY_MAX>,
    pub length: u16,
    pub from: u16,
    /// Encoded frames as they went up the line, the oldest first. The oldest of all may lack its beginning.
    pub bytes: Vec<u8, PIECE_MAX>,
}

impl Last {
    pub const fn nothing(from: u16) -> Self {
        Self { after: None, why: Vec::new(), length: 0, from, bytes: Vec::new() }
    }
}
