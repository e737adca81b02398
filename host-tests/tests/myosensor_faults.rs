//! The whole hand, holding a glass, under faults of a myosensor: nothing opens it, nothing squeezes without end, each fault is reported.

use tenax_hal_shim::channel::{MYO_EXTENSOR, MYO_FLEXOR};
use tenax_hal_shim::words::Reason::{self, Flat, Hum, NoContact, Saturated};
use tenax_host_tests::{Bench, closing_frames, opened_mm, opens};

/// Largest opening by a fault, mm. Below the wearer's opening level a fault opens nothing.
const SAFE_MM: f64 = 0.75;

fn reasons(bench: &Bench, channel: usize) -> Vec<Reason> {
    bench.lost(channel).into_iter().map(|(_, reason)| reason).collect()
}

// Shows W4, W5.
#[test]
fn a_lifted_electrode_never_opens_a_hand_that_holds_nor_squeezes_without_end() {
    for mv in [160.0, 165.0, 180.0, 200.0, 300.0, 400.0, 450.0, 500.0, 600.0, 800.0, 1_500.0, 2_900.0] {
        let mut bench = Bench::holding(21);
        bench.lift(MYO_EXTENSOR, mv);
        let mm = opened_mm(&bench.run(20_000));
        assert!(mm <= if mv < 220.0 { 0.0 } else { SAFE_MM }, "{mv} mV: opens by {mm} mm");
        let told = reasons(&bench, MYO_EXTENSOR);
        assert!(matches!(told[..], [Flat | Hum | Saturated, ..]), "{mv} mV: {told:?}");

        let mut bench = Bench::holding(23);
        bench.lift(MYO_FLEXOR, mv);
        let closes = closing_frames(&bench.run(20_000));
        assert!(closes <= 200, "{mv} mV: closes for {closes} frames");
        assert!(!reasons(&bench, MYO_FLEXOR).is_empty(), "{mv} mV");
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
        assert!(reasons(&bench, MYO_EXTENSOR).contains(&NoContact), "{tone_mv} mV");
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
        assert!(!reasons(&bench, MYO_EXTENSOR).is_empty(), "{mv_per_s} mV/s");
    }
}
