//! Force sensor and films in error: each silence of the reflex beside a control that fires.

use tenax_hal_shim::channel::{FSR, PVDF};
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::front_end::FSR_REST_MV;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{Cause, Fault, GripMode, Reason};
use tenax_host_tests::Bench;
use tenax_logic::mode;

// Shows R6.
#[test]
fn one_pressed_quadrant_of_an_empty_hand_closes_nothing() {
    for quadrant in 0..4 {
        for newtons in [0.2, 0.3, 1.0, 4.0] {
            let mut bench = Bench::new(31);
            bench.run(800);
            let mut pressed = [0.0; 4];
            pressed[quadrant] = newtons;
            bench.load_quadrants(pressed);
            bench.run(8_000);
            assert_eq!(bench.by_reflex(), 0, "{newtons} N on quadrant {quadrant}");
        }
    }
    // The control: the same ratio on a load that all quadrants carry.
    let mut bench = Bench::new(31);
    bench.run(800);
    bench.load(4.0, 2.2);
    bench.run(8_000);
    assert!(bench.by_reflex() > 100);
}

// Shows R4.
#[test]
fn a_quadrant_that_drifts_in_a_grasp_closes_nothing_and_is_told() {
    // The control: the wearer's own shear gives the same numbers on all quadrants.
    for (rigid, closes) in [(false, false), (true, true)] {
        let mut bench = Bench::holding(33);
        for n in 0..80_000 {
            let drifted_n = 0.1 * f64::from(n) / 2_000.0;
            let half_n = drifted_n / 2.0;
            // A shear loads A and B and unloads C and D.
            let sheared = [1.1 + half_n, 1.1 + half_n, 0.9, 0.9];
            bench.load_quadrants(if rigid { sheared } else { [1.1, 1.1 + drifted_n, 0.9, 0.9] });
            bench.run(1);
        }
        assert_eq!(bench.by_reflex() > 0, closes, "rigid: {rigid}");
        let crept = bench.lost(FSR + 1).iter().any(|(_, reason)| *reason == Reason::Creep);
        assert_eq!(crept, !rigid);
    }
}

#[test]
fn where_slip_is_unlikely_no_sense_alone_closes_however_loud_it_is() {
    // Unless the array feels it, too: then it is the force sensor that is wrong.
    let all =
        [(0.2, 0.0, false), (0.48, 0.0, false), (0.6, 0.0, true), (0.2, 60.0, true), (0.48, 60.0, true)];
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

/// Duties of the reflex's pulses at a load whose shear S2 warns of, per mille; each tick of closing adds `raises_n`.
fn duties(mut load_n: f64, raises_n: f64) -> Vec<u16> {
    let mut bench = Bench::holding(35);
    let mut duties = Vec::new();
    for _ in 0..2_000 {
        bench.load(load_n, 0.35 * load_n);
        if let MotorDrive::Close(duty) = bench.step() {
            duties.push(duty.as_per_mille());
            load_n += raises_n;
        }
    }
    duties
}

#[test]
fn small_pulses_that_stall_grow() {
    let stalled = duties(20.0, 0.0);
    assert_eq!((stalled.first(), stalled.last()), (Some(&400), Some(&1_000)), "{stalled:?}");
    // Pulses that raise the load do not grow, nor those at a load at which no motor stalls.
    for all in [duties(20.0, 0.01), duties(4.0, 0.0)] {
        assert!(all.len() > 100 && all.iter().all(|&duty| duty == 400), "{all:?}");
    }
}

#[test]
fn slip_while_an_s2_pulse_settles_is_answered() {
    let mut bench = Bench::holding(32);
    bench.load(4.0, 1.6);
    let warned = (0..200).any(|_| bench.run(1).len() == 1 && bench.fingertip.mode() == GripMode::Incipient);
    assert!(warned, "S2 warns");
    // Its pulse takes 15 ms, and what it does shows 80 ms later.
    bench.run(30);
    bench.vibration_mv = 400.0;
    bench.run(60);
    assert_eq!(bench.causes().last(), Some(&Cause::Slip(DetectorId::S1)));
    assert_eq!(bench.fingertip.mode(), GripMode::Slip);
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
    let mut bench = Bench::holding(33);
    bench.run_humming(FILM..FILM + 1, 200.0, 40_000);
    let closed = bench.by_reflex();
    assert!((1..=600).contains(&closed), "{closed} ticks of 40 000");
    let noisy = bench.lost(FILM).iter().filter(|(_, reason)| *reason == Reason::Noisy).count();
    assert_eq!(noisy, 1);
    // The others still feel slip.
    bench.slows.clear();
    bench.vibration_mv = 400.0;
    bench.run(400);
    assert!(bench.by_reflex() > 20);
}

/// An empty hand whose quadrants are all off by so much, mV.
fn off_zero(bench: &mut Bench, mv: f64) {
    bench.pins_mv[FSR..FSR + 4].fill(f64::from(FSR_REST_MV) + mv);
}

// Shows R6.
#[test]
fn an_offset_of_the_force_sensor_is_gone_once_the_hand_has_opened() {
    for mv in [10.0, 45.0] {
        let mut bench = Bench::new(34);
        off_zero(&mut bench, mv);
        bench.run(1_000);
        let load_mn = |bench: &Bench| bench.fingertip.forces().expect("forces").load_mn;
        assert!(load_mn(&bench) > 100, "{mv} mV read as a load");
        bench.muscles(50.0, 900.0);
        assert!(bench.run(8_000).iter().filter(|drive| drive.opens()).count() > 2_000);
        bench.muscles(50.0, 50.0);
        bench.run(1_000);
        assert!(load_mn(&bench) < 50, "{mv} mV: {} mN", load_mn(&bench));
    }
}

// Shows R6.
#[test]
fn an_open_hand_that_still_reads_a_load_says_so_once() {
    // The control: an offset that the zeros follow.
    for (mv, told) in [(45.0, 0), (100.0, 1)] {
        let mut bench = Bench::new(35);
        bench.run(400);
        off_zero(&mut bench, mv);
        bench.muscles(50.0, 900.0);
        bench.run(8_000);
        bench.muscles(50.0, 50.0);
        bench.run(20_000);
        assert_eq!(bench.count(EventKind::Fault(Fault::NeverUnloaded)), told, "{mv} mV");
    }
}
