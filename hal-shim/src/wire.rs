//! The messages of the serial line, both ways, and the frames that carry them.
//!
//! A frame is `COBS(postcard(version, sequence, message) ++ CRC-32)` and a zero byte. The version and the sequence number
//! come first, so that a receiver of another version can say so, and a receiver that missed frames can count them.
//! Variants are only ever added at the end. `tests/golden.txt` holds the bytes of one of each: if those change, the
//! version must.
//!
//! ```
//! use tenax_hal_shim::setting::SettingId;
//! use tenax_hal_shim::wire::{Down, FRAME_MAX, Receiver, Setting, encode};
//!
//! let command = Down::Set(Setting { id: SettingId::S1 as u8, value: 120 });
//! let mut buffer = [0; FRAME_MAX];
//! let frame = encode(7, &command, &mut buffer).expect("a frame has room for every message");
//! let mut receiver = Receiver::new();
//! let received = frame.iter().find_map(|&byte| receiver.push::<Down>(byte)).expect("whole").expect("valid");
//! assert_eq!((received.sequence, received.message), (7, command));
//! ```

mod samples;
mod tick;

use crc::{CRC_32_ISO_HDLC, Crc};
use heapless::Vec;
use postcard::de_flavors::crc::from_bytes_u32;
use postcard::ser_flavors::{Cobs, Flavor, Slice, crc::CrcModifier};
use serde::{Deserialize, Serialize, de::DeserializeOwned};

use crate::channel::{COUNT, FRAMES_PER_SLOW_FRAME, PVDF_COUNT, STRAIN_COUNT};
use crate::detector::{DetectorId, Evidence};
use crate::motor::MotorDrive;
use crate::words::{Calibration, Cause, Codes, Consent, Fault, GripMode, Kept, Line, NoLesson};

pub use self::samples::SamplesSum;
pub use self::tick::TickRecord;

/// The version of every message below. A receiver refuses frames of another.
pub const VERSION: u8 = 3;
/// The serial line's rate, baud, 8N1.
pub const BAUD: u32 = 921_600;
/// The longest frame, bytes, the final zero included: what a sender's and a receiver's buffer must hold.
pub const FRAME_MAX: usize = 512;

static CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Inputs of the network: films, then strain gauges.
pub const RECEPTORS: usize = PVDF_COUNT + STRAIN_COUNT;
/// Outputs of the network: relative motion (o1) and direction (o2).
pub const NETWORK_OUTPUTS: usize = 2;

/// The force sensor's readings of a slow frame (Prosthesis, section 4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Forces {
    /// The paper's Fn, mN: see `tenax_logic::forces` for what it is not.
    pub fn_mn: i32,
    /// The load, mN: the sum of the quadrants. What is decided by a force is decided by this.
    pub load_mn: i32,
    /// Shear along x, mN.
    pub fx_mn: i32,
    /// Shear along y, mN.
    pub fy_mn: i32,
    /// Shear, mN.
    pub ft_mn: i32,
    /// Ft/Fn, per mille. None while the finger is not loaded enough for the ratio to mean anything.
    pub ratio_permille: Option<u16>,
}

/// Detectors that a slow frame has room for.
pub const DETECTORS_MAX: usize = 8;

/// Everything a slow frame (12.5 ms) decided.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Slow {
    /// Sequence number of its last frame.
    pub frame: u32,
    /// Its ticks.
    pub ticks: [TickRecord; FRAMES_PER_SLOW_FRAME as usize],
    /// The mode after its last tick.
    pub mode: GripMode,
    /// Forces, None while the force sensor gives no number.
    pub forces: Option<Forces>,
    /// The S2 in force, per mille.
    pub s2_permille: u16,
    /// The flexor's envelope above rest, mV. None while the sensor gives no number.
    pub flexor_mv: Option<i16>,
    /// The extensor's.
    pub extensor_mv: Option<i16>,
    /// Whether a myosensor is active, its hold time included.
    pub wearer_active: bool,
    /// What the network is learning, None while nothing.
    pub lesson: Option<Codes>,
    /// What each detector concluded last, believed or not.
    pub evidence: Vec<(DetectorId, Evidence), DETECTORS_MAX>,
    /// Checksum of every valid sample that the slow frame's ticks were given: the two ends agree on the input too.
    pub samples_sum: u32,
    /// What the serial line may do.
    pub line: Line,
}

/// What the network knows and feels (Tada 2006, equations 3 to 6).
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NetworkState {
    /// Sequence number of the last frame in it.
    pub frame: u32,
    /// Weights, a row for each output; 2^27 is 1.
    pub weights: [[i32; RECEPTORS]; NETWORK_OUTPUTS],
    /// Activations, 2^14 is 1: films 0 to 1, strain gauges -1 to 1.
    pub activations: [i16; RECEPTORS],
    /// Updates of the weights since the network knew nothing.
    pub updates: u32,
    /// Age of the teacher's newest picture, ms; None before the first.
    pub teacher_age_ms: Option<u16>,
    /// Why it is not learning, if it is not.
    pub no_lesson: Option<NoLesson>,
}

