//! The cause of a start: named after resets in any order, and counted where the hand brought the reset about.

use proptest::prelude::*;
use tenax_hal_shim::wire::ResetCause;
use tenax_hal_shim::words::Fault;
use tenax_logic::restart::{Flags, Mark, RESTARTS_MAX, judge};

const PIN: Flags = Flags { power_on: false, brown_out: false, watchdog: false, software: false, pin: true };
const SOFTWARE: Flags = Flags { software: true, ..PIN };
const BROWN_OUT: Flags = Flags { brown_out: true, ..PIN };

/// Every reset alone, with the flags that the chip's manual states, its cause and the fault that is reported.
const RESETS: [(Flags, Option<Mark>, ResetCause, Option<Fault>); 8] = [
    (Flags { power_on: true, ..BROWN_OUT }, None, ResetCause::PowerOn, None),
    (BROWN_OUT, None, ResetCause::Other, Some(Fault::SupplySagged)),
    (Flags { watchdog: true, ..PIN }, None, ResetCause::Watchdog, Some(Fault::WatchdogReset)),
    (SOFTWARE, Some(Mark::Panicked), ResetCause::Panic, Some(Fault::PanicReset)),
    (SOFTWARE, Some(Mark::SupplySagged), ResetCause::Software, Some(Fault::SupplySagged)),
    (SOFTWARE, Some(Mark::CrystalLost), ResetCause::Software, Some(Fault::CrystalLost)),
    (SOFTWARE, None, ResetCause::Software, None),
    (PIN, None, ResetCause::Pin, None),
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1_000))]

    // Shows B2.
    #[test]
    fn resets_in_any_order_are_named_and_counted_where_the_hand_brought_them_about(
        row in prop::collection::vec(0..RESETS.len(), 1..40), stale in any::<u8>(),
    ) {
        let (mut kept, mut counted) = (u32::from(stale), u32::from(stale));
        for number in row {
            let (flags, mark, cause, fault) = RESETS[number];
            let start = judge(flags, mark, kept);
            counted = match fault {
                None => 0,
                Some(Fault::CrystalLost) => counted.min(RESTARTS_MAX),
                Some(_) => counted + 1,
            };
            prop_assert_eq!(start.cause, cause);
            prop_assert_eq!(start.restarts, counted);
            prop_assert_eq!(start.stay_off, counted > RESTARTS_MAX);
            prop_assert_eq!(start.after, if start.stay_off { Some(Fault::TooManyRestarts) } else { fault });
            kept = start.restarts;
        }
    }

    #[test]
    fn of_several_flags_the_reset_that_erases_most_is_named(all in prop::array::uniform5(any::<bool>())) {
        let [power_on, brown_out, watchdog, software, pin] = all;
        let start = judge(Flags { power_on, brown_out, watchdog, software, pin }, None, 0);
        prop_assert_eq!(start.cause == ResetCause::PowerOn, power_on);
        prop_assert_eq!(start.after == Some(Fault::SupplySagged), brown_out && !power_on);
    }
}

#[test]
fn a_mark_counts_only_after_a_reset_by_software() {
    // RAM at power-on may hold any word, and a pin's reset leaves an old one.
    assert_eq!(judge(PIN, Some(Mark::Panicked), 3).after, None);
}
