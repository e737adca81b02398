//! Frames of the serial line: encoding of messages, and a receiver that skips every bad frame.

use crc::{CRC_32_ISO_HDLC, Crc};
use postcard::de_flavors::crc::from_bytes_u32;
use postcard::ser_flavors::{Flavor, crc::CrcModifier};
use serde::{Serialize, de::DeserializeOwned};

use super::stuffing::{Stuffed, unstuff};
use super::{FRAME_MAX, VERSION};

static CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

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
    let mut serializer =
        postcard::Serializer { output: CrcModifier::new(Stuffed::new(buffer)?, CRC.digest()) };
    (VERSION, sequence, message).serialize(&mut serializer).ok()?;
    serializer.output.finalize().ok()
}

/// Decodes bytes as they come into messages. It skips bad frames and reports each to the caller.
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
    /// A receiver without any bytes.
    pub const fn new() -> Self {
        Self { buffer: [0; FRAME_MAX], length: 0, overlong: false }
    }

    /// Takes one byte. Returns the decoded frame, or why it was skipped, when the byte ends a frame; else None.
    pub fn push<T: DeserializeOwned>(&mut self, byte: u8) -> Option<Result<Received<T>, BadFrame>> {
        self.push_if(byte, || true)
    }

    /// Takes one byte. Returns the decoded frame, or why it was skipped, when the byte ends a frame; else None. If
    /// `time` says no, the frame is not decoded and is [`BadFrame::Skipped`].
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
        let frame = self.buffer.get_mut(..length).filter(|frame| !frame.is_empty())?;
        Some(if time() { decode(frame) } else { Err(BadFrame::Skipped) })
    }
}

fn decode<T: DeserializeOwned>(bytes: &mut [u8]) -> Result<Received<T>, BadFrame> {
    let bytes = unstuff(bytes).ok_or(BadFrame::Garbled)?;
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
