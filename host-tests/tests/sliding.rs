//! Steady sliding far below S1: heard above each film's own floor, answered with small pulses, as long as they help.

use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::words::Cause;
use tenax_host_tests::{Bench, closed_mm, set};
use tenax_logic::setting::SettingId;

/// Vibration of an object that rubs, mV: a quarter of S1.
const RUBS_MV: f64 = 35.0;
const LOAD_N: f64 = 4.0;

#[test]
fn an_object_that_rubs_quietly_is_held_more_firmly_with_small_pulses() {
    let mut bench = Bench::holding(61);
    bench.run(2_000);
    assert_eq!(bench.by_reflex(), 0);
    bench.vibration_mv = RUBS_MV;
    let drives = bench.run(2_000);
    assert_eq!(bench.causes().last(), Some(&Cause::PulseOver));
    assert!(bench.causes().contains(&Cause::Incipient(DetectorId::S1)));
    let fast = |drive: &MotorDrive| matches!(drive, MotorDrive::Close(duty) if duty.as_per_mille() > 500);
    assert!(!drives.iter().any(fast), "no pulse at full speed");
}

/// Final force of a hand that hears sliding all the time, N, on an object of so many N/mm under this shear, N.
fn ends_at(n_per_mm: f64, shear_n: fn(f64) -> f64) -> f64 {
    let mut bench = Bench::holding(64);
    bench.run(2_000);
    bench.vibration_mv = RUBS_MV;
    let mut load_n = LOAD_N;
    for _ in 0..40_000 {
        bench.load(load_n, shear_n(load_n));
        load_n += n_per_mm * closed_mm(bench.step());
    }
    load_n
}

// Shows R4.
#[test]
fn closing_that_does_not_help_ends_at_half_as_much_again() {
    // A sliding object carries as much as friction lets it.
    let slides_n = ends_at(3.0, |load_n| 0.15 * load_n);
    assert!((LOAD_N + 1.0..1.5 * LOAD_N + 4.0).contains(&slides_n), "{slides_n} N");
    // A held object carries its weight, however the hand closes: the films are wrong.
    let [slides_n, held_n] = [|load_n| 0.15 * load_n, |_| 0.15 * LOAD_N].map(|shear_n| ends_at(0.3, shear_n));
    println!("{slides_n:.1} N as it slides, {held_n:.1} N held");
    assert!((LOAD_N + 0.1..slides_n - 0.5).contains(&held_n), "{held_n} N");
}

#[test]
fn with_s1_deaf_to_it_a_loud_slip_is_a_warning_still() {
    let mut bench = Bench::holding(65);
    bench.accepts(set(SettingId::S1, 250));
    bench.run(2_000);
    bench.vibration_mv = 300.0;
    bench.run(1_000);
    assert!(!bench.causes().contains(&Cause::Slip(DetectorId::S1)), "deaf by its threshold");
    assert!(bench.causes().contains(&Cause::Incipient(DetectorId::S1)));
}
