//! The samples of every frame, for recordings: enough to replay every decision bit for bit.
//!
//! Five frames go up in a message, 25 bytes each:
//!
//! | bytes | what |
//! |---|---|
//! | 0 to 20 | the twelve films, 14 bits each, the first in the lowest bits; four take seven bytes, little-endian |
//! | 21 to 24 | little-endian: switch A (bits 13..0), switch B (bits 27..14), bit 28: the frame is valid |

use postcard_schema::Schema;
use postcard_schema::schema::NamedType;
use serde::{Deserialize, Serialize};

use crate::channel::PVDF_COUNT;
use crate::frame::Frame;

/// Frames in a message: a divisor of those in a slow frame.
pub const FRAMES_PER_RAW: usize = 5;
const BYTES: usize = 25;
const BITS: u32 = 14;
/// Mask of a sample's 14 bits. The largest sample is 16 380, four times 4095.
const MASK: u16 = (1 << BITS) - 1;
const VALID: u32 = 1 << 28;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Packed([u8; BYTES]);

impl Default for Packed {
    fn default() -> Self {
        Self([0; BYTES])
    }
}

impl Schema for Packed {
    const SCHEMA: &'static NamedType = &NamedType { name: "frame", ty: <[u8; BYTES]>::SCHEMA.ty };
}

/// Five consecutive frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Raw {
    /// Sequence number of the first.
    pub first: u32,
    frames: [Packed; FRAMES_PER_RAW],
}

impl Raw {
    pub fn put(&mut self, frame: &Frame) {
        let place = frame.sequence as usize % FRAMES_PER_RAW;
        self.first = frame.sequence.wrapping_sub(place as u32);
        self.frames[place] = Packed(pack(frame));
    }

    pub fn frames(&self) -> [Frame; FRAMES_PER_RAW] {
        core::array::from_fn(|place| unpack(self.first.wrapping_add(place as u32), &self.frames[place].0))
    }
}

fn pack(frame: &Frame) -> [u8; BYTES] {
    let mut bytes = [0; BYTES];
    for (bytes, films) in bytes.as_chunks_mut::<7>().0.iter_mut().zip(frame.pvdf.as_chunks::<4>().0) {
        let word = films.iter().rev().fold(0, |word, &film| word << BITS | u64::from(film & MASK));
        bytes.copy_from_slice(&word.to_le_bytes()[..7]);
    }
    let [a, b] = [frame.switch_a, frame.switch_b].map(|sample| u32::from(sample & MASK));
    let word = a | b << BITS | if frame.valid { VALID } else { 0 };
    bytes[BYTES - 4..].copy_from_slice(&word.to_le_bytes());
    bytes
}

fn unpack(sequence: u32, bytes: &[u8; BYTES]) -> Frame {
    let mut pvdf = [0; PVDF_COUNT];
    for (films, bytes) in pvdf.as_chunks_mut::<4>().0.iter_mut().zip(bytes.as_chunks::<7>().0) {
        let mut word = [0; 8];
        word[..7].copy_from_slice(bytes);
        let word = u64::from_le_bytes(word);
        *films = [0, 1, 2, 3].map(|n| (word >> (n * BITS)) as u16 & MASK);
    }
    let mut word = [0; 4];
    word.copy_from_slice(&bytes[BYTES - 4..]);
    let word = u32::from_le_bytes(word);
    Frame {
        sequence,
        valid: word & VALID != 0,
        pvdf,
        switch_a: word as u16 & MASK,
        switch_b: (word >> BITS) as u16 & MASK,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_frame_survives_its_bytes() {
        let mut raw = Raw::default();
        // Odd steps reach every 14-bit sample.
        for round in 0..1_000 {
            let sample = |n: usize| (round as usize * 1_297 + n * 5_101) as u16 & MASK;
            let frames: [Frame; FRAMES_PER_RAW] = core::array::from_fn(|place| Frame {
                pvdf: core::array::from_fn(|film| sample(17 * place + film)),
                switch_a: sample(17 * place + 12),
                switch_b: if place == 0 { MASK } else { sample(17 * place + 13) },
                valid: sample(place).is_multiple_of(2),
                sequence: round * FRAMES_PER_RAW as u32 + place as u32,
            });
            frames.iter().for_each(|frame| raw.put(frame));
            assert_eq!(raw.frames(), frames);
        }
    }
}
