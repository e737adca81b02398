//! Steady sliding, far below S1: heard above each film's own floor, answered gently, and no longer than it helps.

use tenax_hal_shim::channel::PVDF;
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{Cause, GripMode};
use tenax_host_tests::{Bench, set};
use tenax_logic::setting::SettingId;

/// What rubs, mV: a quarter of S1.
const RUBS_MV: f64 = 35.0;
const LOAD_N: f64 = 4.0;

#[test]
fn an_object_that_rubs_quietly_is_held_more_firmly_with_small_pulses() {
    let mut bench = Bench::holding(61);
    bench.run(2_000);
    assert_eq!(bench.by_reflex(), 0);
    bench.vibration_mv = RUBS_MV;
    let drives = bench.run(2_000);
    assert_eq!(bench.last_cause(), Some(Cause::PulseOver));
    let warned = bench.events.iter().any(|event| {
        matches!(
            event.kind,
            EventKind::Mode { to: GripMode::Incipient, cause: Cause::Incipient(DetectorId::S1), .. }
        )
    });
    assert!(warned);
    let full =
        drives.iter().filter(|drive| matches!(drive, MotorDrive::Close(duty) if duty.as_per_mille() > 500));
    assert_eq!(full.count(), 0, "no pulse at full speed");
}

// Shows R4.
#[test]
fn films_that_hummed_when_the_grasp_began_slide_no_more_than_quiet_ones() {
    let mut bench = Bench::new(62);
    bench.vibration_mv = RUBS_MV;
    bench.run(800);
    bench.load(LOAD_N, 0.4);
    bench.run(20_000);
    assert_eq!(bench.by_reflex(), 0);
    // Two that begin to hum in a grasp are their own fault.
    let mut bench = Bench::holding(63);
    bench.run(2_000);
    for n in 0..10_000u32 {
        let phase = f64::from(n) * 50.0 / 2_000.0 * std::f64::consts::TAU;
        bench.pins_mv[PVDF..PVDF + 2].fill(1_650.0 + RUBS_MV * phase.sin());
        bench.run(1);
    }
    assert_eq!(bench.by_reflex(), 0);
}

/// What the hand presses with in the end while it hears sliding all the time, N, against so many N/mm, where this shear is on a finger, N.
fn ends_at(n_per_mm: f64, shear_n: fn(f64) -> f64) -> f64 {
    let mut bench = Bench::holding(64);
    bench.run(2_000);
    bench.vibration_mv = RUBS_MV;
    let mut load_n = LOAD_N;
    for _ in 0..40_000 {
        bench.load(load_n, shear_n(load_n));
        // At 120 mm/s.
        if let MotorDrive::Close(duty) = bench.step() {
            load_n += 0.06 * n_per_mm * f64::from(duty.as_per_mille()) / 1e3;
        }
    }
    load_n
}

// Shows R4.
#[test]
fn closing_that_does_not_help_ends_at_half_as_much_again() {
    // What slides carries as much as friction lets it.
    let slides_n = ends_at(3.0, |load_n| 0.15 * load_n);
    assert!((LOAD_N + 1.0..1.5 * LOAD_N + 4.0).contains(&slides_n), "{slides_n} N");
    // What is held carries its weight, however the hand closes: the films are wrong.
    let [slides_n, held_n] = [|load_n| 0.15 * load_n, |_| 0.15 * LOAD_N].map(|shear_n| ends_at(0.3, shear_n));
    println!("{slides_n:.1} N as it slides, {held_n:.1} N held");
    assert!((LOAD_N + 0.1..slides_n - 0.5).contains(&held_n), "{held_n} N");
}

/// What a laboratory may set on a trusted line: a hand that is worn hears it (`s1-mv` goes to 150 there).
#[test]
fn with_s1_deaf_to_it_a_loud_slip_is_a_warning_still() {
    let mut bench = Bench::holding(65);
    bench.fingertip.command(&set(SettingId::S1, 250)).unwrap();
    bench.run(2_000);
    bench.vibration_mv = 300.0;
    bench.run(1_000);
    let by = |id: fn(DetectorId) -> Cause| {
        let mode =
            |kind: EventKind| matches!(kind, EventKind::Mode { cause, .. } if cause == id(DetectorId::S1));
        bench.events.iter().filter(|event| mode(event.kind)).count()
    };
    assert_eq!(by(Cause::Slip), 0, "deaf by its threshold");
    assert!(by(Cause::Incipient) > 0);
}
