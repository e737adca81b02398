//! Answers to commands.

use heapless::Vec;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use super::{About, Last, NetworkState, samples};
use crate::channel::COUNT;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum Refusal {
    OutOfRange {
        min: i32,
        max: i32,
    },
    /// A finger that is loaded cannot be zeroed.
    Loaded,
    /// The sensor that it needs gives no number.
    SensorLost,
    WearerActive,
    /// There is no setting with this number: the board's image is another one.
    UnknownSetting,
    /// The command could move the hand or bears on its safety, and there is no consent.
    NotArmed,
    /// Only reading is answered before a session is open: see [`Down::Hello`](super::Down::Hello).
    NoSession,
    /// The sequence number of this frame, or the nonce of this opening, was used before.
    Replayed,
    /// The line has driven the hand, or silenced the reflex, for too long: an active muscle, consent or waiting as long renews the time.
    HeldTooLong,
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
    /// The command was not carried out, and nothing has changed.
    Refused(Refusal),
    /// To [`Down::Get`](super::Down::Get) and [`Down::Set`](super::Down::Set): the value that is in force now.
    Setting(Setting),
    /// To [`Down::Settings`](super::Down::Settings). Fewer than [`SETTINGS_PER_ANSWER`] are the last.
    Settings(Vec<Setting, SETTINGS_PER_ANSWER>),
    /// To [`Down::Samples`](super::Down::Samples): the last sample of every channel, in the order of
    /// [`CHANNELS`](crate::channel::CHANNELS).
    Samples(#[serde(with = "samples")] [u16; COUNT]),
    /// To [`Down::Network`](super::Down::Network).
    Network(NetworkState),
    /// To [`Down::Hello`](super::Down::Hello): the number that [`Down::Open`](super::Down::Open) must return.
    Nonce(u32),
    /// To [`Down::About`](super::Down::About).
    About(About),
    /// To [`Down::Last`](super::Down::Last).
    Last(Last),
}
