//! The log of saved records, against a flash that behaves as flash does.

mod cuts;
mod fingertip;
mod flash;
mod properties;

use tenax_hal_shim::flash::FlashFailed;
use tenax_hal_shim::words::Kept;
use tenax_logic::store::{Erase, Found, Log, Refused, open};

use flash::TestFlash;

type Numbers = [Option<u32>; Kept::ALL.len()];

fn payload(kept: Kept, n: u32) -> Vec<u8> {
    let words = match kept {
        Kept::Network => 5,
        Kept::Zero => 2,
        Kept::Settings => 3,
        Kept::Emg => 4,
    };
    (0..words).flat_map(|word: u32| (n << 8 | word << 4 | kept as u32).to_le_bytes()).collect()
}

fn save(flash: &mut TestFlash, log: &mut Log, kept: Kept, n: u32) -> Result<usize, FlashFailed> {
    let payload = payload(kept, n);
    let mut saving = log.begin(kept, &payload).expect("room for it");
    let mut words = 1;
    while !saving.step(flash)? {
        words += 1;
    }
    Ok(words)
}

fn refusal(log: &mut Log, payload: &[u8]) -> Option<Refused> {
    log.begin(Kept::Network, payload).err()
}

fn number(flash: &TestFlash, found: &Found, kept: Kept) -> Option<u32> {
    let mut buffer = [0; 64];
    let bytes = found.read(flash, kept, &mut buffer)?;
    let n = u32::from_le_bytes(bytes[..4].try_into().expect("four bytes")) >> 8;
    assert_eq!(bytes, payload(kept, n), "a record of {kept:?} that nobody saved");
    Some(n)
}

fn numbers(flash: &TestFlash, found: &Found) -> Numbers {
    Kept::ALL.map(|kept| number(flash, found, kept))
}

fn booted(flash: &mut TestFlash) -> Numbers {
    let (_, found) = open(flash, Erase::Allowed);
    numbers(flash, &found)
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
    assert_eq!(refusal(&mut log, &payload(Kept::Network, n)), Some(Refused::Full));
    assert_eq!(flash.erases, [0, 0]);
    let (mut log, found) = open(&mut flash, Erase::Allowed);
    assert_eq!(number(&flash, &found, Kept::Network), Some(n - 1));
    assert_eq!(flash.erases, [0, 1], "the other one; the full one is kept until its turn");
    save(&mut flash, &mut log, Kept::Network, n).unwrap();
    assert_eq!(booted(&mut flash)[Kept::Network as usize], Some(n));
}

/// While the core waits for an erase, a wearer could not let go of what the hand held at the reset.
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

    // A sector whose opening words are damaged, with a whole record.
    let mut flash = TestFlash::blank(128);
    let (mut log, _) = open(&mut flash, Erase::Allowed);
    save(&mut flash, &mut log, Kept::Zero, 1).unwrap();
    flash.words[0][1] ^= 7;
    let (mut log, _) = open(&mut flash, Erase::Postponed);
    save(&mut flash, &mut log, Kept::Zero, 2).unwrap();
    for erase in [Erase::Postponed, Erase::Allowed] {
        let (_, found) = open(&mut flash, erase);
        assert_eq!(number(&flash, &found, Kept::Zero), Some(2), "{erase:?}");
    }
    // Nonsense in both sectors: nothing is saved until an erase is allowed.
    let mut flash = TestFlash::holding([vec![7; 128], vec![9; 128]]);
    let (mut log, _) = open(&mut flash, Erase::Postponed);
    assert_eq!(refusal(&mut log, &payload(Kept::Zero, 1)), Some(Refused::Full));
    assert_eq!(flash.erases, [0, 0]);
}

#[test]
fn payloads_of_other_lengths_are_refused() {
    let (mut log, _) = open(&mut TestFlash::blank(4_096), Erase::Allowed);
    for bytes in [1, 3, 4 * 256] {
        assert_eq!(refusal(&mut log, &vec![0; bytes]), Some(Refused::Length), "{bytes} bytes");
    }
    assert_eq!(refusal(&mut log, &[0; 4 * 255]), None);
}

// Shows B5.
#[test]
fn a_worn_flash_costs_the_log_but_no_record() {
    let mut flash = TestFlash::blank(128);
    let (mut log, _) = open(&mut flash, Erase::Allowed);
    for n in 0..9 {
        save(&mut flash, &mut log, Kept::Network, n).unwrap();
    }
    flash.worn = true;
    let (mut log, found) = open(&mut flash, Erase::Allowed);
    assert_eq!(number(&flash, &found, Kept::Network), Some(8));
    assert_eq!(log.free_words(), 0);
    assert_eq!(refusal(&mut log, &payload(Kept::Zero, 9)), Some(Refused::Failed));
}
