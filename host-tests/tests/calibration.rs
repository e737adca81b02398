//! The guided calibration over the line, from the command to the record that is kept.

use tenax_hal_shim::channel::FSR;
use tenax_hal_shim::wire::{Down, EventKind, Refusal};
use tenax_hal_shim::words::{Calibration, CalibrationRefusal, Fit, Kept, Prompt};
use tenax_host_tests::{Bench, wearer};
use tenax_logic::fingertip::Fingertip;
use tenax_logic::store::payload;

/// Answers the three prompts with these envelopes; what it said.
fn calibrate(bench: &mut Bench, phases: [[f64; 2]; 3]) -> Vec<Calibration> {
    bench.fingertip.command(&Down::CalibrateEmg).expect("nothing is held");
    for [flexor_mv, extensor_mv] in phases {
        bench.muscles(flexor_mv, extensor_mv);
        for _ in 0..400 {
            assert!(
                bench.run(25).iter().all(|drive| !drive.opens() && !drive.closes()),
                "the muscles move nothing"
            );
        }
    }
    bench.muscles(50.0, 50.0);
    bench.run(25);
    bench.run(25);
    let told = bench.events.iter().filter_map(|event| match event.kind {
        EventKind::Calibration(step) => Some(step),
        _ => None,
    });
    told.collect()
}

fn uncalibrated(seed: u64) -> Bench {
    let mut bench = Bench::of(Fingertip::default(), seed);
    bench.lively = 0.12;
    bench.run(400);
    bench
}

// Shows W7.
#[test]
fn a_wearer_is_learned_kept_and_answered() {
    let mut bench = uncalibrated(31);
    let mut keeper = bench.fingertip.keeper();
    let told = calibrate(&mut bench, [[50.0, 50.0], [600.0, 80.0], [80.0, 500.0]]);
    let [Calibration::Asks(a), Calibration::Asks(b), Calibration::Asks(c), Calibration::Done { .. }] =
        told[..]
    else {
        panic!("{told:?}");
    };
    assert_eq!([a, b, c], [Prompt::Rest, Prompt::Close, Prompt::Open]);
    let record = bench.fingertip.next_record(&mut keeper).expect("it is kept");
    assert_eq!(record.kept(), Kept::Emg);
    let mut buffer = [0; _];
    assert!(payload::emg(record.payload(&mut buffer)).is_some());
    bench.run(1_000);
    bench.muscles(80.0, 900.0);
    assert!(bench.run(50).last().expect("frames").opens());
}

// Shows W7.
#[test]
fn what_does_not_separate_is_refused_and_a_hand_that_holds_is_not_calibrated() {
    let mut bench = uncalibrated(32);
    let mut keeper = bench.fingertip.keeper();
    let told = calibrate(&mut bench, [[50.0, 50.0], [600.0, 80.0], [50.0, 50.0]]);
    assert_eq!(told.last(), Some(&Calibration::Refused(CalibrationRefusal::NoOpening)));
    assert!(bench.fingertip.next_record(&mut keeper).is_none());
    let mut bench = Bench::holding(33);
    assert_eq!(bench.fingertip.command(&Down::CalibrateEmg), Err(Refusal::Loaded));
}

// Shows W7.
#[test]
fn a_hand_that_may_hold_something_can_let_it_go() {
    let mut bench = Bench::new(35);
    bench.run(400);
    bench.fingertip.command(&Down::CalibrateEmg).expect("nothing is held");
    bench.run(1_000);
    // Two quadrants are cut: nobody knows the force.
    bench.pins_mv[FSR..FSR + 2].fill(0.0);
    bench.run(400);
    assert_eq!(bench.fingertip.command(&Down::CalibrateEmg), Err(Refusal::SensorLost));
    bench.muscles(50.0, 900.0);
    assert!(bench.run(200).iter().any(|drive| drive.opens()));
}

// Shows W7.
#[test]
fn whoever_comes_to_hold_something_can_let_it_go() {
    // Calibrated before, and empty when it begins anew.
    let mut bench = Bench::new(34);
    bench.run(400);
    bench.fingertip.command(&Down::CalibrateEmg).expect("nothing is held");
    bench.run(1_000);
    bench.muscles(50.0, 900.0);
    assert!(
        bench.run(200).iter().all(|drive| !drive.opens()),
        "the control: while it is empty, they move nothing"
    );
    bench.muscles(50.0, 50.0);
    bench.load(4.0, 0.6);
    bench.run(1_000);
    bench.muscles(50.0, 900.0);
    assert!(bench.run(100).iter().any(|drive| drive.opens()));
    let given_up = EventKind::Calibration(Calibration::Refused(CalibrationRefusal::Loaded));
    assert_eq!(bench.events.iter().filter(|event| event.kind == given_up).count(), 1);
}

/// Contracts in turn, each for 1.5 s, and rests for 1 s; in how many of the frames the light was on in the 4 s after.
fn contract(bench: &mut Bench, contractions: [[f64; 2]; 2], count: usize) -> usize {
    let slow = |bench: &mut Bench, frames: u32| {
        let mut lit = 0;
        for _ in 0..frames / 25 {
            bench.run(25);
            lit += usize::from(bench.fingertip.light());
        }
        lit
    };
    for [flexor_mv, extensor_mv] in contractions.into_iter().cycle().take(count) {
        bench.muscles(flexor_mv, extensor_mv);
        slow(bench, 3_000);
        bench.muscles(50.0, 50.0);
        slow(bench, 2_000);
    }
    slow(bench, 8_000)
}

// Shows W9.
#[test]
fn electrodes_that_were_exchanged_ask_for_a_calibration_and_change_nobodys_command() {
    let mut bench = uncalibrated(35);
    let phases = [[50.0, 50.0], [450.0, 165.0], [150.0, 1_400.0]];
    calibrate(&mut bench, phases);
    bench.run(6_000);
    bench.events.clear();
    let fits = |bench: &mut Bench| -> Vec<Fit> {
        let told = bench.events.drain(..).filter_map(|event| match event.kind {
            EventKind::Calibration(Calibration::Fit(fit)) => Some(fit),
            _ => None,
        });
        told.collect()
    };
    let [_, close, open] = phases;
    assert_eq!(contract(&mut bench, [close, open], 24), 0, "the light is dark");
    assert_eq!(fits(&mut bench), []);
    let swapped = [close, open].map(|[flexor, extensor]| [extensor, flexor]);
    // Three flashes of 0.1 s.
    assert_eq!(contract(&mut bench, swapped, 12), 24);
    assert_eq!(fits(&mut bench), [Fit::Exchanged]);
    bench.muscles(150.0, 2_000.0);
    assert!(bench.run(50).last().expect("frames").opens(), "what opened before opens now");
    bench.muscles(50.0, 50.0);
    bench.run(4_000);
    // A new calibration ends it.
    bench.fingertip.restore(Kept::Emg, &payload::of_emg(&wearer()));
    assert_eq!(contract(&mut bench, [close, open], 0), 0);
}
