//! The log of what outlives a power cut, against a flash that behaves as flash does.

mod cuts;
mod fingertip;
mod flash;
mod properties;

use tenax_hal_shim::flash::FlashFailed;
use tenax_hal_shim::words::Kept;
use tenax_logic::store::{Erase, Found, Log, open};

use flash::TestFlash;

/// The payload that save number `n` of `kept` has: no two are alike, and each kept has its length.
fn payload(kept: Kept, n: u32) -> Vec<u8> {
    let words = match kept {
        Kept::Network => 5,
        Kept::Zero => 2,
        Kept::Settings => 3,
        Kept::Emg => 4,
    };
    (0..words).flat_map(|word: u32| (n << 8 | word << 4 | kept as u32).to_le_bytes()).collect()
}

/// Programs a whole record; the number of its words. An error if the flash failed on the way.
fn save(flash: &mut TestFlash, log: &mut Log, kept: Kept, n: u32) -> Result<usize, FlashFailed> {
    let payload = payload(kept, n);
    let mut saving = log.begin(kept, &payload).expect("room for it");
    let mut words = 1;
    while !saving.step(flash)? {
        words += 1;
    }
    Ok(words)
}

/// The number of the save of `kept` that is found. Fails if what is found was never saved.
fn number(flash: &TestFlash, found: &Found, kept: Kept) -> Option<u32> {
    let mut buffer = [0; 64];
    let bytes = found.read(flash, kept, &mut buffer)?;
    let n = u32::from_le_bytes(bytes[..4].try_into().expect("four bytes")) >> 8;
    assert_eq!(bytes, payload(kept, n), "a record of {kept:?} that nobody saved");
    Some(n)
}

fn numbers(flash: &TestFlash, found: &Found) -> [Option<u32>; Kept::ALL.len()] {
    Kept::ALL.map(|kept| number(flash, found, kept))
}

#[test]
fn the_newest_of_each_kept_comes_back_from_a_sector_of_the_chip() {
    let mut flash = TestFlash::blank(128 * 1024 / 4);
    let (mut log, found) = open(&mut flash, Erase::Allowed);
    assert_eq!(numbers(&flash, &found), [None; Kept::ALL.len()]);
    for n in 0..50 {
        save(&mut flash, &mut log, Kept::ALL[n as usize % 4], n).unwrap();
    }
    let (_, found) = open(&mut flash, Erase::Allowed);
    assert_eq!(numbers(&flash, &found), [Some(48), Some(49), Some(46), Some(47)]);
    assert_eq!(flash.erases, [0, 0], "a new chip is blank, and there was room");
}

/// The figures of the module's documentation.
#[test]
fn four_million_saves_of_the_network_in_the_chips_life() {
    const ERASES: usize = 10_000;
    let snapshot = vec![7; tenax_logic::hebbian::snapshot::length(24, 2)];
    let mut flash = TestFlash::blank(128 * 1024 / 4);
    let (mut log, _) = open(&mut flash, Erase::Allowed);
    let mut saves = 0;
    while flash.erases != [3, 3] {
        let Ok(mut saving) = log.begin(Kept::Network, &snapshot) else {
            panic!("a boot after every save always makes room");
        };
        while !saving.step(&mut flash).unwrap() {}
        saves += 1;
        (log, _) = open(&mut flash, Erase::Allowed);
    }
    let for_an_erase = saves / 6;
    println!("{} words a save, {for_an_erase} saves an erase at least", snapshot.len() / 4 + 4);
    // With a boot after every save, each of which leaves a word free.
    assert_eq!(for_an_erase, 204);
    assert!(for_an_erase * 2 * ERASES > 4_000_000);
}

