//! A taught Hebbian network on the bench, learning and in use at once.

use tenax_hal_shim::channel::{SAMPLE_MAX, STRAIN, STRAIN_COUNT};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::wire::Down;
use tenax_hal_shim::words::Cause;
use tenax_host_tests::teaching::{AGE_MS, PICTURE_FRAMES, SLIP_MV, SLIPS_UP};
use tenax_host_tests::{Bench, closes};
use tenax_logic::config::Config;
use tenax_logic::store::record::PAYLOAD_BYTES;

#[test]
fn untaught_it_says_nothing_and_taught_it_answers_a_slip_that_s1_does_not_hear() {
    // S1 hears steady sliding 0.2 s later: here the network acts alone.
    let alone = DetectorSet::only(DetectorId::Hebbian);
    let mut untaught = Bench::holding(1);
    untaught.fingertip.act_on(alone);
    untaught.vibration_mv = SLIP_MV;
    assert!(!closes(&untaught.run(2_000)));
    assert!(untaught.ticks().all(|tick| tick.outputs == [0; 2]));

    let mut bench = Bench::taught(1);
    bench.fingertip.act_on(alone);
    assert!(!closes(&bench.run(4_000)), "nothing slips");
    bench.vibration_mv = SLIP_MV;
    assert!(closes(&bench.run(100)), "50 ms of slip");
    assert_eq!(bench.causes().last(), Some(&Cause::Slip(DetectorId::Hebbian)));
    bench.accepts(Down::Forget);
    bench.vibration_mv = 0.0;
    bench.run(400);
    bench.vibration_mv = SLIP_MV;
    assert!(!closes(&bench.run(2_000)), "it has forgotten");
}

#[test]
fn o2_tells_up_from_down() {
    let mut bench = Bench::taught(2);
    for (up, sign) in [(1.0, 1), (-0.8, -1)] {
        bench.shear(up);
        bench.run(200);
        let direction = bench.slows.last().unwrap().ticks[24].outputs[1];
        assert!(i32::from(direction) * sign > 0, "{direction} for a shear of {up}");
    }
}

// Shows R5.
#[test]
fn gauges_that_fail_are_no_slip() {
    let mut bench = Bench::taught(4);
    for gauge in STRAIN..STRAIN + STRAIN_COUNT {
        for fails_at_mv in [0.0, 3_300.0] {
            let works = bench.pins_mv[gauge];
            bench.pins_mv[gauge] = fails_at_mv;
            assert!(!closes(&bench.run(600)), "gauge {gauge} at {fails_at_mv} mV");
            bench.pins_mv[gauge] = works;
            // It is believed again after a second.
            assert!(!closes(&bench.run(2_600)), "gauge {gauge} back");
        }
    }
    for gauge in STRAIN..STRAIN + STRAIN_COUNT {
        bench.pins_mv[gauge] = 0.0;
        assert!(!closes(&bench.run(400)), "all gauges up to {gauge}");
    }
}

// Shows R5.
#[test]
fn films_that_freeze_one_after_the_other_are_no_slip() {
    for frozen in (0..=SAMPLE_MAX).step_by(1_365) {
        let mut bench = Bench::taught(6);
        for frame in 0..6_000 {
            let mut given = bench.frame();
            given.pvdf[..(1 + frame / 600).min(11)].fill(frozen);
            assert!(!bench.give(&given).closes(), "frozen at {frozen}, frame {frame}");
        }
    }
}

#[test]
fn nothing_is_learned_from_a_disturbed_hand_a_late_picture_or_an_empty_one() {
    let late = Config::default().hebbian.teacher_fresh_ms + 1;
    type Disturb = fn(&mut Bench);
    let all: [(Disturb, u16); 3] = [
        (|bench| bench.load(0.0, 0.0), AGE_MS),
        (|_| {}, late),
        (|bench| bench.muscles(400.0, 50.0), AGE_MS),
    ];
    for (n, (disturb, age_ms)) in all.into_iter().enumerate() {
        let mut bench = Bench::taught(5);
        disturb(&mut bench);
        bench.run(100);
        let updates = bench.fingertip.network().updates;
        for _ in 0..20 {
            bench.accepts(Down::Teach { codes: SLIPS_UP, age_ms });
            bench.run(PICTURE_FRAMES);
        }
        assert_eq!(bench.fingertip.network().updates, updates, "case {n}");
    }
}

#[test]
fn switched_on_in_a_grasp_it_does_not_take_hum_for_slip() {
    const HUM_MV: f64 = 25.0;
    let mut taught = Bench::taught(7);
    taught.accepts(Down::Save);
    let mut keeper = taught.fingertip.keeper();
    let record = taught.fingertip.next_record(&mut keeper).expect("asked for");
    let mut bench = Bench::new(7);
    bench.fingertip.restore(record.kept(), record.payload(&mut [0; PAYLOAD_BYTES]));

    bench.load(4.0, 0.4);
    bench.vibration_mv = HUM_MV;
    assert!(!closes(&bench.run(8_000)), "it may have hummed all the time");
    bench.load(0.0, 0.0);
    bench.run(4_000);
    bench.load(4.0, 0.4);
    assert!(!closes(&bench.run(4_000)), "it knows the hum");
    // To a ratio at which the films alone are believed, more slowly than shear foretells slip.
    for n in 1..=10 {
        bench.load(4.0, 0.4 + 0.02 * f64::from(n));
        bench.run(400);
    }
    assert!(!closes(&bench.run(400)));
    bench.vibration_mv = HUM_MV + SLIP_MV;
    assert!(closes(&bench.run(200)), "slip in the hum");
    assert!(bench.causes().contains(&Cause::Slip(DetectorId::Hebbian)), "{:?}", bench.events);
}
