//! The button at the hand, on the whole fingertip: a wearer lets go, and calibrates, without a PC.

use tenax_hal_shim::channel::{MYO_EXTENSOR, MYO_FLEXOR};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{Calibration, CalibrationRefusal, DriveSource, Kept, Prompt};
use tenax_host_tests::Bench;

fn press(bench: &mut Bench, frames: u32) -> Vec<MotorDrive> {
    bench.fingertip.button(true);
    let mut drives = bench.run(frames);
    bench.fingertip.button(false);
    drives.extend(bench.run(200));
    drives
}

fn opens(drives: &[MotorDrive]) -> usize {
    drives.iter().filter(|drive| drive.opens()).count()
}

/// Frames of a second in which the light is on.
fn lit(bench: &mut Bench) -> usize {
    (0..2_000).filter(|_| bench.run(1).len() == 1 && bench.fingertip.light()).count()
}

// Shows W8.
#[test]
fn a_wearer_whose_electrodes_are_both_dead_lets_go_by_the_button() {
    for dead_mv in [0.0, 3_300.0, 1_000.0] {
        let mut bench = Bench::holding(41);
        bench.pins_mv[MYO_FLEXOR] = dead_mv;
        bench.pins_mv[MYO_EXTENSOR] = dead_mv;
        bench.run(8_000);
        press(&mut bench, 2_400);
        bench.slows.clear();
        let drives = bench.run(2_000);
        assert_eq!(opens(&drives), 2_000, "{dead_mv} mV");
        assert!(
            drives.iter().all(|drive| matches!(drive, MotorDrive::Open(duty) if duty.as_per_mille() <= 300))
        );
        let sources = bench.slows.iter().flat_map(|slow| slow.ticks.iter().map(|tick| tick.source));
        assert!(sources.skip(1).all(|source| source == DriveSource::Wearer));
        // It ends with what it held, soon after.
        bench.load(0.0, 0.0);
        bench.run(1_500);
        assert_eq!(opens(&bench.run(4_000)), 0, "{dead_mv} mV");
    }
}

#[test]
fn a_second_press_or_a_contraction_that_closes_ends_a_release() {
    let mut bench = Bench::holding(42);
    press(&mut bench, 2_400);
    assert_eq!(opens(&bench.run(100)), 100);
    bench.fingertip.button(true);
    bench.run(100);
    assert_eq!(opens(&bench.run(4_000)), 0);
    bench.fingertip.button(false);
    bench.run(400);
    press(&mut bench, 2_400);
    bench.muscles(900.0, 95.0);
    bench.run(1_000);
    assert_eq!(opens(&bench.run(1_000)), 0);
}

// Shows W8.
#[test]
fn a_button_that_is_shorted_tapped_or_held_for_too_long_opens_nothing() {
    let mut bench = Bench::holding(43);
    assert_eq!(opens(&press(&mut bench, 200)), 0, "a tap");
    assert_eq!(opens(&press(&mut bench, 7_000)), 0, "3.5 s");
    bench.fingertip.button(true);
    assert_eq!(opens(&bench.run(60_000)), 0, "a short");
}

#[test]
fn an_empty_hand_calibrates_by_the_button_and_keeps_it() {
    let mut bench = Bench::new(44);
    bench.run(1_000);
    let mut keeper = bench.fingertip.keeper();
    press(&mut bench, 6_200);
    let asked = |bench: &Bench, prompt: Prompt| {
        bench.events.iter().any(|event| event.kind == EventKind::Calibration(Calibration::Asks(prompt)))
    };
    assert!(asked(&bench, Prompt::Rest) && !asked(&bench, Prompt::Close));
    assert!((190..=210).contains(&lit(&mut bench)), "a flash a second");
    bench.run(8_000);
    for (prompt, flexor_mv, extensor_mv) in [(Prompt::Close, 700.0, 90.0), (Prompt::Open, 90.0, 800.0)] {
        assert!(asked(&bench, prompt));
        bench.muscles(flexor_mv, extensor_mv);
        bench.run(2_000);
        let parts = if prompt == Prompt::Close { 2_000..=2_000 } else { 900..=1_100 };
        assert!(parts.contains(&lit(&mut bench)), "{prompt:?}");
        bench.run(6_000);
    }
    bench.muscles(50.0, 50.0);
    bench.run(1_000);
    assert_eq!(lit(&mut bench), 2_000, "taken");
    bench.run(2_000);
    assert_eq!(lit(&mut bench), 0);
    let told: Vec<_> =
        bench.events.iter().filter(|event| matches!(event.kind, EventKind::Calibration(_))).collect();
    assert!(
        matches!(told.last().map(|event| event.kind), Some(EventKind::Calibration(Calibration::Done { .. }))),
        "{told:?}"
    );
    let saved: Vec<Kept> =
        std::iter::from_fn(|| bench.fingertip.next_record(&mut keeper)).map(|record| record.kept()).collect();
    assert!(saved.contains(&Kept::Emg), "{saved:?}");
}

#[test]
fn a_second_press_ends_a_calibration_and_the_old_one_stays() {
    let mut bench = Bench::new(45);
    bench.run(1_000);
    let before = bench.fingertip.keeper();
    press(&mut bench, 6_200);
    bench.run(2_000);
    bench.events.clear();
    press(&mut bench, 200);
    let kinds: Vec<EventKind> = bench.events.iter().map(|event| event.kind).collect();
    let stopped = EventKind::Calibration(Calibration::Refused(CalibrationRefusal::Stopped));
    assert!(kinds.contains(&stopped), "{kinds:?}");
    // The muscles move the hand again, as before.
    bench.muscles(900.0, 95.0);
    assert!(bench.run(2_000).iter().any(|drive| drive.closes()));
    let mut keeper = before;
    let saved: Vec<Kept> =
        std::iter::from_fn(|| bench.fingertip.next_record(&mut keeper)).map(|record| record.kept()).collect();
    assert!(!saved.contains(&Kept::Emg), "{saved:?}");
}