#[test]
fn a_full_sector_refuses_until_the_next_boot_and_erases_nothing_before() {
    let mut flash = TestFlash::blank(128);
    let (mut log, _) = open(&mut flash, Erase::Allowed);
    let mut n = 0;
    while log.free_words() >= 9 {
        save(&mut flash, &mut log, Kept::Network, n).unwrap();
        n += 1;
    }
    let refused = log.begin(Kept::Network, &payload(Kept::Network, n)).expect_err("full");
    assert_eq!(refused, tenax_logic::store::Refused::Full);
    assert_eq!(flash.erases, [0, 0]);
    let (mut log, found) = open(&mut flash, Erase::Allowed);
    assert_eq!(number(&flash, &found, Kept::Network), Some(n - 1));
    assert_eq!(flash.erases, [0, 1], "the other one; the full one is kept until its turn");
    save(&mut flash, &mut log, Kept::Network, n).unwrap();
    let (_, found) = open(&mut flash, Erase::Allowed);
    assert_eq!(number(&flash, &found, Kept::Network), Some(n));
}

/// What is held when the hand is reset cannot be let go while the core stands still.
// Shows B6.
#[test]
fn a_boot_after_a_reset_erases_nothing_and_uses_the_room_there_is() {
    let mut flash = TestFlash::blank(128);
    let mut n = 0u32;
    loop {
        let (mut log, found) = open(&mut flash, Erase::Postponed);
        assert_eq!(number(&flash, &found, Kept::Network), n.checked_sub(1));
        if log.free_words() < 9 {
            break;
        }
        save(&mut flash, &mut log, Kept::Network, n).unwrap();
        n += 1;
    }
    assert!(n >= 9, "{n} saves: the whole of the sector but what is kept free");
    assert_eq!(flash.erases, [0, 0]);
    let (mut log, _) = open(&mut flash, Erase::Allowed);
    assert_eq!(flash.erases, [0, 1], "switched on, it makes room");
    save(&mut flash, &mut log, Kept::Network, n).unwrap();

    // The opening words of the only sector are not whole, and a record is: nothing is lost for it.
    let mut flash = TestFlash::blank(128);
    let (mut log, _) = open(&mut flash, Erase::Allowed);
    save(&mut flash, &mut log, Kept::Zero, 1).unwrap();
    flash.words()[0][1] ^= 7;
    let (mut log, _) = open(&mut flash, Erase::Postponed);
    save(&mut flash, &mut log, Kept::Zero, 2).unwrap();
    for erase in [Erase::Postponed, Erase::Allowed] {
        let (_, found) = open(&mut flash, erase);
        assert_eq!(number(&flash, &found, Kept::Zero), Some(2), "{erase:?}");
    }
    // Nonsense in both, and no erase: nothing is saved until there may be one.
    let mut flash = TestFlash::holding([vec![7; 128], vec![9; 128]]);
    let (mut log, _) = open(&mut flash, Erase::Postponed);
    let refused = log.begin(Kept::Zero, &payload(Kept::Zero, 1)).expect_err("no room");
    assert_eq!((refused, flash.erases), (tenax_logic::store::Refused::Full, [0, 0]));
}

#[test]
fn payloads_that_are_no_record_are_refused() {
    let mut flash = TestFlash::blank(4_096);
    let (mut log, _) = open(&mut flash, Erase::Allowed);
    for bytes in [1, 3, 4 * 256] {
        assert_eq!(
            log.begin(Kept::Zero, &vec![0; bytes]).expect_err("no record"),
            tenax_logic::store::Refused::Length,
            "{bytes} bytes"
        );
    }
    assert!(log.begin(Kept::Zero, &[0; 4 * 255]).is_ok());
}

// Shows B5.
#[test]
fn a_worn_flash_costs_the_log_but_not_what_it_held() {
    let mut flash = TestFlash::blank(128);
    let (mut log, _) = open(&mut flash, Erase::Allowed);
    for n in 0..9 {
        save(&mut flash, &mut log, Kept::Network, n).unwrap();
    }
    flash.worn = true;
    let (mut log, found) = open(&mut flash, Erase::Allowed);
    assert_eq!(number(&flash, &found, Kept::Network), Some(8));
    assert_eq!(log.free_words(), 0);
    let refused = log.begin(Kept::Zero, &payload(Kept::Zero, 9)).expect_err("worn");
    assert_eq!(refused, tenax_logic::store::Refused::Failed);
}
