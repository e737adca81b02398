//! Shear that foretells slip: it warns, is answered with small pulses, and adds at most half of the force in a grasp in which
//! nothing is known to slip.

use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::words::Cause;
use tenax_host_tests::teaching::{SLIP_MV, SLIPS_UP};
use tenax_host_tests::{Bench, closed_mm, set};
use tenax_logic::setting::SettingId;

const LOAD_N: f64 = 4.0;
/// Ft/Fn at which something slippery slipped, and that of something rough, which holds.
const SLIPPERY: f64 = 0.15;
const ROUGH: f64 = 2.0 * SLIPPERY;
const N_PER_MM: f64 = 0.3;
/// A small pulse, N: 15 ms at a duty of 0.4, and the motor's after-run.
const PULSE_N: f64 = 0.4;

/// A hand that only the network moves: it has learned on something slippery, then let go.
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

fn held(bench: &mut Bench, mut load_n: f64, shear_n: f64, frames: u32) -> f64 {
    for _ in 0..frames {
        bench.load(load_n, shear_n);
        load_n += N_PER_MM * closed_mm(bench.step());
    }
    load_n
}

fn answered(bench: &Bench) -> (usize, usize) {
    let by = |wanted: Cause| bench.causes().iter().filter(|cause| **cause == wanted).count();
    (by(Cause::Slip(DetectorId::Hebbian)), by(Cause::Incipient(DetectorId::Hebbian)))
}

// Shows R4.
#[test]
fn what_was_learned_on_something_slippery_holds_something_rough_by_half_harder_at_most() {
    let mut without = taught_on_something_slippery(81);
    without.accepts(set(SettingId::HebbianAhead, 0));
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
