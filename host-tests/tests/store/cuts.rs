use tenax_hal_shim::words::Kept;
use tenax_logic::store::{Erase, open};

use super::flash::{HARMS, Harm, TestFlash};
use super::{Numbers, booted, numbers, save};

const SECTOR_WORDS: usize = 80;
const SAVES: u32 = 60;
const SESSION: u32 = 4;

#[derive(Clone, Debug, Default)]
struct Promise {
    finished: Numbers,
    begun: Option<(Kept, u32)>,
}

impl Promise {
    fn holds(&self, found: Numbers) -> bool {
        Kept::ALL.into_iter().zip(found).all(|(kept, found)| {
            found == self.finished[kept as usize]
                || self.begun.is_some_and(|(begun, n)| begun == kept && found == Some(n))
        })
    }
}

fn live(flash: &mut TestFlash) -> (Promise, bool) {
    let mut promise = Promise::default();
    for n in 0..SAVES {
        if n % SESSION == 0 {
            let found = booted(flash);
            if flash.dead {
                return (promise, false);
            }
            assert_eq!(found, promise.finished);
        }
        let (mut log, _) = open(flash, Erase::Allowed);
        if flash.dead {
            return (promise, false);
        }
        let kept = Kept::ALL[(n * n % 3 + n / 16 % 2) as usize];
        promise.begun = Some((kept, n));
        if save(flash, &mut log, kept, n).is_err() {
            return (promise, false);
        }
        promise.finished[kept as usize] = Some(n);
        promise.begun = None;
    }
    (promise, true)
}

fn cut_at(operation: usize, harm: Harm) -> (TestFlash, Promise) {
    let mut flash = TestFlash::blank(SECTOR_WORDS);
    flash.cut = Some((operation, harm));
    let (promise, survived) = live(&mut flash);
    assert!(!survived, "the power went at operation {operation}");
    flash.power_up();
    (flash, promise)
}

fn operations() -> usize {
    let mut whole = TestFlash::blank(SECTOR_WORDS);
    assert!(live(&mut whole).1);
    assert!(whole.erases[0] >= 3 && whole.erases[1] >= 3, "{:?} sectors were worn", whole.erases);
    whole.operations
}

// Shows B4.
#[test]
fn any_cut_leaves_the_old_or_the_new() {
    let mut cases = 0;
    for operation in 0..operations() {
        for harm in HARMS {
            let (flash, promise) = cut_at(operation, harm);
            cases += boot_with_cuts(&flash, &promise);
        }
    }
    assert!(cases > 10_000, "{cases} boots");
}

fn boot_with_cuts(flash: &TestFlash, promise: &Promise) -> usize {
    let mut undisturbed = flash.clone();
    undisturbed.operations = 0;
    let (mut log, found) = open(&mut undisturbed, Erase::Allowed);
    let first = numbers(&undisturbed, &found);
    assert!(promise.holds(first), "{first:?} for {promise:?}");
    let operations = undisturbed.operations;
    save(&mut undisturbed, &mut log, Kept::Zero, 1_000).expect("power");
    assert_eq!(booted(&mut undisturbed), [first[0], Some(1_000), first[2], first[3]]);

    for operation in 0..operations {
        for harm in HARMS {
            let mut flash = flash.clone();
            flash.cut = Some((operation, harm));
            open(&mut flash, Erase::Allowed);
            assert!(flash.dead);
            flash.power_up();
            assert_eq!(booted(&mut flash), first, "cut again at operation {operation}, {harm:?}");
        }
    }
    1 + operations * HARMS.len()
}

/// One bit of the word at the cut, or three, read differently in each of three boots.
// Shows B4.
#[test]
fn bits_that_read_differently_each_time_hide_nothing_that_was_finished() {
    // Saves and the boots between them, up to the first erase and beyond.
    for operation in 0..operations() / 2 {
        for bit in 0..32 {
            for (mask, others) in [(1, false), (1, true), (0x0401_0001, false), (0x0401_0001, true)] {
                let mask = u32::rotate_left(mask, bit);
                let (cut, promise) = cut_at(operation, Harm::Marginal(mask, others));
                for reads in 0..8 {
                    let mut flash = cut.clone();
                    for boot in 0..3 {
                        flash.weak_reads_programmed = reads >> boot & 1 != 0;
                        let (mut log, found) = open(&mut flash, Erase::Allowed);
                        let now = numbers(&flash, &found);
                        let at =
                            format!("operation {operation}, bits {mask:#x}, {others}, {reads:#b} at {boot}");
                        if boot > 0 {
                            assert_eq!(now[Kept::Zero as usize], Some(1_000 + boot - 1), "{at}");
                        }
                        let mut before = now;
                        before[Kept::Zero as usize] = promise.finished[Kept::Zero as usize];
                        assert!(promise.holds(before), "{at}: {now:?} for {promise:?}");
                        save(&mut flash, &mut log, Kept::Zero, 1_000 + boot).expect("power");
                    }
                }
            }
        }
    }
}
