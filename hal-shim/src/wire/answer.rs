//! What commands are answered with.

use heapless::Vec;
use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use super::{About, Last, NetworkState, samples};
use crate::channel::COUNT;

/// Why a command was not carried out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum Refusal {
    /// The value is outside this range.
    OutOfRange {
        /// The lowest value that is accepted.
        min: i32,
        /// The highest.
        max: i32,
    },
    /// A finger that is loaded cannot be zeroed.
    Loaded,
    /// The sensor that it needs gives no number.
    SensorLost,
    /// Not while the wearer's muscles are active.
    WearerActive,
    /// There is no setting with this number: the board's image is another one.
    UnknownSetting,
    /// It could move the hand or bears on its safety, and nobody at the hand has consented.
    NotArmed,
    /// Only reading is answered before a session is open: see [`Down::Hello`](super::Down::Hello).
    NoSession,
    /// The number of this frame or of this opening was used before.
    Replayed,
    /// The line has held the hand for too long: a muscle, a consent or silence renews it.
    HeldTooLong,
}

/// A setting's number (`tenax_logic::setting::SettingId`) and its value, in its unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Setting {
    /// The setting's number.
    pub id: u8,
    /// Its value, in the unit of its name.
    pub value: i32,
}

/// Settings in one [`Answer::Settings`] at most.
pub const SETTINGS_PER_ANSWER: usize = 16;

/// What a command is answered with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
#[allow(clippy::large_enum_variant, reason = "there is no heap to put the large one on")]
pub enum Answer {
    /// It was carried out.
    Done,
    /// It was not, and nothing has changed.
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
    /// To [`Down::Hello`](super::Down::Hello): what [`Down::Open`](super::Down::Open) gives back.
    Nonce(u32),
    /// To [`Down::About`](super::Down::About).
    About(About),
    /// To [`Down::Last`](super::Down::Last).
    Last(Last),
}
