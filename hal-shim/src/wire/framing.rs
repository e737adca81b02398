//! Frames of the serial line: encoding of messages, and a receiver that skips every bad frame.

use cobs::{DecodeResult, DecoderState};
use crc::{CRC_32_ISO_HDLC, Crc};
use postcard::de_flavors::crc::from_bytes_u32;
use postcard::ser_flavors::{Cobs, Flavor, Slice};
use serde::{Serialize, de::DeserializeOwned};

use super::{FRAME_MAX, VERSION};

static CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Received<T> {
    pub sequence: u16,
    pub message: T,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BadFrame {
    /// Not COBS, or its CRC is wrong, or it is no message.
    Garbled,
    /// A frame of this other version of the protocol.
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
    let mut plain = [0; FRAME_MAX];
    let length = postcard::to_slice(&(VERSION, sequence, message), &mut plain).ok()?.len();
    let crc = CRC.checksum(plain.get(..length)?);
    plain.get_mut(length..length + 4)?.copy_from_slice(&crc.to_le_bytes());
    let mut stuffed = Cobs::try_new(Slice::new(buffer)).ok()?;
    stuffed.try_extend(plain.get(..length + 4)?).ok()?;
    stuffed.finalize().ok()
}

/// Decodes bytes as they come into messages. It skips bad frames and reports each to the caller.
#[derive(Debug)]
pub struct Receiver {
    cobs: DecoderState,
    /// Decoded bytes of the frame so far.
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
    pub const fn new() -> Self {
        Self { cobs: DecoderState::Idle, buffer: [0; FRAME_MAX], length: 0, overlong: false }
    }

    /// Takes one byte. Returns the decoded frame, or why it was skipped, when the byte ends a frame; else None.
    pub fn push<T: DeserializeOwned>(&mut self, byte: u8) -> Option<Result<Received<T>, BadFrame>> {
        self.push_if(byte, || true)
    }

    /// As [`push`](Self::push), but a frame for which `time` says no is not checked and is [`BadFrame::Skipped`].
    pub fn push_if<T: DeserializeOwned>(
        &mut self,
        byte: u8,
        time: impl FnOnce() -> bool,
    ) -> Option<Result<Received<T>, BadFrame>> {
        let fed = self.cobs.feed(byte);
        if byte != 0 {
            if let Ok(DecodeResult::DataContinue(byte)) = fed {
                match self.buffer.get_mut(self.length) {
                    Some(slot) => {
                        *slot = byte;
                        self.length += 1;
                    }
                    None => self.overlong = true,
                }
            }
            return None;
        }
        let length = core::mem::take(&mut self.length);
        if core::mem::take(&mut self.overlong) {
            return Some(Err(BadFrame::TooLong));
        }
        if matches!(fed, Ok(DecodeResult::NoData)) {
            // An empty frame resynchronises the line.
            return None;
        }
        if !time() {
            return Some(Err(BadFrame::Skipped));
        }
        // A block that is cut short is an error.
        Some(fed.ok().and(self.buffer.get(..length)).map_or(Err(BadFrame::Garbled), decode))
    }
}

fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<Received<T>, BadFrame> {
    match from_bytes_u32::<(u8, u16, T)>(bytes, CRC.digest()) {
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
