//! Commands to the board.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use super::Setting;
use crate::behaviour::{Behaviour, CameraView};
use crate::motor::MotorDrive;
use crate::words::Codes;

/// The longest that one [`Down::Drive`] may hold, ms: a lost link stops the motor after that.
pub const DRIVE_HOLD_MAX_MS: u16 = 250;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum Down {
    Ping,
    /// Drive the motor for `hold_ms`, at most [`DRIVE_HOLD_MAX_MS`]; sent again and again while a key is held.
    Drive {
        drive: MotorDrive,
        hold_ms: u16,
    },
    Set(Setting),
    Begin(Behaviour),
    /// Take the force sensor's readings as zero. Refused while the finger is loaded.
    Zero,
    Samples,
    /// Codes of a teacher's picture (v1, v2; Tada 2006, equations 1 and 2). Some 30 times a second.
    Teach {
        codes: Codes,
        age_ms: u16,
    },
    Network,
    Forget,
    /// Save the network's weights now, without waiting for rest.
    Save,
    Get(u8),
    /// Answer with the [`Answer::Settings`](super::Answer::Settings) from this number on, in the order of their numbers.
    Settings(u8),
    Hello,
    /// Open a session with the last [`Answer::Nonce`](super::Answer::Nonce). From here on the numbers of frames only rise.
    Open {
        nonce: u32,
    },
    /// Calibrate the myosensors to the wearer: three prompts of 5 s come up as [`EventKind::Calibration`](super::EventKind::Calibration), then the result.
    /// Meanwhile the muscles move nothing. Refused while something is held.
    CalibrateEmg,
    About,
    /// Stream more messages for `hold_s` seconds; repeat it to go on. Each one replaces the one before.
    Stream {
        /// [`Up::Raw`](super::Up::Raw): every frame as it was sampled, and [`Up::Taken`](super::Up::Taken): every command.
        raw: bool,
        senses: bool,
        hold_s: u16,
    },
    End,
    /// A picture of the camera behind the skin. 30 to 63 times a second.
    View(CameraView),
    /// Answer with an [`Answer::Last`](super::Answer::Last): messages before the last run ended in a fault, from this byte on.
    /// The board keeps them until a client asks from their end on, and so has read all.
    Last(u16),
    /// Setting `n` of a transaction `of` that has `count`. The last one sets all of them; nothing changes before, or if one of them was refused
    /// or did not come in order, or a setting has changed meanwhile.
    SetOf {
        of: u16,
        n: u8,
        count: u8,
        setting: Setting,
    },
}

impl Down {
    /// Whether it only reads: answered without session and consent.
    pub const fn reads(&self) -> bool {
        matches!(
            self,
            Self::Ping
                | Self::Samples
                | Self::Network
                | Self::Get(_)
                | Self::Settings(_)
                | Self::Hello
                | Self::Open { .. }
                | Self::About
                | Self::Stream { .. }
                | Self::Last(_)
        )
    }
}