/// What the board counted since it was switched on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Frames taken.
    pub frames: u32,
    /// Frames lost.
    pub frames_lost: u32,
    /// Times the converter or its DMA overran and was restarted.
    pub overruns: u32,
    /// Control ticks run.
    pub ticks: u32,
    /// Ticks that ended after the next frame had begun.
    pub ticks_late: u32,
    /// Telemetry messages dropped so as not to delay control.
    pub telemetry_dropped: u32,
    /// Frames received that were no valid message.
    pub bad_frames: u32,
    /// Frames received faster than commands are taken: not looked at, not answered.
    pub commands_skipped: u32,
}

/// Something that happened once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Event {
    /// Sequence number of the frame in which it happened.
    pub frame: u32,
    /// What.
    pub kind: EventKind,
}

/// What can happen once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum EventKind {
    /// The mode changed.
    Mode {
        /// From.
        from: GripMode,
        /// To.
        to: GripMode,
        /// Why.
        cause: Cause,
    },
    /// Something went wrong, or came back.
    Fault(Fault),
    /// A stroke ended with this estimate, from which S2 follows.
    Stroke {
        /// The peak of Ft/Fn before it slid, per mille.
        mu_s_permille: u16,
        /// The new S2, per mille.
        s2_permille: u16,
    },
    /// More events happened in one tick than are kept; this many were lost.
    EventsLost(u16),
    /// Somebody at the hand consented: the line's commands are carried out for a while.
    Armed(Consent),
    /// The consent is over.
    Disarmed,
    /// From here on the line's commands are carried out without consent (true), or with it only (false). Told at the start
    /// if it is so, and when the setting changes.
    LineTrusted(bool),
    /// The calibration of the myosensors goes on, or is over.
    Calibration(Calibration),
    /// From here on the reflex works without myosensors (true), or only with both (false). Told at the start if it is so, and
    /// when the setting changes.
    NoWearer(bool),
}

/// Why a command was not carried out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
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
    /// Only reading is answered before a session is open: see [`Down::Hello`].
    NoSession,
    /// The number of this frame or of this opening was used before.
    Replayed,
    /// The line has held the hand for too long: a muscle, a consent or silence renews it.
    HeldTooLong,
}

/// A setting's number (see [`SettingId`](crate::setting::SettingId)) and its value, in its unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Setting {
    /// Its number.
    pub id: u8,
    /// Its value.
    pub value: i32,
}

/// Settings in one [`Answer::Settings`] at most.
pub const SETTINGS_PER_ANSWER: usize = 16;

/// What a command is answered with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "there is no heap to put the large one on")]
pub enum Answer {
    /// It was carried out.
    Done,
    /// It was not, and nothing has changed.
    Refused(Refusal),
    /// To [`Down::Get`] and [`Down::Set`]: the value that is in force now.
    Setting(Setting),
    /// To [`Down::Settings`]. Fewer than [`SETTINGS_PER_ANSWER`] are the last.
    Settings(Vec<Setting, SETTINGS_PER_ANSWER>),
    /// To [`Down::Samples`]: the last sample of every channel, in the order of
    /// [`CHANNELS`](crate::channel::CHANNELS).
    Samples(#[serde(with = "samples")] [u16; COUNT]),
    /// To [`Down::Network`].
    Network(NetworkState),
    /// To [`Down::Hello`]: what [`Down::Open`] gives back.
    Nonce(u32),
}

/// From the board.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[allow(clippy::large_enum_variant, reason = "there is no heap to put the large one on")]
pub enum Up {
    /// The board has started.
    Hello {
        /// Samples a second on every direct pin.
        frame_hz: u16,
        /// Why it started, if not because it was switched on.
        after: Option<Fault>,
    },
    /// A slow frame.
    Slow(Slow),
    /// Something that happened once.
    Event(Event),
    /// The counters, ten times a second.
    Counters(Counters),
    /// A command was carried out, or was not.
    Answer {
        /// Sequence number of the command's frame.
        of: u16,
        /// Sequence number of the last frame that was taken before the command.
        frame: u32,
        /// The answer.
        answer: Answer,
    },
    /// This outlives a power cut from now on.
    Saved {
        /// Sequence number of the last frame before.
        frame: u32,
        /// What.
        kept: Kept,
    },
}

/// The longest that one [`Down::Drive`] may hold, ms: a lost link stops the motor after that.
pub const DRIVE_HOLD_MAX_MS: u16 = 250;

/// To the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Down {
    /// Answer with [`Answer::Done`].
    Ping,
    /// Drive the motor for `hold_ms`, at most [`DRIVE_HOLD_MAX_MS`]; sent again and again while a key is held.
    Drive {
        /// How.
        drive: MotorDrive,
        /// For how long, ms.
        hold_ms: u16,
    },
    /// Change a setting.
    Set(Setting),
    /// Begin (true) or end (false) a stroke that measures the friction of a surface. It ends by itself after a minute.
    Stroke(bool),
    /// Take the force sensor's readings as zero. Refused while the finger is loaded.
    Zero,
    /// Answer with [`Answer::Samples`].
    Samples,
    /// A teacher's picture: what the object and the hand do (v1, v2). Some 30 times a second.
    Teach {
        /// Relative motion and direction.
        codes: Codes,
        /// Age of the picture that they were made from, ms.
        age_ms: u16,
    },
    /// Answer with [`Answer::Network`].
    Network,
    /// Forget all that the network has learned.
    Forget,
    /// Save what the network has learned now, and not when nothing moves any more.
    Save,
    /// Answer with the [`Answer::Setting`] of this number.
    Get(u8),
    /// Answer with the [`Answer::Settings`] from this number on, in the order of their numbers.
    Settings(u8),
    /// Answer with an [`Answer::Nonce`].
    Hello,
    /// Open a session with the last [`Answer::Nonce`]. From here on the numbers of frames only rise.
    Open {
        /// That number.
        nonce: u32,
    },
    /// Calibrate the myosensors to the wearer: three prompts of 5 s come up as [`EventKind::Calibration`], then the result.
    /// Meanwhile the muscles move nothing. Refused while something is held.
    CalibrateEmg,
}

