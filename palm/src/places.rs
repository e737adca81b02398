//! Which fingers a hand has, as the palm keeps it in its flash: the frame that a PC sent, word by word, at the start of a sector.

use heapless::Vec;
use serde::{Deserialize, Serialize};
use tenax_hal_shim::flash::{FlashArea, FlashFailed, Sector};
use tenax_hal_shim::wire::{Receiver, encode};

use crate::bus::{Chip, FINGERS_MAX};

/// A place in the hand: whose it is, and where the force of a finger there points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Place {
    /// The finger's chip.
    pub chip: Chip,
    /// Per mille, in the plane of the grip.
    pub normal: [i16; 2],
    /// The most that it may press, mN.
    pub ceiling_mn: i32,
}

/// The fingers of a hand, in the order of their addresses.
pub type Places = Vec<Place, FINGERS_MAX>;

/// Words of what is kept: a frame of five places.
pub const WORDS: usize = 40;
const SECTOR: Sector = Sector::A;

/// What is kept, as words.
pub type Kept = [u32; WORDS];

/// As they are kept. None only if there were too few words, which a test excludes.
#[must_use]
pub fn pack(places: &Places) -> Option<Kept> {
    let mut bytes = [0; 4 * WORDS];
    encode(0, places, &mut bytes)?;
    let mut words = [0; WORDS];
    words.iter_mut().zip(bytes.as_chunks().0).for_each(|(word, bytes)| *word = u32::from_le_bytes(*bytes));
    Some(words)
}

/// What was kept, if it is whole.
pub fn unpack(words: impl IntoIterator<Item = u32>) -> Option<Places> {
    let mut receiver = Receiver::new();
    let mut bytes = words.into_iter().take(WORDS).flat_map(u32::to_le_bytes);
    let found = bytes.find_map(|byte| receiver.push::<Places>(byte))?;
    found.ok().map(|received| received.message)
}

/// The fingers that are kept. None if nothing is, or what was programmed was cut off.
pub fn load(flash: &impl FlashArea) -> Option<Places> {
    unpack((0..WORDS).map(|word| flash.read(SECTOR, word)))
}

/// Keeps them instead of what was kept. The core stands still for as long as an erase takes.
///
/// # Errors
/// If the flash reports an error: then nothing is kept.
pub fn save(flash: &mut impl FlashArea, kept: &Kept) -> Result<(), FlashFailed> {
    flash.erase(SECTOR)?;
    kept.iter().enumerate().try_for_each(|(n, &word)| flash.program(SECTOR, n, word))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_hal_shim::flash::BLANK;

    /// Words that take so many programs before the power goes.
    struct Words([u32; 128], usize);

    impl FlashArea for Words {
        fn sector_words(&self) -> usize {
            self.0.len()
        }

        fn read(&self, _: Sector, word: usize) -> u32 {
            self.0.get(word).copied().unwrap_or(BLANK)
        }

        fn program(&mut self, _: Sector, word: usize, value: u32) -> Result<(), FlashFailed> {
            self.1 = self.1.checked_sub(1).ok_or(FlashFailed)?;
            self.0.get_mut(word).map(|own| *own &= value).ok_or(FlashFailed)
        }

        fn erase(&mut self, _: Sector) -> Result<(), FlashFailed> {
            self.0.fill(BLANK);
            Ok(())
        }
    }

    #[test]
    fn what_is_kept_is_found_and_what_was_cut_off_is_nothing() {
        let place = Place { chip: [u32::MAX; 3], normal: [i16::MIN; 2], ceiling_mn: i32::MAX };
        for count in 0..=FINGERS_MAX {
            let places: Places = (0..count).map(|_| place).collect();
            let mut flash = Words([0; 128], usize::MAX);
            assert_eq!(load(&flash), None);
            let kept = pack(&places).unwrap();
            save(&mut flash, &kept).unwrap();
            assert_eq!(load(&flash), Some(places.clone()));
            // The frame and its zero.
            let words = kept.iter().rposition(|&word| word != 0).unwrap() + 1;
            for cut in 0..words {
                flash.1 = cut;
                assert_eq!(save(&mut flash, &kept), Err(FlashFailed));
                assert_eq!(load(&flash), None, "cut off before word {cut}");
            }
        }
    }
}
