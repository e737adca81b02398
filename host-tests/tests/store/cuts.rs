//! A power cut at every operation, and another one at every operation of the boot after it.

use tenax_hal_shim::flash::FlashFailed;
use tenax_hal_shim::words::Kept;
use tenax_logic::store::{Erase, open};

use super::flash::{HARMS, Harm, TestFlash};
use super::{numbers, save};

const SECTOR_WORDS: usize = 80;
const SAVES: u32 = 60;
/// Saves from one boot to the next.
const SESSION: u32 = 4;

/// What the wearer may count on, of each kept: the last save that was finished, and the one that may or may not have been.
#[derive(Clone, Debug, Default)]
struct Promise {
    finished: [Option<u32>; Kept::ALL.len()],
    begun: Option<(Kept, u32)>,
}

impl Promise {
    fn holds(&self, found: [Option<u32>; Kept::ALL.len()]) -> bool {
        Kept::ALL.into_iter().zip(found).all(|(kept, found)| {
            found == self.finished[kept as usize]
                || self.begun.is_some_and(|(begun, n)| begun == kept && found == Some(n))
        })
    }
}

/// Lives until the power goes or everything is saved.
fn live(flash: &mut TestFlash) -> (Promise, Result<(), FlashFailed>) {
    let mut promise = Promise::default();
    for n in 0..SAVES {
        if n % SESSION == 0 {
            let (_, found) = open(flash, Erase::Allowed);
            if flash.dead {
                return (promise, Err(FlashFailed));
            }
            assert_eq!(numbers(flash, &found), promise.finished);
        }
        let (mut log, _) = open(flash, Erase::Allowed);
        if flash.dead {
            return (promise, Err(FlashFailed));
        }
        let kept = Kept::ALL[(n * n % 3 + n / 16 % 2) as usize];
        promise.begun = Some((kept, n));
        if save(flash, &mut log, kept, n).is_err() {
            return (promise, Err(FlashFailed));
        }
        promise.finished[kept as usize] = Some(n);
        promise.begun = None;
    }
    (promise, Ok(()))
}

// Shows B4.
#[test]
fn any_cut_leaves_the_old_or_the_new() {
    let mut whole = TestFlash::blank(SECTOR_WORDS);
    let (_, survived) = live(&mut whole);
    assert!(survived.is_ok());
    assert!(whole.erases[0] >= 3 && whole.erases[1] >= 3, "{:?} sectors were worn", whole.erases);
    let mut cases = 0;
    for operation in 0..whole.operations {
        for harm in HARMS {
            let mut flash = TestFlash::blank(SECTOR_WORDS);
            flash.cut = Some((operation, harm));
            let (promise, survived) = live(&mut flash);
            assert!(survived.is_err(), "the power went at operation {operation}");
            flash.power_up();
            cases += boot_with_cuts(&flash, &promise);
        }
    }
    println!("{} operations, {cases} boots", whole.operations);
    assert!(cases > 10_000);
}

/// Boots, with the power going at each operation of the boot in turn, and not at all. Gives the number of boots.
fn boot_with_cuts(flash: &TestFlash, promise: &Promise) -> usize {
    let mut undisturbed = flash.clone();
    undisturbed.operations = 0;
    let (mut log, found) = open(&mut undisturbed, Erase::Allowed);
    let first = numbers(&undisturbed, &found);
    assert!(promise.holds(first), "{first:?} for {promise:?}");
    let operations = undisturbed.operations;
    // Life goes on, and what was found is found again.
    save(&mut undisturbed, &mut log, Kept::Zero, 1_000).expect("power");
    let (_, found) = open(&mut undisturbed, Erase::Allowed);
    assert_eq!(numbers(&undisturbed, &found), [first[0], Some(1_000), first[2], first[3]]);

    for operation in 0..operations {
        for harm in HARMS {
            let mut flash = flash.clone();
            flash.cut = Some((operation, harm));
            let (_, _) = open(&mut flash, Erase::Allowed);
            assert!(flash.dead);
            flash.power_up();
            let (_, found) = open(&mut flash, Erase::Allowed);
            assert_eq!(numbers(&flash, &found), first, "cut again at operation {operation}, {harm:?}");
        }
    }
    1 + operations * HARMS.len()
}

/// One bit of the word at the cut, or three, read now so, now so, in every order of three boots: what is finished before and after is
/// found all the same.
// Shows B4.
#[test]
fn bits_that_read_now_so_now_so_hide_nothing_that_was_finished() {
    const READS: [[bool; 3]; 8] = {
        let mut all = [[false; 3]; 8];
        let mut n = 0;
        while n < 8 {
            all[n] = [n & 1 != 0, n & 2 != 0, n & 4 != 0];
            n += 1;
        }
        all
    };
    let mut whole = TestFlash::blank(SECTOR_WORDS);
    live(&mut whole).1.expect("power");
    let mut cases = 0;
    // Saves and the boots between them, up to the first erase and beyond.
    for operation in 0..whole.operations / 2 {
        for bit in 0..32 {
            // One bit, or three.
            for (mask, others) in [(1, false), (1, true), (0x0401_0001, false), (0x0401_0001, true)] {
                let mask = u32::rotate_left(mask, bit);
                let mut cut = TestFlash::blank(SECTOR_WORDS);
                cut.cut = Some((operation, Harm::Marginal(mask, others)));
                let (promise, survived) = live(&mut cut);
                assert!(survived.is_err());
                cut.power_up();
                for reads in READS {
                    cases += 1;
                    let mut flash = cut.clone();
                    for (read, n) in reads.into_iter().zip([1_000, 1_001, 1_002]) {
                        flash.weak_reads_programmed = read;
                        let (mut log, found) = open(&mut flash, Erase::Allowed);
                        let now = numbers(&flash, &found);
                        let at = format!("operation {operation}, bits {mask:#x}, {others}, {reads:?} at {n}");
                        if n > 1_000 {
                            assert_eq!(now[Kept::Zero as usize], Some(n - 1), "{at}");
                        }
                        let mut before = now;
                        before[Kept::Zero as usize] = promise.finished[Kept::Zero as usize];
                        assert!(promise.holds(before), "{at}: {now:?} for {promise:?}");
                        save(&mut flash, &mut log, Kept::Zero, n).expect("power");
                    }
                }
            }
        }
    }
    println!("{cases} histories");
}

/// The test above can fail: a record counts by its commit word alone, and without it the older one does.
#[test]
fn a_record_without_its_last_word_does_not_count() {
    let mut flash = TestFlash::blank(SECTOR_WORDS);
    let (mut log, _) = open(&mut flash, Erase::Allowed);
    let words = save(&mut flash, &mut log, Kept::Zero, 1).expect("power");
    let payload = super::payload(Kept::Zero, 2);
    let mut saving = log.begin(Kept::Zero, &payload).expect("room");
    for _ in 0..words - 1 {
        assert_eq!(saving.step(&mut flash), Ok(false));
    }
    let (_, before) = open(&mut flash, Erase::Allowed);
    assert_eq!(numbers(&flash, &before), [None, Some(1), None, None]);
    assert!(before.is_damaged(Kept::Zero) && !before.is_damaged(Kept::Network));
    assert_eq!(saving.step(&mut flash), Ok(true));
    let (_, after) = open(&mut flash, Erase::Allowed);
    assert_eq!(numbers(&flash, &after), [None, Some(2), None, None]);
    assert!(!after.is_damaged(Kept::Zero));
}
