//! Samples on the line: of all channels in one message, and a checksum of the ticks' samples.

use core::fmt;

use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserializer, Serializer};

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
    /// Takes a frame's samples in.
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

/// Writes every channel: serde knows no arrays of more than 32 elements.
pub fn serialize<S: Serializer>(samples: &[u16; COUNT], serializer: S) -> Result<S::Ok, S::Error> {
    let mut tuple = serializer.serialize_tuple(COUNT)?;
    for sample in samples {
        tuple.serialize_element(sample)?;
    }
    tuple.end()
}

/// Reads every channel.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[u16; COUNT], D::Error> {
    struct Samples;
    impl<'de> Visitor<'de> for Samples {
        type Value = [u16; COUNT];

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "{COUNT} samples")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
            let mut samples = [0; COUNT];
            for (index, sample) in samples.iter_mut().enumerate() {
                *sample = seq.next_element()?.ok_or_else(|| A::Error::invalid_length(index, &self))?;
            }
            Ok(samples)
        }
    }
    deserializer.deserialize_tuple(COUNT, Samples)
}
