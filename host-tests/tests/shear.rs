//! Shear that foretells slip: it warns, is answered with small pulses, and asks for no more than half as much force again in a
//! grasp in which nothing is known to slip.

use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::Cause;
use tenax_host_tests::teaching::{SLIP_MV, SLIPS_UP};
use tenax_host_tests::{Bench, set};
use tenax_logic::setting::SettingId;

/// What is held, N.
const LOAD_N: f64 = 4.0;
/// Ft/Fn at which something slippery slipped, and that of something rough, which holds.
const SLIPPERY: f64 = 0.15;
const ROUGH: f64 = 2.0 * SLIPPERY;
/// Against 0.3 N/mm, at 120 mm/s, N a tick.
const CLOSES_N: f64 = 0.018;
/// A small pulse: 15 ms at 0.4 of it, and what the motor still turns.
const PULSE_N: f64 = 0.4;

/// The network alone moves the hand. It has learned on something slippery, then let go.
fn taught_on_something_slippery(seed: u64) -> Bench {
    println!("seed {seed}");
    let mut bench = Bench::taught(seed);
    // A pulse in a lesson would end it.
    bench.fingertip.act_on(DetectorSet::NONE);
    bench.load(LOAD_N, SLIPPERY * LOAD_N);
    bench.vibration_mv = SLIP_MV;
    bench.teach(SLIPS_UP, 45);
    bench.vibration_mv = 0.0;
    bench.load(0.0, 0.0);
    bench.run(2_000);
    bench.fingertip.act_on(DetectorSet::only(DetectorId::Hebbian));
    bench.events.clear();
    bench
}

fn looking_ahead(mut bench: Bench, ms: i32) -> Bench {
    bench.fingertip.command(&set(SettingId::HebbianAhead, ms)).expect("in its range");
    bench
}

/// So many ticks with this shear on the fingers; what the fingers press with in the end, N.
fn held(bench: &mut Bench, from_n: f64, shear_n: f64, ticks: u32) -> f64 {
    let mut load_n = from_n;
    for _ in 0..ticks {
        bench.load(load_n, shear_n);
        if let MotorDrive::Close(duty) = bench.step() {
            load_n += CLOSES_N * f64::from(duty.as_per_mille()) / 1e3;
        }
    }
    load_n
}

/// How often the network said slip, and warned, so that the reflex answered.
fn answered(bench: &Bench) -> (usize, usize) {
    let by = |wanted: Cause| {
        let is = |kind: &EventKind| matches!(kind, EventKind::Mode { cause, .. } if *cause == wanted);
        bench.events.iter().filter(|event| is(&event.kind)).count()
    };
    (by(Cause::Slip(DetectorId::Hebbian)), by(Cause::Incipient(DetectorId::Hebbian)))
}

// Shows R4.
#[test]
fn what_was_learned_on_something_slippery_holds_something_rough_by_half_harder_at_most() {
    let mut without = looking_ahead(taught_on_something_slippery(81), 0);
    let without_n = held(&mut without, LOAD_N, ROUGH * LOAD_N, 20_000);
    assert_eq!((without_n, answered(&without)), (LOAD_N, (0, 0)), "nothing slips, and nothing is foretold");

    let mut bench = taught_on_something_slippery(81);
    let with_n = held(&mut bench, LOAD_N, ROUGH * LOAD_N, 20_000);
    let (slips, warnings) = answered(&bench);
    println!("{LOAD_N} N before, {with_n:.2} N after, {warnings} small pulses; {without_n} N without shear");
    assert!(warnings > 0, "it is near where the camera saw slip");
    assert_eq!(slips, 0, "what is foretold is no slip");
    assert!((LOAD_N..=1.5 * LOAD_N + PULSE_N).contains(&with_n), "{with_n} N");
    // It stays so for as long as it is held, however the shear swings.
    let mut swung_n = with_n;
    for swing in 0..20 {
        let part = if swing % 2 == 0 { 1.2 } else { 0.8 };
        swung_n = held(&mut bench, swung_n, part * ROUGH * LOAD_N, 800);
    }
    assert!(swung_n <= 1.5 * LOAD_N + PULSE_N, "{swung_n} N after 20 swings");
}

#[test]
fn a_slip_that_is_heard_a_lesson_and_another_grasp_begin_anew() {
    let mut bench = taught_on_something_slippery(82);
    let first_n = held(&mut bench, LOAD_N, ROUGH * LOAD_N, 8_000);
    bench.vibration_mv = SLIP_MV;
    let slipped_n = held(&mut bench, first_n, ROUGH * LOAD_N, 100);
    bench.vibration_mv = 0.0;
    let heard_n = held(&mut bench, slipped_n, ROUGH * LOAD_N, 8_000);
    assert!(answered(&bench).0 > 0, "the films have heard it");
    assert!(heard_n > 1.5 * LOAD_N + PULSE_N, "{first_n} N, then {heard_n} N");

    let mut bench = taught_on_something_slippery(83);
    let first_n = held(&mut bench, LOAD_N, ROUGH * LOAD_N, 8_000);
    bench.teach(SLIPS_UP, 5);
    let taught_n = held(&mut bench, first_n, 1.5 * ROUGH * LOAD_N, 8_000);
    assert!(taught_n > 1.5 * LOAD_N + PULSE_N, "{first_n} N, then {taught_n} N");

    let mut bench = taught_on_something_slippery(84);
    for _ in 0..3 {
        bench.events.clear();
        held(&mut bench, LOAD_N, ROUGH * LOAD_N, 8_000);
        assert!(answered(&bench).1 > 0);
        bench.load(0.0, 0.0);
        bench.run(1_000);
    }
}

#[test]
fn a_load_that_grows_towards_the_learned_ratio_is_answered_before_it_is_there() {
    for (ms, foretold) in [(75, true), (0, false)] {
        let mut bench = looking_ahead(taught_on_something_slippery(85), ms);
        let (mut load_n, mut warned_at) = (LOAD_N, None);
        for n in 0..2_000 {
            let shear_n = SLIPPERY * LOAD_N * f64::from(n) / 2_000.0;
            load_n = held(&mut bench, load_n, shear_n, 1);
            if answered(&bench) != (0, 0) && warned_at.is_none() {
                warned_at = Some(shear_n / load_n);
            }
        }
        println!("looking {ms} ms ahead, answered at {warned_at:?}");
        assert_eq!(warned_at.is_some_and(|ratio| ratio < SLIPPERY), foretold, "{ms} ms: {warned_at:?}");
        assert_eq!(answered(&bench).0, 0);
    }
}
