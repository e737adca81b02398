//! Steady sliding far below S1: heard above each film's own floor, answered with small pulses, as long as they help.

use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::words::Cause;
use tenax_host_tests::{Bench, closed_mm, set};
use tenax_logic::setting::SettingId;

/// Vibration of an object that rubs, mV: a quarter of S1.
const RUBS_MV: f64 = 35.0;
const LOAD_N: f64 = 4.0;

#[test]
fn a_quiet_slip_that_the_array_feels_is_answered_and_an_object_that_is_held_refutes_it() {
    let mut bench = Bench::holding(61);
    bench.load(LOAD_N, 0.25 * LOAD_N);
    bench.run(2_000);
    assert_eq!(bench.by_reflex(), 0);
    (bench.vibration_mv, bench.sliding_mv) = (100.0, 60.0);
    bench.run(1_000);
    assert!(bench.by_reflex() > 0, "{:?}", bench.causes());
    let mut load_n = LOAD_N;
    for _ in 0..4_000 {
        // Held: shear stays as it is.
        bench.load(load_n, 0.25 * LOAD_N);
        load_n += closed_mm(bench.step());
    }
    assert!((1.05 * LOAD_N..1.55 * LOAD_N).contains(&load_n), "{load_n} N");
}

/// Final force of a hand that hears sliding in so many of 1,200 frames, N, on an object of so many N/mm under this shear, N.
fn ends_at(n_per_mm: f64, rubs_frames: u32, shear_n: fn(f64) -> f64) -> f64 {
    let mut bench = Bench::holding(64);
    bench.run(2_000);
    let mut load_n = LOAD_N;
    for frame in 0..60_000 {
        bench.vibration_mv = if frame % 1_200 < rubs_frames { RUBS_MV } else { 0.0 };
        bench.load(load_n, shear_n(load_n));
        load_n += n_per_mm * closed_mm(bench.step());
    }
    load_n
}

// Shows R4.
#[test]
fn closing_that_does_not_help_ends_at_half_as_much_again() {
    for (n_per_mm, rubs_frames) in [0.3, 1.0, 2.0, 3.0].into_iter().flat_map(|n| [(n, 700), (n, 1_200)]) {
        // A sliding object carries as much as friction lets it.
        let slides_n = ends_at(n_per_mm, rubs_frames, |load_n| 0.15 * load_n);
        println!("{n_per_mm} N/mm, {rubs_frames}: {slides_n:.3} N");
        assert!((LOAD_N + 1.0..=1.5 * LOAD_N + 1.0).contains(&slides_n), "{slides_n} N at {n_per_mm} N/mm");
    }
    // A held object carries its weight, however the hand closes: the films are wrong.
    let held_n = ends_at(0.3, 1_200, |_| 0.15 * LOAD_N);
    assert!((LOAD_N + 0.1..1.5 * LOAD_N).contains(&held_n), "{held_n} N");
}

#[test]
fn with_s1_deaf_to_it_a_slip_far_above_the_films_floors_is_answered_still() {
    let mut bench = Bench::holding(65);
    bench.accepts(set(SettingId::S1, 600));
    bench.run(2_000);
    bench.vibration_mv = 300.0;
    bench.run(1_000);
    assert!(bench.by_reflex() > 0);
}
#[test]
fn vibration_of_an_empty_hand_leaves_slip_of_the_next_grasp_believed() {
    let mut bench = Bench::new(67);
    bench.run(2_000);
    bench.vibration_mv = 300.0;
    bench.run(1_300);
    bench.vibration_mv = 0.0;
    bench.run(400);
    bench.load(LOAD_N, 0.2 * LOAD_N);
    bench.run(1_200);
    bench.vibration_mv = 300.0;
    bench.run(300);
    assert!(bench.causes().contains(&Cause::Slip(DetectorId::S1)), "{:?}", bench.causes());
}
