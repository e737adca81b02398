//! Force sensor and films in error: each silence of the reflex beside a control that fires.

use tenax_hal_shim::channel::{FSR, FSR_COUNT, PVDF};
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::front_end::FSR_REST_MV;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{Fault, Reason};
use tenax_host_tests::Bench;
use tenax_logic::mode;

#[test]
fn where_nothing_can_slip_no_sense_alone_closes_however_loud_it_is() {
    // Unless the array feels it, too: then it is the force sensor that is wrong.
    let all = [(0.2, 0.0, false), (0.48, 0.0, false), (0.2, 60.0, true), (0.48, 60.0, true)];
    for (shear_n, sliding_mv, closes) in all {
        let mut bench = Bench::holding(34);
        bench.load(4.0, shear_n);
        bench.press(700.0);
        bench.run(2_000);
        bench.sliding_mv = sliding_mv;
        bench.vibration_mv = 400.0;
        bench.run(2_000);
        assert!(bench.ticks().any(|tick| !tick.said.is_empty()));
        assert_eq!(bench.by_reflex() > 0, closes, "{shear_n} N of shear on 4 N, {sliding_mv} mV");
    }
}

#[test]
fn every_pulse_is_followed_by_its_reasons() {
    let mut bench = Bench::holding(32);
    bench.load(4.0, 1.6);
    bench.run(400);
    bench.load(4.0, 0.8);
    bench.run(400);
    bench.vibration_mv = 400.0;
    bench.run(200);
    let closing = |kind: &EventKind| matches!(kind, EventKind::Mode { to, .. } if mode::closes(*to));
    let kinds: Vec<EventKind> = bench.kinds().collect();
    let why: Vec<_> = kinds.windows(2).filter(|two| closing(&two[0])).map(|two| two[1]).collect();
    let warned = |why: &EventKind| matches!(why, EventKind::Pulse { margin_mn: Some(..0), believed, .. } if believed.contains(DetectorId::S2));
    let heard = |why: &EventKind| matches!(why, EventKind::Pulse { margin_mn: Some(0..), said, .. } if said.contains(DetectorId::S1));
    assert!(why.iter().all(|why| matches!(why, EventKind::Pulse { .. })), "{why:?}");
    assert!(why.iter().any(warned) && why.iter().any(heard), "{why:?}");
}

// Shows R5.
#[test]
fn one_humming_film_closes_the_hand_once_and_is_masked() {
    const FILM: usize = PVDF + 4;
    // Mains, another tone, and a contact that crackles every 150 ms.
    for (hz, on_of_300) in [(50.0, 300), (80.0, 300), (80.0, 150)] {
        let mut bench = Bench::holding(33);
        for n in 0..40_000 {
            bench.hum(FILM, hz, if n % 300 < on_of_300 { 200.0 } else { 0.0 });
            bench.step();
        }
        bench.hum(FILM, hz, 0.0);
        let closed = bench.by_reflex();
        assert!((1..=600).contains(&closed), "{closed} ticks of 40 000");
        let noisy = bench.lost(FILM).iter().filter(|(_, reason)| *reason == Reason::Noisy).count();
        assert_eq!(noisy, 1, "{hz} Hz");
        // The others still feel slip.
        bench.slows.clear();
        bench.vibration_mv = 400.0;
        bench.run(400);
        assert!(bench.by_reflex() > 20);
        bench.vibration_mv = 0.0;
        bench.run(24_000);
        assert_eq!(bench.count(EventKind::Fault(Fault::SensorBack { channel: FILM as u8 })), 1);
    }
}

// Shows R6.
#[test]
fn an_offset_of_the_force_sensor_is_gone_once_the_hand_has_opened_or_is_reported_once() {
    for (mv, reported) in [(10.0, 0), (45.0, 0), (100.0, 1)] {
        let mut bench = Bench::new(35);
        bench.run(400);
        bench.pins_mv[FSR..FSR + FSR_COUNT].fill(f64::from(FSR_REST_MV) + mv);
        bench.run(600);
        let load_mn = |bench: &Bench| bench.fingertip.forces().expect("forces").load_mn;
        assert!(load_mn(&bench) > 100, "{mv} mV read as a load");
        bench.muscles(50.0, 900.0);
        assert!(bench.run(8_000).iter().filter(|drive| drive.opens()).count() > 2_000);
        bench.muscles(50.0, 50.0);
        bench.run(20_000);
        assert_eq!(bench.count(EventKind::Fault(Fault::NeverUnloaded)), reported, "{mv} mV");
        assert!(reported == 1 || load_mn(&bench) < 50, "{mv} mV: {} mN", load_mn(&bench));
    }
}
