//! Samples on the line: of all channels in one message, and a checksum of the ticks' samples.

use core::array;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::channel::COUNT;
use crate::frame::Frame;

/// Running checksum over a slow frame's samples, for [`Slow::samples_sum`](super::Slow::samples_sum): Fletcher's two sums, modulo 2^32. It is taken
/// in every tick, where a CRC was worth a tenth of all instructions; the line has its own.
#[derive(Clone, Copy, Debug, Default)]
pub struct SamplesSum {
    sum: u32,
    sum_of_sums: u32,
}

impl SamplesSum {
    pub fn update(&mut self, frame: &Frame) {
        for sample in frame.pvdf {
            self.add(sample);
        }
        self.add(frame.switch_a);
        self.add(frame.switch_b);
    }

    fn add(&mut self, sample: u16) {
        self.sum = self.sum.wrapping_add(u32::from(sample));
        self.sum_of_sums = self.sum_of_sums.wrapping_add(self.sum);
    }

    /// The checksum so far; starts anew.
    pub fn take(&mut self) -> u32 {
        let Self { sum, sum_of_sums } = core::mem::take(self);
        sum_of_sums ^ sum.rotate_left(16)
    }
}

/// serde knows arrays of up to 32 elements; two halves have the same bytes as a whole.
const HALF: usize = COUNT / 2;
const _: () = assert!(COUNT == 2 * HALF);

pub fn serialize<S: Serializer>(samples: &[u16; COUNT], serializer: S) -> Result<S::Ok, S::Error> {
    let half = |first: usize| -> [u16; HALF] { array::from_fn(|n| samples[first + n]) };
    [half(0), half(HALF)].serialize(serializer)
}

pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[u16; COUNT], D::Error> {
    let halves = <[[u16; HALF]; 2]>::deserialize(deserializer)?;
    Ok(array::from_fn(|n| halves[n / HALF][n % HALF]))
}
