//! The messages of the serial line, both ways, and the frames that carry them.
//!
//! A frame is `COBS(postcard(version, sequence, message) ++ CRC-32)` and a zero byte. The version and the sequence number
//! come first, so that a receiver of another version can say so, and a receiver that missed frames can count them.
//! Variants are only ever added at the end. The types are the one source: [`SCHEMA`], `python/tenax/wire.json` and Python's decoder
//! follow from them, and a byte that changes asks for a new [`VERSION`] (`tests/wire/golden.rs`).
//!
//! ```
//! use tenax_hal_shim::wire::{Down, FRAME_MAX, Receiver, Setting, encode};
//!
//! let command = Down::Set(Setting { id: 1, value: 120 });
//! let mut buffer = [0; FRAME_MAX];
//! let frame = encode(7, &command, &mut buffer).expect("a frame has room for every message");
//! let mut receiver = Receiver::new();
//! let received = frame.iter().find_map(|&byte| receiver.push::<Down>(byte)).expect("whole").expect("valid");
//! assert_eq!((received.sequence, received.message), (7, command));
//! ```

mod answer;
mod down;
mod framing;
mod raw;
mod samples;
mod slow;
mod tick;
mod up;

use postcard_schema::key::Key;

pub use self::answer::{
    About, Answer, Identity, KEPT_MAX, Last, PIECE_MAX, Refusal, ResetCause, Restored, SETTINGS_MAX,
    SETTINGS_PER_ANSWER, Setting, WHY_MAX,
};
pub use self::down::{DRIVE_HOLD_MAX_MS, Down};
pub use self::framing::{BadFrame, Received, Receiver, encode};
pub use self::raw::{FRAMES_PER_RAW, Raw};
pub use self::samples::SamplesSum;
pub use self::slow::{DETECTORS_MAX, Forces, NETWORK_OUTPUTS, NetworkState, RECEPTORS, Senses, Slow};
pub use self::tick::TickRecord;
pub use self::up::{Counters, Event, EventKind, Up};

/// The version of every message below. A receiver refuses frames of another.
pub const VERSION: u8 = 9;
/// Hash of the names, order and types of all messages. A board and a tool of one version whose
/// hashes differ were built from different sources.
pub const SCHEMA: u64 = u64::from_le_bytes(Key::for_path::<(Up, Down)>("tenax").to_bytes());
/// The serial line's rate, baud, 8N1.
pub const BAUD: u32 = 921_600;
/// The longest frame, bytes, the final zero included: the size of a sender's and a receiver's buffer.
pub const FRAME_MAX: usize = 512;
