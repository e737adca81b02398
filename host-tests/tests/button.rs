//! The button at the hand: a wearer lets go, and calibrates, without a PC.

use tenax_hal_shim::channel::{MYO_EXTENSOR, MYO_FLEXOR};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{Calibration, CalibrationRefusal, DriveSource, Fit, Kept, Prompt};
use tenax_host_tests::{Bench, closes, opens};
use tenax_logic::store::keeper::Keeper;

const RELEASES: u32 = 2_400;
const CALIBRATES: u32 = 6_200;

fn opens_throughout(drives: &[MotorDrive]) -> bool {
    drives.iter().all(|drive| matches!(drive, MotorDrive::Open(duty) if duty.as_per_mille() <= 300))
}

fn lit(bench: &mut Bench) -> usize {
    (0..2_000).filter(|_| bench.run(1).len() == 1 && bench.fingertip.light()).count()
}

fn saves_calibration(bench: &mut Bench, keeper: &mut Keeper) -> bool {
    std::iter::from_fn(|| bench.fingertip.next_record(keeper)).any(|record| record.kept() == Kept::Emg)
}

// Shows W8.
#[test]
fn a_wearer_whose_electrodes_are_both_dead_lets_go_by_the_button() {
    for (dead_mv, load_n) in [(0.0, 4.0), (3_300.0, 4.0), (1_000.0, 4.0), (0.0, 0.2)] {
        let mut bench = Bench::holding(41);
        bench.load(load_n, load_n / 10.0);
        bench.pins_mv[MYO_FLEXOR..=MYO_EXTENSOR].fill(dead_mv);
        bench.run(8_000);
        bench.press_button(RELEASES);
        bench.slows.clear();
        assert!(opens_throughout(&bench.run(2_000)), "{dead_mv} mV, {load_n} N");
        assert!(bench.ticks().skip(1).all(|tick| tick.source == DriveSource::Wearer));
        // It ends with what it held, soon after.
        bench.load(0.0, 0.0);
        bench.run(1_500);
        assert!(!opens(&bench.run(4_000)), "{dead_mv} mV");
    }
}

// Shows W8.
#[test]
fn a_button_that_is_shorted_tapped_or_held_for_too_long_opens_nothing() {
    let mut bench = Bench::holding(43);
    for frames in [200, 7_000, 60_000] {
        assert!(!opens(&bench.press_button(frames)), "{frames} frames");
    }
}

#[test]
fn an_empty_hand_calibrates_by_the_button_and_keeps_it() {
    let asked = |bench: &Bench, prompt| bench.count(EventKind::Calibration(Calibration::Asks(prompt))) > 0;
    let mut bench = Bench::new(44);
    bench.run(1_000);
    let mut keeper = bench.fingertip.keeper();
    bench.press_button(CALIBRATES);
    assert!(asked(&bench, Prompt::Rest) && !asked(&bench, Prompt::Close));
    assert!((190..=210).contains(&lit(&mut bench)), "a flash a second");
    bench.run(8_000);
    for (prompt, flexor_mv, extensor_mv, lights) in
        [(Prompt::Close, 700.0, 90.0, 2_000..=2_000), (Prompt::Open, 90.0, 800.0, 900..=1_100)]
    {
        assert!(asked(&bench, prompt));
        bench.muscles(flexor_mv, extensor_mv);
        bench.run(2_000);
        assert!(lights.contains(&lit(&mut bench)), "{prompt:?}");
        bench.run(6_000);
    }
    bench.muscles(50.0, 50.0);
    bench.run(1_000);
    assert_eq!(lit(&mut bench), 2_000, "taken");
    bench.run(2_000);
    assert_eq!(lit(&mut bench), 0);
    let last = bench.kinds().filter(|kind| matches!(kind, EventKind::Calibration(_))).last();
    assert!(matches!(last, Some(EventKind::Calibration(Calibration::Done { .. }))), "{last:?}");
    assert!(saves_calibration(&mut bench, &mut keeper));
}

#[test]
fn moved_electrodes_are_learned_by_the_button_from_three_closings_and_openings() {
    let mut bench = Bench::new(46);
    bench.run(1_000);
    let contracts = |bench: &mut Bench, [flexor_mv, extensor_mv]: [f64; 2], frames: u32| {
        bench.muscles(flexor_mv, extensor_mv);
        bench.run(frames);
        bench.muscles(50.0, 50.0);
        bench.run(frames.min(1_200));
    };
    for _ in 0..12 {
        contracts(&mut bench, [600.0, 600.0], 3_000);
    }
    assert_eq!(bench.count(EventKind::Calibration(Calibration::Fit(Fit::Moved))), 1);
    bench.press_button(CALIBRATES);
    bench.run(4_000);
    for mv in [[600.0, 250.0], [300.0, 900.0]].into_iter().cycle().take(6) {
        contracts(&mut bench, mv, 2_400);
    }
    let last = bench.kinds().filter(|kind| matches!(kind, EventKind::Calibration(_))).last();
    assert!(matches!(last, Some(EventKind::Calibration(Calibration::Done { .. }))), "{last:?}");
    bench.muscles(300.0, 900.0);
    assert!(opens(&bench.run(1_000)));
}

#[test]
fn a_second_press_ends_a_calibration_and_the_old_one_stays() {
    let mut bench = Bench::new(45);
    bench.run(1_000);
    let mut keeper = bench.fingertip.keeper();
    bench.press_button(CALIBRATES);
    bench.run(2_000);
    bench.press_button(200);
    let stopped = Calibration::Refused(CalibrationRefusal::Stopped);
    assert_eq!(bench.count(EventKind::Calibration(stopped)), 1);
    // The muscles move the hand again, as before.
    bench.muscles(900.0, 95.0);
    assert!(closes(&bench.run(2_000)));
    assert!(!saves_calibration(&mut bench, &mut keeper));
}
