//! A sector: opening words (magic, generation, CRC-32 of both), then records, then blank words.

use tenax_hal_shim::flash::{BLANK, FlashArea, FlashFailed, Sector};
use tenax_hal_shim::words::Kept;

use super::record::{self, Tag};
use crate::checksum::CRC;

pub const OPENING_WORDS: usize = 3;
const MAGIC: u32 = 0x7E4A_0001;

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

    pub fn read<'a>(&self, area: &impl FlashArea, buffer: &'a mut [u8]) -> Option<&'a [u8]> {
        let payload = buffer.get_mut(..4 * usize::from(self.words))?;
        let (slots, _) = payload.as_chunks_mut::<4>();
        for (n, slot) in slots.iter_mut().enumerate() {
            *slot = area.read(self.sector, self.at + 2 + n).to_le_bytes();
        }
        Some(payload)
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Survey {
    pub sector: Sector,
    pub generation: Option<u32>,
    pub newest: [Option<Entry>; Kept::ALL.len()],
    pub damaged: [bool; Kept::ALL.len()],
    pub last_sequence: u32,
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

    /// Place of the next record. Only a record that checks out is skipped by its length: a half programmed tag may
    /// name any.
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

    /// Records are appended to the sector of higher rank; a finished copy has a later generation.
    pub fn rank(&self) -> (u32, u32) {
        (self.last_sequence, self.generation.unwrap_or(0))
    }
}

pub fn is_blank(area: &impl FlashArea, sector: Sector) -> bool {
    (0..area.sector_words()).all(|word| area.read(sector, word) == BLANK)
}

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
