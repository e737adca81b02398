//! The words of the bus. Their frames are those of the serial line: `COBS(version, sequence, address, word, CRC-32)` and a zero byte.

use heapless::Vec;
use serde::{Deserialize, Serialize};
use tenax_hal_shim::detector::DetectorSet;

/// Fingers of a hand, at most.
pub const FINGERS_MAX: usize = 5;
/// The bus's rate, baud, 8N1: 100 MHz over 20.
pub const BAUD: u32 = 5_000_000;
/// Bytes of a finger's own line that a poll carries down, and its answer up. 500 polls a second give 26 kB/s up, where a finger that
/// streams nothing says 16; what it says in motion beyond that waits.
pub const LINE_DOWN: usize = 12;
/// See [`LINE_DOWN`].
pub const LINE_UP: usize = 52;
/// The longest frame of the bus, bytes.
pub const FRAME_MAX: usize = 108;
/// Everybody's address.
pub const ALL: u8 = 0;
/// A finger is polled every so many us.
pub const CYCLE_US: u32 = 2_000;
/// Polls in a row without an answer, after which a finger is lost; a finger that misses as many forgets what the palm wishes.
pub const MISSED_MAX: u8 = 3;
/// An answer begins so late at most, us: 5500 instructions at 1.5 cycles each, a control tick that comes between, and its interrupt.
pub const BEGINS_US: u32 = 190;
/// Places in time in which fingers without an address answer, at most, and the length of one, us: a frame and its jitter.
pub const CLAIM_SLOTS: u8 = 4;
/// See [`CLAIM_SLOTS`].
pub const CLAIM_SLOT_US: u32 = 120;

/// A chip's unique number.
pub type Chip = [u32; 3];

/// What goes over the bus: whose it is, and what.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Packet {
    /// The finger that is asked, or that answers. [`ALL`] for all, or a finger without one.
    pub address: u8,
    /// What is said.
    pub word: Word,
}

/// Both directions in one list: a finger hears its neighbours' answers and cannot take one for a question.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Word {
    /// The palm asks who has no address. Each chip answers in another slot in each round.
    Claim {
        /// Number of the round.
        round: u8,
        /// How many slots it has.
        slots: u8,
    },
    /// A finger without an address, or without a session, answers with a number of its own.
    Here {
        /// Who.
        chip: Chip,
        /// What opens a session with it.
        nonce: u32,
    },
    /// The palm gives the packet's address to a chip.
    Assign {
        /// To whom.
        chip: Chip,
        /// What it said.
        nonce: u32,
    },
    /// Whoever has the packet's address has none from now on; [`ALL`] is every address.
    Release,
    /// The palm asks a finger.
    Poll(Poll),
    /// The finger answers.
    State(State),
}

/// A question to a finger, with what the palm knows for it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Poll {
    /// The palm's time as the first byte was sent, us.
    pub stamp_us: u32,
    /// Fingers whose detectors say slip, a bit for each address from 1 on.
    pub slips: u8,
    /// The load that this finger is wished to have, mN. None: no wish.
    pub want_mn: Option<u16>,
    /// Bytes of its serial line, down.
    #[serde(with = "bytes")]
    pub line: Vec<u8, LINE_DOWN>,
}

/// What a finger feels, as the sharing needs it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Felt {
    /// The load, mN.
    pub load_mn: u16,
    /// The shear, mN.
    pub ft_mn: u16,
    /// What friction is at least, per mille: the finger's S2.
    pub friction_permille: u16,
}

/// A finger's answer.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct State {
    /// Its last frame.
    pub frame: u32,
    /// When that frame ended, by the palm's clock, us.
    pub frame_at_us: u32,
    /// A muscle is active. Where no sensor says that none is, the finger itself bounds what it closes.
    pub wearer: bool,
    /// Detectors that say slip, and those that warn.
    pub slip: DetectorSet,
    /// See [`slip`](Self::slip).
    pub incipient: DetectorSet,
    /// None while it holds nothing, or feels no force.
    pub felt: Option<Felt>,
    /// Bytes of its serial line, up.
    #[serde(with = "bytes")]
    pub line: Vec<u8, LINE_UP>,
}

/// How long so many bytes take, us.
#[must_use]
pub const fn bytes_us(bytes: u32) -> u32 {
    bytes * 10 * 1_000 / (BAUD / 1_000)
}

/// Bytes of a line at once: the same on the wire, and an answer is ready sooner than with one after the other.
pub(crate) mod bytes {
    use core::fmt;

    use heapless::Vec;
    use serde::de::{Error, Visitor};
    use serde::{Deserializer, Serializer};

    pub fn serialize<const N: usize, S: Serializer>(
        line: &Vec<u8, N>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(line)
    }

    pub fn deserialize<'de, const N: usize, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<u8, N>, D::Error> {
        deserializer.deserialize_bytes(Line)
    }

    struct Line<const N: usize>;

    impl<const N: usize> Visitor<'_> for Line<N> {
        type Value = Vec<u8, N>;

        fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
            formatter.write_str("bytes")
        }

        fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Self::Value, E> {
            Vec::from_slice(bytes).map_err(|_| E::custom("too long"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_hal_shim::wire::encode;

    #[test]
    fn every_packet_fits_and_five_fingers_are_asked_in_a_cycle() {
        let length = |word| {
            encode(u16::MAX, &Packet { address: 5, word }, &mut [0; FRAME_MAX]).map(|frame| frame.len())
        };
        let poll = |line: &[u8]| {
            let line = Vec::from_slice(line).unwrap();
            length(Word::Poll(Poll { stamp_us: u32::MAX, slips: 31, want_mn: Some(u16::MAX), line })).unwrap()
        };
        let felt = Felt { load_mn: u16::MAX, ft_mn: u16::MAX, friction_permille: 1_500 };
        let line = Vec::from_slice(&[7; LINE_UP]).unwrap();
        let state = State {
            frame: u32::MAX,
            frame_at_us: u32::MAX,
            wearer: true,
            slip: DetectorSet::ALL,
            incipient: DetectorSet::ALL,
            felt: Some(felt),
            line,
        };
        let state = length(Word::State(state)).unwrap();
        let here = length(Word::Here { chip: [u32::MAX; 3], nonce: u32::MAX }).unwrap();
        // One finger in a cycle has bytes of its line; an answer begins 140 us after its poll on average.
        let bytes = 5 + 4 * poll(&[]) + poll(&[7; LINE_DOWN]) + 5 * state;
        let cycle_us = bytes_us(bytes as u32) + 5 * 140;
        assert!(cycle_us <= CYCLE_US, "{cycle_us} us");
        assert!(bytes_us(here as u32) < CLAIM_SLOT_US - 30, "{here} bytes");
    }
}
