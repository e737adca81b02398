//! Bytes of the network that survive a power cut. A restored network gives the same outputs bit for bit.
//!
//! ```text
//! 0  version         1  inputs        2  outputs        3  0
//! 4  maxima          u32 each, little-endian, raw units
//!    weights         i32 Q27 each, little-endian, a row for each output
//!    more            u32, little-endian: one word that is no weight
//!    CRC-32          u32, little-endian, of everything before it (the wire's: ISO-HDLC)
//! ```

use super::activations::{Normaliser, NormaliserConfig};
use super::network::{Network, Weight};
use crate::checksum::CRC;

pub const VERSION: u8 = 2;
const HEADER: usize = 4;
const WORD: usize = 4;

pub const fn length(inputs: usize, outputs: usize) -> usize {
    HEADER + WORD * (inputs + inputs * outputs + 2)
}

/// A network has at most 62 inputs; the outputs' count only has to differ for another shape.
const fn header_of<const I: usize, const O: usize>() -> [u8; HEADER] {
    [VERSION, I as u8, O as u8, 0]
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contents<const I: usize, const O: usize> {
    maxima: [u32; I],
    weights: [[Weight; I]; O],
    more: u32,
}

impl<const I: usize, const O: usize> Contents<I, O> {
    pub fn of(normaliser: &Normaliser<I>, network: &Network<I, O>, more: u32) -> Self {
        Self { maxima: normaliser.maxima(), weights: network.weights(), more }
    }

    pub fn write<'a>(&self, buffer: &'a mut [u8]) -> Option<&'a [u8]> {
        let snapshot = buffer.get_mut(..length(I, O))?;
        let (body, crc) = snapshot.split_last_chunk_mut::<WORD>()?;
        let (header, words) = body.split_first_chunk_mut::<HEADER>()?;
        *header = header_of::<I, O>();
        let maxima = self.maxima.map(u32::to_le_bytes);
        let weights = self.weights.map(|row| row.map(|weight| weight.into_bits().to_le_bytes()));
        let (slots, _) = words.as_chunks_mut::<WORD>();
        let more = [self.more.to_le_bytes()];
        for (slot, word) in slots.iter_mut().zip(maxima.iter().chain(weights.as_flattened()).chain(&more)) {
            *slot = *word;
        }
        *crc = CRC.checksum(body).to_le_bytes();
        Some(snapshot)
    }
}

pub fn restore<const I: usize, const O: usize>(
    config: &NormaliserConfig<I>,
    snapshot: &[u8],
) -> Option<(Normaliser<I>, Network<I, O>, u32)> {
    let (body, crc) = snapshot.split_last_chunk::<WORD>()?;
    let (header, words) = body.split_first_chunk::<HEADER>()?;
    let is_whole = CRC.checksum(body) == u32::from_le_bytes(*crc);
    if !is_whole || *header != header_of::<I, O>() || snapshot.len() != length(I, O) {
        return None;
    }
    let mut maxima = [0; I];
    let mut weights = [[Weight::default(); I]; O];
    let (slots, _) = words.as_chunks::<WORD>();
    let (maxima_slots, rest) = slots.split_at(I);
    let (weight_slots, more_slots) = rest.split_at(I * O);
    let more = more_slots.first().map_or(0, |slot| u32::from_le_bytes(*slot));
    for (largest, slot) in maxima.iter_mut().zip(maxima_slots) {
        *largest = u32::from_le_bytes(*slot);
    }
    for (weight, slot) in weights.as_flattened_mut().iter_mut().zip(weight_slots) {
        *weight = Weight::from_bits(i32::from_le_bytes(*slot));
    }
    Some((Normaliser::from_maxima(config, &maxima), Network::from_weights(&weights), more))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hebbian::Code;
    use crate::hebbian::activations::{Activation, Activations, Sense};
    use crate::hebbian::rule::{Config, Rule};

    const LENGTH: usize = length(3, 2);
    const CONFIG: NormaliserConfig<3> = NormaliserConfig {
        senses: [Sense::Pressure; 3],
        floors: [10; 3],
        ceiling: 1 << 20,
        average_shift: 0,
    };

    fn learned() -> (Normaliser<3>, Network<3, 2>, [u8; LENGTH]) {
        let mut normaliser = Normaliser::new(&CONFIG);
        normaliser.observe(&CONFIG, &[5, -7_000, 123_456]);
        let mut network = Network::default();
        let rule = Rule::of(&Config::default());
        let t = Activations::new([0.3, -0.7, 1.0].map(Activation::from_f64));
        for _ in 0..1_000 {
            network.learn(&rule, &t, &[Some(Code::Minus), Some(Code::Plus)]);
        }
        let mut bytes = [0; LENGTH];
        assert!(Contents::of(&normaliser, &network, 77).write(&mut bytes).is_some());
        (normaliser, network, bytes)
    }

    fn resealed(mut bytes: [u8; LENGTH]) -> [u8; LENGTH] {
        let (body, crc) = bytes.split_last_chunk_mut::<WORD>().unwrap();
        *crc = CRC.checksum(body).to_le_bytes();
        bytes
    }

    #[test]
    fn what_comes_back_gives_the_same_outputs() {
        let (normaliser, network, bytes) = learned();
        let (normaliser_back, network_back, more) = restore::<3, 2>(&CONFIG, &bytes).unwrap();
        assert_eq!(normaliser_back.maxima(), normaliser.maxima());
        assert_eq!(network_back.weights(), network.weights());
        assert_ne!(network.weights(), Network::<3, 2>::default().weights());
        let mut again = [0; LENGTH];
        assert_eq!(Contents::of(&normaliser_back, &network_back, more).write(&mut again), Some(&bytes[..]));
    }

    #[test]
    fn every_damaged_bit_and_every_other_network_is_refused() {
        let (normaliser, network, bytes) = learned();
        for bit in 0..8 * LENGTH {
            let mut damaged = bytes;
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert!(restore::<3, 2>(&CONFIG, &damaged).is_none(), "bit {bit}");
        }
        for length in 0..LENGTH {
            assert!(restore::<3, 2>(&CONFIG, &bytes[..length]).is_none(), "{length} bytes");
        }
        for (at, other) in [(0, VERSION - 1), (1, 4), (2, 1)] {
            let mut bytes = bytes;
            bytes[at] = other;
            assert!(restore::<3, 2>(&CONFIG, &resealed(bytes)).is_none(), "byte {at}");
        }
        assert_eq!(Contents::of(&normaliser, &network, 77).write(&mut [0; LENGTH - 1]), None);
    }

    #[test]
    fn sealed_nonsense_is_brought_into_range() {
        let (.., mut bytes) = learned();
        bytes[4..LENGTH - WORD].fill(0xFF);
        bytes[LENGTH - 3 * WORD..LENGTH - 2 * WORD].copy_from_slice(&i32::MIN.to_le_bytes());
        let (normaliser, network, _) = restore::<3, 2>(&CONFIG, &resealed(bytes)).unwrap();
        assert_eq!(normaliser.maxima(), [CONFIG.ceiling; 3]);
        assert_eq!(network.weights()[1][2].into_bits(), -(1 << 30));
    }
}
