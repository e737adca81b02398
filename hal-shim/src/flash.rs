//! The part of a board's flash that outlives a power cut: two sectors of words.

pub const BLANK: u32 = u32::MAX;

/// One of the two sectors. Each is erased as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sector {
    A,
    B,
}

impl Sector {
    pub const BOTH: [Self; 2] = [Self::A, Self::B];

    pub const fn other(self) -> Self {
        match self {
            Self::A => Self::B,
            Self::B => Self::A,
        }
    }
}

/// Programming or erasing failed: the flash is worn, protected, or the word was programmed before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlashFailed;

/// An implementation guarantees:
/// - a programmed word reads as what it was programmed with until its sector is erased, also without power; an erased
///   one reads [`BLANK`];
/// - a power cut during [`program`](Self::program) changes that word only, one during [`erase`](Self::erase) that sector
///   only, but to anything;
/// - nothing outside the two sectors is ever changed.
///
/// Programming may stall the core for as long as one word takes, erasing for seconds: the caller chooses the instant.
pub trait FlashArea {
    fn sector_words(&self) -> usize;

    /// The word at `word` of `sector`; [`BLANK`] outside.
    fn read(&self, sector: Sector, word: usize) -> u32;

    /// Programs a blank word. Fails if it was not blank, is outside the sector, or the flash reports an error.
    fn program(&mut self, sector: Sector, word: usize, value: u32) -> Result<(), FlashFailed>;

    /// Erases a sector: every word of it reads [`BLANK`] afterwards. Fails if the flash reports an error.
    fn erase(&mut self, sector: Sector) -> Result<(), FlashFailed>;
}
