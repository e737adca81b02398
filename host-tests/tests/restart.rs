//! Why the chip started: every reset in any order is told right, and counted where the hand brought it about.

use proptest::prelude::*;
use tenax_hal_shim::wire::ResetCause;
use tenax_hal_shim::words::Fault;
use tenax_logic::restart::{Flags, Mark, RESTARTS_MAX, judge};

const NONE: Flags = Flags { power_on: false, brown_out: false, watchdog: false, software: false, pin: true };

/// Every reset by itself, as the manual says that its flags are, and what is to be told of it.
const RESETS: [(Flags, Option<Mark>, ResetCause, Option<Fault>); 8] = [
    (Flags { power_on: true, brown_out: true, ..NONE }, None, ResetCause::PowerOn, None),
    (Flags { brown_out: true, ..NONE }, None, ResetCause::Other, Some(Fault::SupplySagged)),
    (Flags { watchdog: true, ..NONE }, None, ResetCause::Watchdog, Some(Fault::WatchdogReset)),
    (Flags { software: true, ..NONE }, Some(Mark::Panicked), ResetCause::Panic, Some(Fault::PanicReset)),
    (
        Flags { software: true, ..NONE },
        Some(Mark::SupplySagged),
        ResetCause::Software,
        Some(Fault::SupplySagged),
    ),
    (
        Flags { software: true, ..NONE },
        Some(Mark::CrystalLost),
        ResetCause::Software,
        Some(Fault::CrystalLost),
    ),
    (Flags { software: true, ..NONE }, None, ResetCause::Software, None),
    (NONE, None, ResetCause::Pin, None),
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1_000))]

    // Shows B2.
    #[test]
    fn resets_in_any_order_are_told_and_counted_where_the_hand_brought_them_about(
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
    fn flags_that_add_up_tell_the_reset_that_takes_most_away(all in prop::array::uniform5(any::<bool>())) {
        let [power_on, brown_out, watchdog, software, pin] = all;
        let start = judge(Flags { power_on, brown_out, watchdog, software, pin }, None, 0);
        prop_assert_eq!(start.cause == ResetCause::PowerOn, power_on);
        let sagged = start.after == Some(Fault::SupplySagged);
        prop_assert_eq!(sagged, brown_out && !power_on);
    }
}

#[test]
fn a_mark_counts_only_after_a_reset_by_software() {
    // RAM as it was at power-on may hold any word, and a pin's reset leaves what stood there.
    assert_eq!(judge(NONE, Some(Mark::Panicked), 3).after, None);
}

// Shows B2.
#[test]
fn a_hand_that_browns_out_at_each_closing_stays_off_and_one_without_a_clock_does_not() {
    let again = |flags, mark| (0..20).fold(0, |kept, _| judge(flags, mark, kept).restarts);
    assert!(again(Flags { brown_out: true, ..NONE }, None) > RESTARTS_MAX);
    assert_eq!(again(Flags { software: true, ..NONE }, Some(Mark::CrystalLost)), 0, "the control");
}
