//! The log of what outlives a power cut, against a flash that behaves as flash does.

mod cuts;
mod flash;
mod properties;

use tenax_hal_shim::flash::FlashFailed;
use tenax_logic::store::record::Kind;
use tenax_logic::store::{Found, Log, open};

use flash::TestFlash;

/// The payload that save number `n` of `kind` has: no two are alike, and each kind has its length.
fn payload(kind: Kind, n: u32) -> Vec<u8> {
    let words = match kind {
        Kind::Network => 5,
        Kind::Zero => 2,
        Kind::Settings => 3,
    };
    (0..words).flat_map(|word: u32| (n << 8 | word << 4 | kind as u32).to_le_bytes()).collect()
}

/// Programs a whole record; the number of its words. An error if the flash failed on the way.
fn save(flash: &mut TestFlash, log: &mut Log, kind: Kind, n: u32) -> Result<usize, FlashFailed> {
    let payload = payload(kind, n);
    let mut saving = log.begin(kind, &payload).expect("room for it");
    let mut words = 1;
    while !saving.step(flash)? {
        words += 1;
    }
    Ok(words)
}

/// The number of the save of `kind` that is found. Fails if what is found was never saved.
fn number(flash: &TestFlash, found: &Found, kind: Kind) -> Option<u32> {
    let mut buffer = [0; 64];
    let bytes = found.read(flash, kind, &mut buffer)?;
    let n = u32::from_le_bytes(bytes[..4].try_into().expect("four bytes")) >> 8;
    assert_eq!(bytes, payload(kind, n), "a record of {kind:?} that nobody saved");
    Some(n)
}

fn numbers(flash: &TestFlash, found: &Found) -> [Option<u32>; 3] {
    Kind::ALL.map(|kind| number(flash, found, kind))
}

#[test]
fn the_newest_of_each_kind_comes_back_from_a_sector_of_the_chip() {
    let mut flash = TestFlash::blank(128 * 1024 / 4);
    let (mut log, found) = open(&mut flash);
    assert_eq!(numbers(&flash, &found), [None; 3]);
    for n in 0..50 {
        save(&mut flash, &mut log, Kind::ALL[n as usize % 3], n).unwrap();
    }
    let (_, found) = open(&mut flash);
    assert_eq!(numbers(&flash, &found), [Some(48), Some(49), Some(47)]);
    assert_eq!(flash.erases, [0, 0], "a new chip is blank, and there was room");
}

/// The figures of the module's documentation.
#[test]
fn four_million_saves_of_the_network_in_the_chips_life() {
    const ERASES: usize = 10_000;
    let snapshot = vec![7; tenax_logic::hebbian::snapshot::length(24, 2)];
    let mut flash = TestFlash::blank(128 * 1024 / 4);
    let (mut log, _) = open(&mut flash);
    let mut saves = 0;
    while flash.erases != [3, 3] {
        let Ok(mut saving) = log.begin(Kind::Network, &snapshot) else {
            panic!("a boot after every save always makes room");
        };
        while !saving.step(&mut flash).unwrap() {}
        saves += 1;
        (log, _) = open(&mut flash);
    }
    let for_an_erase = saves / 6;
    println!("{} words a save, {for_an_erase} saves an erase at least", snapshot.len() / 4 + 4);
    assert_eq!(for_an_erase, 210);
    assert!(for_an_erase * 2 * ERASES > 4_000_000);
}

#[test]
fn a_full_sector_refuses_until_the_next_boot_and_erases_nothing_before() {
    let mut flash = TestFlash::blank(128);
    let (mut log, _) = open(&mut flash);
    let mut n = 0;
    while log.free_words() >= 9 {
        save(&mut flash, &mut log, Kind::Network, n).unwrap();
        n += 1;
    }
    let refused = log.begin(Kind::Network, &payload(Kind::Network, n)).expect_err("full");
    assert_eq!(refused, tenax_logic::store::Refused::Full);
    assert_eq!(flash.erases, [0, 0]);
    let (mut log, found) = open(&mut flash);
    assert_eq!(number(&flash, &found, Kind::Network), Some(n - 1));
    assert_eq!(flash.erases, [0, 1], "the other one; the full one is kept until its turn");
    save(&mut flash, &mut log, Kind::Network, n).unwrap();
    let (_, found) = open(&mut flash);
    assert_eq!(number(&flash, &found, Kind::Network), Some(n));
}

#[test]
fn payloads_that_are_no_record_are_refused() {
    let mut flash = TestFlash::blank(4_096);
    let (mut log, _) = open(&mut flash);
    for bytes in [1, 3, 4 * 256] {
        assert_eq!(
            log.begin(Kind::Zero, &vec![0; bytes]).expect_err("no record"),
            tenax_logic::store::Refused::Length,
            "{bytes} bytes"
        );
    }
    assert!(log.begin(Kind::Zero, &[0; 4 * 255]).is_ok());
}

#[test]
fn a_worn_flash_costs_the_log_but_not_what_it_held() {
    let mut flash = TestFlash::blank(128);
    let (mut log, _) = open(&mut flash);
    for n in 0..9 {
        save(&mut flash, &mut log, Kind::Network, n).unwrap();
    }
    flash.worn = true;
    let (mut log, found) = open(&mut flash);
    assert_eq!(number(&flash, &found, Kind::Network), Some(8));
    assert_eq!(log.free_words(), 0);
    let refused = log.begin(Kind::Zero, &payload(Kind::Zero, 9)).expect_err("worn");
    assert_eq!(refused, tenax_logic::store::Refused::Failed);
}
