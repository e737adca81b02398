//! The whole hand, holding a glass, under faults of its myosensors: nothing opens it, nothing squeezes without end, each fault is
//! reported.

use tenax_hal_shim::channel::{MYO_EXTENSOR, MYO_FLEXOR};
use tenax_hal_shim::words::Reason;
use tenax_host_tests::{Bench, closing_frames, opened_mm, opens, rests};

/// Largest opening by a fault, mm. Below the wearer's opening level a fault opens nothing.
const SAFE_MM: f64 = 0.75;

// Shows W4.
#[test]
fn a_lifted_extensor_never_opens_a_hand_that_holds() {
    for mv in [160.0, 165.0, 180.0, 200.0, 300.0, 400.0, 500.0, 600.0, 800.0, 1_500.0, 2_900.0] {
        let mut bench = Bench::holding(21);
        bench.lift(MYO_EXTENSOR, mv);
        let most_mm = if mv < 220.0 { 0.0 } else { SAFE_MM };
        let mm = opened_mm(&bench.run(20_000));
        assert!(mm <= most_mm, "{mv} mV: {mm} mm");
        let lost = bench.lost(MYO_EXTENSOR);
        let named = matches!(lost[..], [(_, Reason::Flat | Reason::Hum | Reason::Saturated), ..]);
        assert!(named, "{mv} mV: {lost:?}");
    }
}

// Shows W4.
#[test]
fn a_noisy_extensor_never_opens_a_hand_that_holds() {
    for (seed, tone_mv, part) in [(1, 80.0, 0.5), (2, 90.0, 0.4), (3, 100.0, 0.35), (4, 100.0, 0.4)] {
        let mut bench = Bench::holding(seed);
        bench.lively = part;
        bench.muscles(20.0, tone_mv);
        assert!(!opens(&bench.run(40_000)), "{tone_mv} mV");
        let lost = bench.lost(MYO_EXTENSOR);
        assert!(lost.iter().any(|(_, reason)| *reason == Reason::NoContact), "{tone_mv} mV: {lost:?}");
    }
}

// Shows W4.
#[test]
fn creep_of_the_extensor_never_opens_a_hand_that_holds() {
    for mv_per_s in [100.0, 1_000.0, 5_000.0, 30_000.0] {
        let mut bench = Bench::holding(22);
        let mut drives = Vec::new();
        for frame in 0..60_000 {
            bench.lift(MYO_EXTENSOR, (50.0 + mv_per_s * f64::from(frame) / 2_000.0).min(3_000.0));
            drives.push(bench.step());
        }
        let mm = opened_mm(&drives);
        assert!(mm <= SAFE_MM, "{mv_per_s} mV/s: opens by {mm} mm");
        assert!(!bench.lost(MYO_EXTENSOR).is_empty(), "{mv_per_s} mV/s");
    }
}

// Shows W5.
#[test]
fn a_lifted_flexor_does_not_squeeze_without_end() {
    for mv in [160.0, 200.0, 300.0, 450.0, 600.0, 1_500.0] {
        let mut bench = Bench::holding(23);
        bench.lift(MYO_FLEXOR, mv);
        let closes = closing_frames(&bench.run(20_000));
        assert!(closes <= 200, "{mv} mV: closes for {closes} frames");
        assert!(!bench.lost(MYO_FLEXOR).is_empty(), "{mv} mV");
    }
}

// Shows W5.
#[test]
fn opening_wins_over_a_flexor_that_hums() {
    let mut bench = Bench::holding(24);
    bench.lift(MYO_FLEXOR, 500.0);
    bench.run(200);
    bench.pins_mv[MYO_EXTENSOR] = 300.0 + 700.0;
    assert!(opens(&bench.run(600)), "within 0.3 s");
}

#[test]
fn both_muscles_at_once_ask_for_nothing() {
    for mv in [300.0, 500.0, 800.0, 1_500.0] {
        let mut bench = Bench::holding(25);
        bench.muscles(mv, mv);
        let drives = bench.run(4_000);
        // The flexor's first readings may come before the extensor's.
        assert!(rests(&drives[50..]), "{mv} mV");
        assert!(bench.fingertip.wearer_active(), "{mv} mV");
    }
}