impl Down {
    /// Whether it only reads: answered without session and consent.
    #[must_use]
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
        )
    }
}

/// A frame's contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Received<T> {
    /// The sender's sequence number.
    pub sequence: u16,
    /// The message.
    pub message: T,
}

/// Why a frame was skipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BadFrame {
    /// Not COBS, or its CRC is wrong, or it is no message.
    Garbled,
    /// Of another version of this protocol.
    Version(u8),
    /// Longer than [`FRAME_MAX`].
    TooLong,
    /// There was no time for it: see [`Receiver::push_if`].
    Skipped,
}

/// Writes `message` as one frame into `buffer`; returns the frame, its zero byte included.
///
/// None if the buffer is too small; [`FRAME_MAX`] bytes are always enough.
pub fn encode<'a, T: Serialize>(sequence: u16, message: &T, buffer: &'a mut [u8]) -> Option<&'a mut [u8]> {
    let cobs = Cobs::try_new(Slice::new(buffer)).ok()?;
    let mut serializer = postcard::Serializer { output: CrcModifier::new(cobs, CRC.digest()) };
    (VERSION, sequence, message).serialize(&mut serializer).ok()?;
    serializer.output.finalize().ok()
}

/// Takes bytes as they come and gives messages. Survives anything; counts nothing itself, says what it skipped.
#[derive(Debug)]
pub struct Receiver {
    buffer: [u8; FRAME_MAX],
    length: usize,
    overlong: bool,
}

impl Default for Receiver {
    fn default() -> Self {
        Self::new()
    }
}

impl Receiver {
    /// One that has heard nothing yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { buffer: [0; FRAME_MAX], length: 0, overlong: false }
    }

    /// Takes one byte. Some when it ends a frame.
    pub fn push<T: DeserializeOwned>(&mut self, byte: u8) -> Option<Result<Received<T>, BadFrame>> {
        self.push_if(byte, || true)
    }

    /// Takes one byte. Some when it ends a frame, which is decoded if there is `time` for it.
    pub fn push_if<T: DeserializeOwned>(
        &mut self,
        byte: u8,
        time: impl FnOnce() -> bool,
    ) -> Option<Result<Received<T>, BadFrame>> {
        if byte != 0 {
            match self.buffer.get_mut(self.length) {
                Some(slot) => {
                    *slot = byte;
                    self.length += 1;
                }
                None => self.overlong = true,
            }
            return None;
        }
        let (length, overlong) = (self.length, self.overlong);
        self.length = 0;
        self.overlong = false;
        if overlong {
            return Some(Err(BadFrame::TooLong));
        }
        // A zero byte on its own is a sender clearing its throat.
        (length > 0).then(|| if time() { decode(&mut self.buffer[..length]) } else { Err(BadFrame::Skipped) })
    }
}

fn decode<T: DeserializeOwned>(bytes: &mut [u8]) -> Result<Received<T>, BadFrame> {
    let length = cobs::decode_in_place(bytes).map_err(|_| BadFrame::Garbled)?;
    let bytes = &bytes[..length];
    let parsed = from_bytes_u32::<(u8, u16, T)>(bytes, CRC.digest());
    match parsed {
        Ok((VERSION, sequence, message)) => Ok(Received { sequence, message }),
        Ok((version, ..)) => Err(BadFrame::Version(version)),
        // A message of another version need not parse, but its CRC still covers its version byte.
        Err(_) => match bytes.split_last_chunk::<4>() {
            Some((body, crc)) if CRC.checksum(body) == u32::from_le_bytes(*crc) => match body.first() {
                Some(&version) if version != VERSION => Err(BadFrame::Version(version)),
                _ => Err(BadFrame::Garbled),
            },
            _ => Err(BadFrame::Garbled),
        },
    }
}
