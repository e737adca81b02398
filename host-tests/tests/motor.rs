//! A jammed motor.

use tenax_hal_shim::channel::MOTOR_CURRENT;
use tenax_hal_shim::front_end::MOTOR_MV_PER_A;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::{DriveSource, MotorStop};
use tenax_host_tests::{Bench, closing_frames, opens};

const ZERO_MV: f64 = 300.0;

fn run_jammed(bench: &mut Bench, frames: u32) -> Vec<MotorDrive> {
    let step = |_| {
        let drive = bench.step();
        let part = match drive {
            MotorDrive::Close(duty) | MotorDrive::Open(duty) => f64::from(duty.as_per_mille()) / 1e3,
            MotorDrive::Coast => 0.0,
        };
        bench.pins_mv[MOTOR_CURRENT] = ZERO_MV + f64::from(MOTOR_MV_PER_A) * part;
        drive
    };
    (0..frames).map(step).collect()
}

// Shows W1, W2, B9.
#[test]
fn a_wearer_who_goes_on_closing_a_jammed_hand_is_stopped_and_opens_at_once() {
    let mut bench = Bench::new(73);
    bench.run(400);
    bench.slows.clear();
    bench.muscles(900.0, 95.0);
    let drives = run_jammed(&mut bench, 12_000);
    assert!(!opens(&drives));
    // A contraction fluctuates: a stronger one may try again.
    let [stopped, freed] = [Some(MotorStop::ClosingStalled), None].map(EventKind::Motor);
    let stops: Vec<_> = bench.kinds().filter(|kind| matches!(kind, EventKind::Motor(_))).collect();
    assert!(stops[0] == stopped && stops.iter().all(|stop| *stop == stopped || *stop == freed), "{stops:?}");
    let driven = closing_frames(&drives);
    assert!((400..1_000).contains(&driven), "{driven} frames");
    let is_consistent =
        |drive: MotorDrive, source| (drive == MotorDrive::Coast) == (source == DriveSource::Nobody);
    assert!(bench.ticks().skip(50).all(|tick| is_consistent(tick.drive, tick.source)));

    bench.muscles(50.0, 800.0);
    bench.events.clear();
    assert!(opens(&run_jammed(&mut bench, 100)));
    assert_eq!(bench.count(freed), 1, "the end of the stop is told");
}
