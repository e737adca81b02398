//! The guided calibration over the line, from the command to the saved record.

use tenax_hal_shim::channel::FSR;
use tenax_hal_shim::wire::{Down, EventKind, Refusal};
use tenax_hal_shim::words::{Calibration, CalibrationRefusal, Fit, Kept, Prompt};
use tenax_host_tests::{Bench, opens, rests};
use tenax_logic::fingertip::Fingertip;
use tenax_logic::store::payload;

fn told(bench: &Bench) -> Vec<Calibration> {
    let step = |kind| if let EventKind::Calibration(step) = kind { Some(step) } else { None };
    bench.kinds().filter_map(step).collect()
}

fn calibrate(bench: &mut Bench, phases: [[f64; 2]; 3]) -> Vec<Calibration> {
    bench.accepts(Down::CalibrateEmg);
    for [flexor_mv, extensor_mv] in phases {
        bench.muscles(flexor_mv, extensor_mv);
        assert!(rests(&bench.run(10_000)), "the muscles move nothing");
    }
    bench.muscles(50.0, 50.0);
    bench.run(50);
    told(bench)
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
    assert_eq!(told[..3], [Prompt::Rest, Prompt::Close, Prompt::Open].map(Calibration::Asks));
    assert!(matches!(told[3..], [Calibration::Done { .. }]), "{told:?}");
    let record = bench.fingertip.next_record(&mut keeper).expect("it is kept");
    assert_eq!(record.kept(), Kept::Emg);
    assert!(payload::emg(record.payload(&mut [0; _])).is_some());
    bench.run(1_000);
    bench.muscles(80.0, 900.0);
    assert!(bench.run(50).last().expect("frames").opens());
}

// Shows W7, R6.
#[test]
fn a_calibrating_hand_that_may_hold_something_can_let_it_go() {
    // A load that the reflex leaves alone, and a force that is unknown because two quadrants are cut.
    let loads: fn(&mut Bench) = |bench| bench.load(0.2, 0.0);
    let cuts: fn(&mut Bench) = |bench| bench.pins_mv[FSR..FSR + 2].fill(0.0);
    for (holds, refusal) in [(loads, Refusal::Loaded), (cuts, Refusal::SensorLost)] {
        let mut bench = Bench::new(34);
        bench.run(400);
        [Down::Zero, Down::CalibrateEmg].into_iter().for_each(|command| bench.accepts(command));
        bench.run(1_000);
        bench.muscles(50.0, 900.0);
        assert!(!opens(&bench.run(200)), "the control: while it is empty, muscles move nothing");
        bench.muscles(50.0, 50.0);
        holds(&mut bench);
        bench.run(1_000);
        let given_up = Calibration::Refused(CalibrationRefusal::Loaded);
        assert_eq!(bench.count(EventKind::Calibration(given_up)), 1, "{refusal:?}");
        for command in [Down::CalibrateEmg, Down::Zero] {
            assert_eq!(bench.fingertip.command(&command), Err(refusal), "{command:?}");
        }
        bench.muscles(50.0, 900.0);
        assert!(opens(&bench.run(100)), "{refusal:?}");
    }
}

// Shows W9.
#[test]
fn electrodes_that_were_exchanged_ask_for_a_calibration_and_change_nobodys_command() {
    let mut bench = uncalibrated(35);
    calibrate(&mut bench, [[50.0, 50.0], [450.0, 165.0], [150.0, 1_400.0]]);
    bench.run(6_000);
    bench.events.clear();
    for (flexor_mv, extensor_mv) in [(165.0, 450.0), (1_400.0, 150.0)].into_iter().cycle().take(12) {
        bench.muscles(flexor_mv, extensor_mv);
        bench.run(3_000);
        bench.muscles(50.0, 50.0);
        bench.run(2_000);
    }
    assert_eq!(told(&bench), [Calibration::Fit(Fit::Exchanged)]);
    let lit = (0..320).filter(|_| bench.run(25).len() == 25 && bench.fingertip.light());
    assert_eq!(lit.count(), 24, "slow frames of light in 4 s: three flashes of 0.1 s");
    bench.muscles(150.0, 2_000.0);
    assert!(bench.run(50).last().expect("frames").opens(), "it opens as before");
}
