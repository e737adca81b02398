//! COBS (Cheshire and Baker 1999): a frame without a zero in it, so that a zero ends it. Each block of up to 254 bytes begins with its
//! length and stands for a zero behind it, but for a full one and the last.
//!
//! postcard's and the crate cobs's index where they have checked before, which is a way to panic, and a palm's frames are decoded in an
//! interrupt.

use postcard::ser_flavors::Flavor;
use postcard::{Error, Result};

/// A block that is full: of 254 bytes, and no zero is behind it.
const FULL: u8 = 0xFF;

/// Encodes the bytes that are pushed as COBS into a buffer. A push fails if the buffer is full.
pub struct Stuffed<'b> {
    buffer: &'b mut [u8],
    length: usize,
    /// Where the block's length goes.
    block: usize,
}

impl<'b> Stuffed<'b> {
    /// Returns an encoder that writes to `buffer`. None if the buffer is empty.
    pub fn new(buffer: &'b mut [u8]) -> Option<Self> {
        (!buffer.is_empty()).then_some(Self { buffer, length: 1, block: 0 })
    }

    fn put(&mut self, byte: u8) -> Result<()> {
        *self.buffer.get_mut(self.length).ok_or(Error::SerializeBufferFull)? = byte;
        self.length += 1;
        Ok(())
    }

    /// Writes the block's length, and the byte behind it, where the next one's comes.
    fn end_block(&mut self) -> Result<()> {
        let length = self.length - self.block;
        *self.buffer.get_mut(self.block).ok_or(Error::SerializeBufferFull)? = length as u8;
        self.block = self.length;
        self.put(0)
    }
}

impl<'b> Flavor for Stuffed<'b> {
    type Output = &'b mut [u8];

    /// Not inlined: every field of every message would carry it, which is 20 kB of flash.
    #[inline(never)]
    fn try_push(&mut self, byte: u8) -> Result<()> {
        if byte == 0 {
            return self.end_block();
        }
        self.put(byte)?;
        if self.length - self.block == usize::from(FULL) { self.end_block() } else { Ok(()) }
    }

    fn finalize(mut self) -> Result<Self::Output> {
        self.end_block()?;
        self.buffer.get_mut(..self.length).ok_or(Error::SerializeBufferFull)
    }
}

/// Decodes COBS in place and returns the decoded bytes. None if a block is longer than the frame.
pub fn unstuff(frame: &mut [u8]) -> Option<&[u8]> {
    let (mut from, mut to) = (0, 0);
    while let Some(&code) = frame.get(from) {
        from += 1;
        for _ in 1..code {
            *frame.get_mut(to)? = *frame.get(from)?;
            from += 1;
            to += 1;
        }
        if code != FULL && from < frame.len() {
            *frame.get_mut(to)? = 0;
            to += 1;
        }
    }
    frame.get(..to)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use postcard::ser_flavors::{Cobs, Slice};
    use std::vec::Vec;

    fn stuffed(bytes: &[u8], room: usize) -> Option<Vec<u8>> {
        let mut buffer = std::vec![0xAA; room];
        let mut own = Stuffed::new(&mut buffer)?;
        own.try_extend(bytes).ok()?;
        own.finalize().ok().map(|frame| frame.to_vec())
    }

    fn by_postcard(bytes: &[u8]) -> Vec<u8> {
        let mut buffer = [0; 600];
        let mut own = Cobs::try_new(Slice::new(&mut buffer)).unwrap();
        own.try_extend(bytes).unwrap();
        own.finalize().unwrap().to_vec()
    }

    #[test]
    fn it_is_postcards_byte_for_byte() {
        for length in (0..=20).chain(250..=260).chain(505..=513) {
            // Without a zero, of zeros, one in three, one at each end.
            let kinds: [fn(usize, usize) -> u8; 5] = [
                |n, _| n as u8 | 1,
                |_, _| 0,
                |n, _| if n.is_multiple_of(3) { 0 } else { 7 },
                |n, _| u8::from(n > 0),
                |n, length| u8::from(n + 1 < length),
            ];
            for kind in kinds {
                let bytes: Vec<u8> = (0..length).map(|n| kind(n, length)).collect();
                let mut expected = by_postcard(&bytes);
                assert_eq!(stuffed(&bytes, 600).as_ref(), Some(&expected));
                assert_eq!(stuffed(&bytes, expected.len()).as_ref(), Some(&expected), "it just fits");
                assert_eq!(stuffed(&bytes, expected.len() - 1), None, "and does not");
                expected.pop();
                assert_eq!(unstuff(&mut expected), Some(&bytes[..]));
            }
        }
    }

    /// Every frame of four bytes out of those that matter, and its judgement by the crate.
    #[test]
    fn what_is_no_frame_is_refused_as_the_crate_does() {
        const CODES: [u8; 6] = [1, 2, 3, 4, 5, FULL];
        for n in 0..6_usize.pow(4) {
            let frame = [0, 1, 2, 3].map(|place| CODES[n / 6_usize.pow(place) % 6]);
            let (mut own, mut other) = (frame, frame);
            let expected = cobs::decode_in_place(&mut other).ok().map(|length| other[..length].to_vec());
            assert_eq!(unstuff(&mut own).map(<[u8]>::to_vec), expected, "{frame:?}");
        }
    }
}
