//! The log under any history and any damage.

use proptest::prelude::*;
use tenax_hal_shim::words::Kept;
use tenax_logic::store::{Erase, open};

use super::flash::TestFlash;
use super::{booted, numbers, save};

const SECTOR_WORDS: usize = 96;

proptest! {
    #[test]
    fn after_any_damage_only_saved_records_are_found_and_the_log_goes_on(
        saves in 1u32..30,
        rot in prop::collection::vec((0usize..2, 0usize..SECTOR_WORDS, any::<u32>()), 1..8),
    ) {
        let mut flash = TestFlash::blank(SECTOR_WORDS);
        for n in 0..saves {
            let (mut log, _) = open(&mut flash, Erase::Allowed);
            save(&mut flash, &mut log, Kept::ALL[n as usize % 4], n).unwrap();
        }
        for (sector, word, bits) in rot {
            flash.words[sector][word] ^= bits;
        }
        let (mut log, found) = open(&mut flash, Erase::Allowed);
        for n in numbers(&flash, &found).into_iter().flatten() {
            prop_assert!(n < saves);
        }
        if log.free_words() >= 9 {
            save(&mut flash, &mut log, Kept::Network, 99).unwrap();
            prop_assert_eq!(booted(&mut flash)[0], Some(99));
        }
    }

    #[test]
    fn nonsense_is_no_record(words in prop::array::uniform2(prop::collection::vec(any::<u32>(), SECTOR_WORDS))) {
        let mut flash = TestFlash::holding(words);
        let (mut log, found) = open(&mut flash, Erase::Allowed);
        prop_assert_eq!(numbers(&flash, &found), [None; 4]);
        save(&mut flash, &mut log, Kept::Settings, 5).unwrap();
        prop_assert_eq!(booted(&mut flash), [None, None, Some(5), None]);
    }

    // Shows B5.
    #[test]
    fn a_rotten_record_leaves_the_one_before_and_the_other_kinds(bit in 0usize..32, word in 0usize..6) {
        let mut flash = TestFlash::blank(SECTOR_WORDS);
        let (mut log, _) = open(&mut flash, Erase::Allowed);
        for (n, kept) in Kept::ALL.into_iter().enumerate() {
            save(&mut flash, &mut log, kept, n as u32).unwrap();
        }
        let begins = SECTOR_WORDS / 8 * 7 - log.free_words();
        save(&mut flash, &mut log, Kept::Zero, 7).unwrap();
        flash.words[0][begins + word] ^= 1 << bit;
        let (_, found) = open(&mut flash, Erase::Allowed);
        // A tag of which a bit rotted still says what it is.
        let zero = if word == 0 { 7 } else { 1 };
        prop_assert_eq!(numbers(&flash, &found), [Some(0), Some(zero), Some(2), Some(3)]);
        prop_assert_eq!(found.is_damaged(Kept::Zero), word > 0);
    }
}
