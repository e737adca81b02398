//! A motor that is blocked in a scene: it stops within half a second, says so, keeps what is held and opens when it is asked again.

use crate::common::{parsed, text};
use tenax_hal_shim::channel::{SCAN_HZ, SCANS_PER_FRAME};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::EventKind;
use tenax_hal_shim::words::MotorStop;
use tenax_scene::World;
use tenax_sim::board::{Run, simulated};

/// When the motor was stopped or freed, s.
fn stops(run: &Run) -> Vec<(f64, Option<MotorStop>)> {
    let at_s = |frame: u32| f64::from(frame) * SCANS_PER_FRAME as f64 / f64::from(SCAN_HZ);
    let told = run.events.iter().map(|event| match event.kind {
        EventKind::Motor(stop) => Some((at_s(event.frame), stop)),
        _ => None,
    });
    told.flatten().collect()
}

/// The motor's drives between two instants.
fn drives(run: &Run, from_s: f64, to_s: f64) -> &[MotorDrive] {
    let scan = |t_s: f64| (t_s * f64::from(SCAN_HZ)) as usize;
    &run.drives[scan(from_s)..scan(to_s)]
}

// Shows B9.
#[test]
fn a_jammed_gear_stops_the_motor_within_half_a_second_either_way() {
    let (run, world) = simulated::run(World::new(&parsed(&text("jam")), 1), &mut |_| {});
    let told: Vec<_> = stops(&run);
    println!("{told:?}");
    let kinds: Vec<_> = told.iter().map(|(_, stop)| *stop).collect();
    assert_eq!(kinds, [Some(MotorStop::ClosingStalled), None, Some(MotorStop::OpeningStalled), None]);
    let (closing_s, opening_s) = (told[0].0, told[2].0);
    // It is asked to close 0.5 s, and to open 6.0 s after the start.
    assert!(
        (0.7..1.0).contains(&closing_s) && (6.2..6.5).contains(&opening_s),
        "{closing_s} s, {opening_s} s"
    );
    assert!(drives(&run, closing_s - 0.2, closing_s - 0.001).iter().all(|drive| drive.closes()));
    assert!(drives(&run, opening_s - 0.2, opening_s - 0.001).iter().all(|drive| drive.opens()));
    for (from_s, to_s) in [(closing_s + 0.001, 2.0), (opening_s + 0.001, 7.6)] {
        assert!(
            drives(&run, from_s, to_s).iter().all(|drive| *drive == MotorDrive::Coast),
            "until it is asked again"
        );
    }
    assert!(drives(&run, 2.01, 2.8).iter().all(|drive| drive.closes()), "the jam is over: it closes");
    assert!(drives(&run, 7.61, 7.9).iter().all(|drive| drive.opens()), "and opens");

    let truth = world.truth();
    assert!(!truth.dropped && !truth.left_behind, "a stop drops nothing");
}

/// The same commands without the jam stop nothing.
// Shows B9.
#[test]
fn a_free_gear_is_not_stopped() {
    let text = text("jam").replace("for_s = 1.2 ", "for_s = 0.01 ").replace("for_s = 1.3 ", "for_s = 0.01 ");
    let (run, _) = simulated::run(World::new(&parsed(&text), 1), &mut |_| {});
    assert_eq!(stops(&run), []);
    assert!(drives(&run, 0.51, 1.39).iter().all(|drive| drive.closes()));
}
