//! A gripper that nobody wears: its reflex works without myosensors, if somebody said so. A muscle that is there all the
//! same keeps every right of a wearer's.

use tenax_hal_shim::channel::{MYO_EXTENSOR, MYO_FLEXOR};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Down, EventKind, Refusal};
use tenax_hal_shim::words::{GripMode, Kept};
use tenax_host_tests::{Bench, set};
use tenax_logic::config::Config;
use tenax_logic::fingertip::Fingertip;
use tenax_logic::setting::SettingId;
use tenax_logic::store::payload;

/// A board that was told so before it was last switched off, or was not; its myosensors are not fitted.
fn gripper(seed: u64, no_wearer: bool) -> Bench {
    let mut config = Config { line_trusted: true, ..Config::default() };
    config.set(SettingId::NoWearer, no_wearer.into()).unwrap();
    let mut bench = Bench::of(Fingertip::default(), seed);
    bench.fingertip.restore(Kept::Settings, &payload::of_settings(&config));
    bench.pins_mv[MYO_FLEXOR] = 0.0;
    bench.pins_mv[MYO_EXTENSOR] = 0.0;
    bench.run(800);
    bench.load(4.0, 0.6);
    bench.run(800);
    bench
}

// Shows R8.
#[test]
fn without_myosensors_the_reflex_works_where_nobody_wears_the_hand_and_nowhere_else() {
    for no_wearer in [true, false] {
        let mut bench = gripper(51, no_wearer);
        assert_eq!(bench.fingertip.mode() == GripMode::Watch, no_wearer);
        let told: Vec<_> = bench.events.iter().filter(|e| matches!(e.kind, EventKind::NoWearer(_))).collect();
        assert_eq!(told.len(), usize::from(no_wearer), "told at the start");
        assert!(told.iter().all(|event| event.frame < 10 && event.kind == EventKind::NoWearer(true)));
        bench.vibration_mv = 400.0;
        bench.run(400);
        assert_eq!(bench.by_reflex() > 20, no_wearer);
    }
}

// Shows W1.
#[test]
fn a_muscle_that_is_there_all_the_same_comes_first() {
    let mut bench = Bench::holding(52);
    bench.fingertip.command(&set(SettingId::NoWearer, 1)).unwrap();
    bench.vibration_mv = 400.0;
    bench.run(400);
    assert!(bench.by_reflex() > 20, "the control");
    bench.muscles(400.0, 50.0);
    bench.run(50);
    bench.slows.clear();
    bench.run(2_000);
    assert_eq!(bench.by_reflex(), 0, "silent while it is active");
    bench.muscles(50.0, 900.0);
    assert!(bench.run(50).iter().any(|drive| drive.opens()), "and it opens");
}

// Shows R8.
#[test]
fn only_somebody_at_the_hand_says_that_nobody_wears_it() {
    let mut bench = Bench::of(Fingertip::default(), 53);
    bench.run(400);
    // Just switched on and empty: that consents to a drive, not to this.
    let drive = Down::Drive { drive: MotorDrive::Coast, hold_ms: 10 };
    assert_eq!(bench.fingertip.command(&drive), Ok(()));
    assert_eq!(bench.fingertip.command(&set(SettingId::NoWearer, 1)), Err(Refusal::NotArmed));
    bench.fingertip.button(true);
    bench.run(100);
    bench.fingertip.button(false);
    bench.run(100);
    assert_eq!(bench.fingertip.command(&set(SettingId::NoWearer, 1)), Ok(()));
    bench.run(100);
    assert_eq!(bench.fingertip.command(&set(SettingId::NoWearer, 0)), Ok(()));
    bench.run(100);
    let told = bench.events.iter().filter_map(|event| match event.kind {
        EventKind::NoWearer(none) => Some(none),
        _ => None,
    });
    assert_eq!(told.collect::<Vec<_>>(), [true, false]);
}
