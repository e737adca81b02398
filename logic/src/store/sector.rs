//! What one sector holds.
//!
//! ```text
//! opening words   magic, generation, CRC-32 of both: programmed last when a sector is taken into use
//! records         one after the other
//! blank words     up to its end
//! ```

use tenax_hal_shim::flash::{BLANK, FlashArea, FlashFailed, Sector};
use tenax_hal_shim::words::Kept;

use super::record::{self, Tag};
use crate::checksum::CRC;

/// Words before the first record.
pub const OPENING_WORDS: usize = 3;

/// Mark of the layout of sectors and records; another layout needs another value.
const MAGIC: u32 = 0x7E4A_0001;

/// Place of a complete record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    pub sector: Sector,
    pub at: usize,
    pub kept: Kept,
    pub words: u8,
    pub sequence: u32,
}

impl Entry {
    pub fn tag(&self) -> Tag {
        Tag { kind: record::number(self.kept), words: self.words }
    }

    /// Reads the payload into `buffer`. None if it is longer.
    pub fn read<'a>(&self, area: &impl FlashArea, buffer: &'a mut [u8]) -> Option<&'a [u8]> {
        let payload = buffer.get_mut(..4 * usize::from(self.words))?;
        let (slots, _) = payload.as_chunks_mut::<4>();
        for (n, slot) in slots.iter_mut().enumerate() {
            *slot = area.read(self.sector, self.at + 2 + n).to_le_bytes();
        }
        Some(payload)
    }
}

/// Everything that is known about a sector.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Survey {
    pub sector: Sector,
    /// None if its opening words are not whole.
    pub generation: Option<u32>,
    /// The newest whole record of each kind, indexed by [`Kept`].
    pub newest: [Option<Entry>; Kept::ALL.len()],
    /// For each kind, whether a damaged or unfinished record of it follows the newest whole one.
    pub damaged: [bool; Kept::ALL.len()],
    /// The highest sequence number of the sector's whole records, 0 if it has none.
    pub last_sequence: u32,
    /// Offset of the first word of the blank rest, words.
    pub end: usize,
}

impl Survey {
    /// Reads the whole sector: nothing in it is trusted, so nothing in it says where to stop.
    pub fn of(area: &impl FlashArea, sector: Sector) -> Self {
        let mut survey = Self {
            sector,
            generation: read_opening(area, sector),
            newest: Default::default(),
            damaged: Default::default(),
            last_sequence: 0,
            end: OPENING_WORDS,
        };
        let mut at = OPENING_WORDS;
        while at < area.sector_words() {
            at = survey.look_at(area, at);
        }
        survey
    }

    /// Takes what begins at `at`; where the next may begin. Only a record that checks out is skipped by its length: a tag
    /// that a power cut left half programmed may name any length, and another one each time it is read.
    fn look_at(&mut self, area: &impl FlashArea, at: usize) -> usize {
        let word = area.read(self.sector, at);
        if word == BLANK {
            return at + 1;
        }
        self.end = at + 1;
        for tag in Tag::read_from(word) {
            let Some(sequence) = tag.check(area, self.sector, at) else { continue };
            self.end = at + tag.record_words();
            if let Some(kept) = record::from_number(tag.kind) {
                self.damaged[kept as usize] = false;
                self.enter(Entry { sector: self.sector, at, kept, words: tag.words, sequence });
            }
            return self.end;
        }
        // Any word may differ from a tag by a bit; only a tag that is whole was to be a record.
        if let Some(kept) = Tag::from_word(word).and_then(|tag| record::from_number(tag.kind)) {
            self.damaged[kept as usize] = true;
        }
        self.end
    }

    fn enter(&mut self, entry: Entry) {
        let newest = &mut self.newest[entry.kept as usize];
        if newest.is_none_or(|newest| newest.sequence <= entry.sequence) {
            *newest = Some(entry);
        }
        self.last_sequence = self.last_sequence.max(entry.sequence);
    }

    /// Rank of the sector; records are appended to the one of higher rank. Sectors with equal sequence numbers are a copy and its
    /// original; a finished copy has opening words of a later generation.
    pub fn rank(&self) -> (u32, u32) {
        (self.last_sequence, self.generation.unwrap_or(0))
    }
}

/// Whether no word of the sector has been programmed.
pub fn is_blank(area: &impl FlashArea, sector: Sector) -> bool {
    (0..area.sector_words()).all(|word| area.read(sector, word) == BLANK)
}

/// Writes the opening words (magic, `generation`, CRC-32) of an erased sector, so that records can be appended. Fails
/// if a word cannot be programmed or reads back differently.
pub fn write_opening(area: &mut impl FlashArea, sector: Sector, generation: u32) -> Result<(), FlashFailed> {
    for (n, word) in opening(generation).into_iter().enumerate() {
        super::program(area, sector, n, word)?;
    }
    Ok(())
}

fn read_opening(area: &impl FlashArea, sector: Sector) -> Option<u32> {
    let words = [0, 1, 2].map(|n| area.read(sector, n));
    let generation = words[1];
    (words == opening(generation)).then_some(generation)
}

fn opening(generation: u32) -> [u32; OPENING_WORDS] {
    let mut digest = CRC.digest();
    digest.update(&MAGIC.to_le_bytes());
    digest.update(&generation.to_le_bytes());
    [MAGIC, generation, digest.finalize()]
}
