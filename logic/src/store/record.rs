//! A record, in words, in the order in which they are programmed.
//!
//! ```text
//! tag        kind, payload's words, and the complements of both, so that a half programmed tag is found
//! sequence   higher is newer, over both sectors
//! payload    up to 255 whole words, little-endian
//! CRC-32     of all of the above (ISO-HDLC, the wire's)
//! commit     programmed last, so that everything before it was programmed to the end
//! ```

use crc::Digest;
use tenax_hal_shim::flash::{FlashArea, FlashFailed, Sector};
use tenax_hal_shim::words::Kept;

use crate::checksum::CRC;
use crate::hebbian::{Learned, SNAPSHOT_LENGTH};
use crate::store::payload::{EmgBytes, SettingsBytes, ZeroBytes};

pub const OVERHEAD_WORDS: usize = 4;
/// All bits 0, so that none is half programmed; it is no tag.
pub(super) const MARK: u32 = 0;
const COMMIT: u32 = 0x3C5A_96E1;
pub const PAYLOAD_BYTES: usize = SNAPSHOT_LENGTH;

#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "there is no heap to put the large one on")]
pub enum Record {
    Network(Learned),
    Zero(ZeroBytes),
    Settings(SettingsBytes),
    Emg(EmgBytes),
}

impl Record {
    pub const fn kept(&self) -> Kept {
        match self {
            Self::Network(_) => Kept::Network,
            Self::Zero(_) => Kept::Zero,
            Self::Settings(_) => Kept::Settings,
            Self::Emg(_) => Kept::Emg,
        }
    }

    pub fn payload<'a>(&'a self, buffer: &'a mut [u8; PAYLOAD_BYTES]) -> &'a [u8] {
        match self {
            Self::Network(learned) => learned.write(buffer).unwrap_or_default(),
            Self::Zero(bytes) => bytes,
            Self::Settings(bytes) => bytes,
            Self::Emg(bytes) => bytes,
        }
    }
}

/// Numbers are never reused.
pub(super) const fn number(kept: Kept) -> u8 {
    kept as u8 + 1
}

pub(super) fn from_number(number: u8) -> Option<Kept> {
    Kept::ALL.into_iter().find(|&kept| self::number(kept) == number)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tag {
    pub kind: u8,
    pub words: u8,
}

impl Tag {
    pub fn new(kind: u8, words: usize) -> Option<Self> {
        Some(Self { kind, words: u8::try_from(words).ok()? })
    }

    pub const fn record_words(self) -> usize {
        self.words as usize + OVERHEAD_WORDS
    }

    pub const fn to_word(self) -> u32 {
        u32::from_le_bytes([self.kind, self.words, !self.kind, !self.words])
    }

    pub fn from_word(word: u32) -> Option<Self> {
        let [kind, words, ..] = word.to_le_bytes();
        let tag = Self { kind, words };
        (tag.to_word() == word).then_some(tag)
    }

    /// The word's own tag; both candidates if one bit contradicts the complement (half programmed); else none.
    pub fn read_from(word: u32) -> impl Iterator<Item = Self> {
        let [kind, words, not_kind, not_words] = word.to_le_bytes();
        let (read, complement) = (Self { kind, words }, Self { kind: !not_kind, words: !not_words });
        let differ = (kind ^ complement.kind).count_ones() + (words ^ complement.words).count_ones();
        let first = (differ <= 1).then_some(read);
        let second = (differ == 1).then_some(complement);
        first.into_iter().chain(second)
    }

    /// Sequence number of the record at `at`. None if the record is incomplete.
    pub fn check(self, area: &impl FlashArea, sector: Sector, at: usize) -> Option<u32> {
        let payload_end = at + 2 + usize::from(self.words);
        if payload_end + 2 > area.sector_words() {
            return None;
        }
        let mut digest = CRC.digest();
        digest.update(&self.to_word().to_le_bytes());
        for word in at + 1..payload_end {
            digest.update(&area.read(sector, word).to_le_bytes());
        }
        let whole = area.read(sector, payload_end) == digest.finalize()
            && area.read(sector, payload_end + 1) == COMMIT;
        whole.then(|| area.read(sector, at + 1))
    }
}

/// Dropped before its end, the record does not count.
pub struct Saving<'a> {
    pub(super) sector: Sector,
    pub(super) at: usize,
    pub(super) tag: Tag,
    pub(super) sequence: u32,
    pub(super) payload: &'a [[u8; 4]],
    pub(super) digest: Digest<'static, u32>,
    pub(super) step: usize,
    pub(super) mark: Option<usize>,
}

impl Saving<'_> {
    /// Programs the next word; true when it was the last one. After a failure it never counts.
    pub fn step(&mut self, area: &mut impl FlashArea) -> Result<bool, FlashFailed> {
        if let Some(place) = self.mark.take() {
            super::program(area, self.sector, place, MARK)?;
            return Ok(false);
        }
        let word = match self.step {
            0 => self.tag.to_word(),
            1 => self.sequence,
            step => match self.payload.get(step - 2) {
                Some(bytes) => u32::from_le_bytes(*bytes),
                None if step == self.tag.record_words() - 2 => self.digest.clone().finalize(),
                None => COMMIT,
            },
        };
        self.digest.update(&word.to_le_bytes());
        let place = self.at + self.step;
        super::program(area, self.sector, place, word)?;
        self.step += 1;
        Ok(self.step == self.tag.record_words())
    }
}
