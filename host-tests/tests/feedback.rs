//! Duty of the vibration motor, for any input.

use proptest::prelude::*;
use tenax_hal_shim::motor::Duty;
use tenax_hal_shim::words::GripMode::{self, Incipient, Settle, Slip, Standby, Watch, Wearer};
use tenax_logic::feedback::{Feedback, Felt};

const OFF: Duty = Duty::per_mille(0);
const BURST: usize = 5;
const PATTERN: usize = 15;
const STRONG: u16 = 2;

/// Input of a slow frame, and whether the reflex begins to answer slip before it.
fn felt() -> impl Strategy<Value = (Felt, bool)> {
    let mode = prop::sample::select(vec![Standby, Wearer, Watch, Slip, Incipient, Settle]);
    let load = prop_oneof![Just(None), any::<i32>().prop_map(Some), (0..40_000).prop_map(Some)];
    (mode, load, any::<bool>(), prop::bool::weighted(0.1), prop::bool::weighted(0.1))
        .prop_map(|(mode, load_mn, unloaded, lost, slips)| (Felt { mode, load_mn, unloaded, lost }, slips))
}

fn holds(mode: GripMode, load_mn: i32) -> Felt {
    Felt { mode, load_mn: Some(load_mn), ..Felt::default() }
}

fn for_frames(feedback: &mut Feedback, frames: usize, felt: Felt) -> Vec<Duty> {
    (0..frames).map(|_| feedback.step(STRONG, &felt)).collect()
}

fn bursts(duties: &[Duty]) -> usize {
    duties.chunk_by(|a, b| (*a > OFF) == (*b > OFF)).filter(|run| run[0] > OFF).count()
}

// Shows R11.
proptest! {
    #[test]
    fn the_motor_runs_only_where_the_reflex_does_not_listen(
        choice in 0_u16..4,
        seen in prop::collection::vec(felt(), 1..400),
    ) {
        let mut feedback = Feedback::default();
        let mut since_slip = usize::MAX;
        for (felt, slips) in seen {
            since_slip = since_slip.saturating_add(1);
            if slips {
                feedback.slips();
                since_slip = 0;
            }
            let duty = feedback.step(choice, &felt);
            prop_assert!(duty <= Duty::per_mille([0, 760, 1_000, 1_000][usize::from(choice)]), "{:?}", duty);
            if duty > OFF {
                let may = match felt.mode {
                    Standby => true,
                    Wearer => !felt.unloaded,
                    Slip | Settle => since_slip < BURST,
                    Watch | Incipient => false,
                };
                prop_assert!(may, "{:?} in {:?}, {} after a slip", duty, felt, since_slip);
            }
        }
    }

    #[test]
    fn the_motor_falls_silent_when_nothing_happens(
        seen in prop::collection::vec(felt(), 0..100),
        (last, _) in felt(),
    ) {
        let mut feedback = Feedback::default();
        for (felt, slips) in seen {
            if slips {
                feedback.slips();
            }
            feedback.step(STRONG, &felt);
        }
        let last = Felt { lost: false, ..last };
        // A warning that waits may come once more, 3 s after the one before.
        for_frames(&mut feedback, 240 + PATTERN, last);
        prop_assert!(for_frames(&mut feedback, 1_000, last).iter().all(|duty| *duty == OFF));
    }
}

#[test]
fn each_doubling_of_the_force_is_one_burst_and_a_trembling_load_is_told_once() {
    let mut feedback = Feedback::default();
    let mut last = OFF;
    for newtons in [1, 2, 4, 8, 16, 32] {
        for_frames(&mut feedback, 20, holds(Wearer, newtons * 950));
        let duties = for_frames(&mut feedback, 20, holds(Wearer, newtons * 1_000));
        assert_eq!(duties.iter().filter(|duty| **duty > OFF).count(), BURST, "{newtons} N");
        assert!(duties[0] > last, "{newtons} N");
        last = duties[0];
        for _ in 0..20 {
            let down = for_frames(&mut feedback, 3, holds(Wearer, newtons * 850));
            let up = for_frames(&mut feedback, 3, holds(Wearer, newtons * 1_050));
            assert!(down.iter().chain(&up).all(|duty| *duty == OFF), "{newtons} N trembles");
        }
    }
    assert!(for_frames(&mut feedback, 20, holds(Wearer, 0)).iter().all(|duty| *duty == OFF));
    assert_eq!(bursts(&for_frames(&mut feedback, 20, holds(Wearer, 5_000))), 1, "told anew, at once");
}

#[test]
fn force_that_the_reflex_adds_is_told_by_its_slip_alone() {
    let mut feedback = Feedback::default();
    for_frames(&mut feedback, 20, holds(Wearer, 3_000));
    for_frames(&mut feedback, 20, holds(Watch, 3_000));
    feedback.slips();
    let mut duties = for_frames(&mut feedback, 3, holds(Slip, 5_000));
    duties.extend(for_frames(&mut feedback, 6, holds(Settle, 5_000)));
    duties.extend(for_frames(&mut feedback, 20, holds(Watch, 5_000)));
    assert_eq!(duties[..BURST], [Duty::FULL; BURST]);
    assert!(duties[BURST..].iter().all(|duty| *duty == OFF));
    feedback.slips();
    assert_eq!(bursts(&for_frames(&mut feedback, 9, holds(Slip, 5_000))), 0, "0.36 s after the first");
    for_frames(&mut feedback, 40, holds(Watch, 5_000));
    feedback.slips();
    assert_eq!(bursts(&for_frames(&mut feedback, 9, holds(Slip, 5_000))), 1);
}

#[test]
fn a_loss_is_two_bursts_that_wait_until_the_reflex_does_not_listen() {
    let mut feedback = Feedback::default();
    let lost = |felt| Felt { lost: true, ..felt };
    for (frames, felt, expected) in [
        (1, lost(holds(Watch, 500)), 0),
        (1_000, holds(Watch, 500), 0),
        (1_000, holds(Wearer, 500), 2),
        // Each 3 s.
        (1_000, lost(holds(Standby, 0)), 10),
    ] {
        assert_eq!(bursts(&for_frames(&mut feedback, frames, felt)), expected, "{felt:?}");
    }
}
