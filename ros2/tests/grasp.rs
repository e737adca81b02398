//! A gripper command, step by step.

use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::{Counters, Down};
use tenax_ros2::hand::{Grasp, Health, Object, Step};
use tenax_ros2::message::GripperCommand;

const CEILING_MN: Option<i32> = Some(20_000);

fn grasp(position: f64, max_effort: f64) -> Grasp {
    Grasp::of(&GripperCommand { position, max_effort }, CEILING_MN).unwrap()
}

/// Steps that drive while the load is this, mN.
fn drives(grasp: &mut Grasp, load_mn: i32) -> usize {
    (0..10_000).take_while(|_| matches!(grasp.step(Some(load_mn)), Step::Send(Down::Drive { .. }))).count()
}

#[test]
fn it_closes_to_the_force_and_drives_no_further() {
    for (effort, per_mille, mn) in [
        (5.0, 350, 5_000),
        (20.0, 1_000, 20_000),
        (21.0, 1_000, 20_000),
        (1e9, 1_000, 20_000),
        (1e300, 1_000, 20_000),
    ] {
        let mut close = grasp(0.0, effort);
        for load_mn in [0, mn - 1] {
            let Step::Send(Down::Drive { drive: MotorDrive::Close(duty), hold_ms: 25 }) =
                close.step(Some(load_mn))
            else {
                panic!("{effort} N does not close for 25 ms");
            };
            assert_eq!(duty.as_per_mille(), per_mille);
        }
        assert_eq!(close.step(Some(mn)), Step::Done("the force is reached"), "{effort} N");
    }
}

#[test]
fn without_a_force_or_for_ever_nothing_drives_and_it_opens_a_little_on() {
    assert!(matches!(grasp(0.0, 5.0).step(None), Step::Over(_)));
    assert_eq!(drives(&mut grasp(0.0, 5.0), 0), 400, "5 s");
    let mut open = grasp(0.05, 0.0);
    let step = open.step(Some(5_000));
    assert!(matches!(step, Step::Send(Down::Drive { drive: MotorDrive::Open(_), .. })), "{step:?}");
    assert_eq!(drives(&mut open, 5_000), 159, "2 s");
    assert_eq!(drives(&mut grasp(0.05, 3.0), 0), 20);
}

#[test]
fn no_effort_is_the_boards_gentle_grasp_once_and_what_is_no_command_is_refused() {
    let mut gentle = grasp(0.0, 0.0);
    assert_eq!(gentle.step(Some(0)), Step::Send(Down::Begin(Behaviour::GentleGrasp)));
    assert_eq!([Some(0), None, Some(400)].map(|mn| gentle.step(mn)), [Step::Wait; 3]);
    let ends = (0..400).map(|_| gentle.step(Some(400))).position(|step| matches!(step, Step::Done(_)));
    assert_eq!(ends, Some(19), "felt for a quarter of a second");
    for (position, max_effort, ceiling) in [
        (f64::NAN, 1.0, CEILING_MN),
        (0.0, f64::INFINITY, CEILING_MN),
        (-0.1, 1.0, CEILING_MN),
        (0.0, -1.0, CEILING_MN),
        (0.0, 1.0, None),
        (0.0, 1.0, Some(0)),
        (0.0, 1.0, Some(-1)),
    ] {
        let command = GripperCommand { position, max_effort };
        assert!(Grasp::of(&command, ceiling).is_err(), "{command:?} {ceiling:?}");
    }
}

#[test]
fn a_loss_is_warned_of_for_ten_seconds_and_counted_for_ever() {
    let mut health = Health { counters: Some(Counters::default()), ..Health::default() };
    let mut level = |missed, at_s: u64| {
        health.count(missed, 0, at_s * 1_000_000_000);
        let status = health.diagnostics("left", at_s * 1_000_000_000).status.remove(0);
        (status.level, status.values[3].value.clone())
    };
    let told = [level(0, 1), level(1, 2), level(1, 11), level(1, 13), level(2, 14)];
    assert_eq!(told.map(|(level, missed)| format!("{level} {missed}")), ["0 0", "1 1", "1 1", "0 1", "1 2"]);
}

#[test]
fn an_object_is_held_slips_and_is_lost_unless_somebody_opens_the_hand() {
    let mut object = Object::default();
    let mut told = |load_mn, slips, opens| object.step(load_mn, slips, opens);
    assert_eq!(told(Some(400), true, false), "none");
    assert_eq!(told(Some(2_000), false, false), "slipping", "a quarter of a second");
    let later: Vec<_> = (0..40).map(|_| told(Some(2_000), false, false)).collect();
    assert_eq!(later.last(), Some(&"held"));
    assert_eq!([told(Some(2_000), true, false), told(None, false, false)], ["slipping"; 2], "no number");
    assert_eq!([told(Some(400), false, false), told(Some(100), false, false)], ["slipping", "lost"]);
    assert_eq!([told(Some(100), false, false), told(Some(400), false, false)], ["lost"; 2]);
    (0..40).for_each(|_| _ = told(Some(700), false, false));
    assert_eq!([told(Some(500), false, true), told(Some(100), false, false)], ["held", "none"], "put down");
}
