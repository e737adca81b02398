//! A gripper command, step by step.

use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::Down;
use tenax_ros2::hand::{Grasp, Step};
use tenax_ros2::message::GripperCommand;

const CEILING_MN: Option<i32> = Some(20_000);

fn grasp(position: f64, max_effort: f64) -> Grasp {
    Grasp::of(&GripperCommand { position, max_effort }, CEILING_MN).unwrap()
}

fn duty(step: Step) -> u16 {
    match step {
        Step::Send(Down::Drive { drive: MotorDrive::Close(duty), hold_ms: 25 }) => duty.as_per_mille(),
        other => panic!("{other:?} does not close for 25 ms"),
    }
}

#[test]
fn it_closes_to_the_force_and_drives_no_further() {
    let mut close = grasp(0.0, 5.0);
    assert_eq!(duty(close.step(Some(0))), 350);
    assert_eq!(duty(close.step(Some(4_999))), 350);
    assert_eq!(close.step(Some(5_000)), Step::Over("the force is reached"));
}

#[test]
fn no_effort_asked_for_passes_the_ceiling() {
    for effort in [20.0, 21.0, 1e9, 1e300] {
        let mut close = grasp(0.0, effort);
        assert_eq!(duty(close.step(Some(19_999))), 1_000);
        assert_eq!(close.step(Some(20_000)), Step::Over("the force is reached"), "{effort} N");
    }
}

#[test]
fn without_a_force_or_for_ever_nothing_closes() {
    assert!(matches!(grasp(0.0, 5.0).step(None), Step::Over(_)));
    let mut close = grasp(0.0, 5.0);
    let steps = (0..10_000).take_while(|_| matches!(close.step(Some(0)), Step::Send(_))).count();
    assert_eq!(steps, 400, "5 s");
    let mut open = grasp(0.05, 0.0);
    let steps = (0..10_000).take_while(|_| matches!(open.step(Some(5_000)), Step::Send(_))).count();
    assert_eq!(steps, 160, "2 s");
}

#[test]
fn it_opens_until_nothing_is_felt_and_a_little_on() {
    let mut open = grasp(0.05, 3.0);
    for _ in 0..50 {
        assert!(matches!(open.step(Some(5_000)), Step::Send(Down::Drive { drive: MotorDrive::Open(_), .. })));
    }
    let on = (0..100).take_while(|_| matches!(open.step(Some(0)), Step::Send(_))).count();
    assert_eq!(on, 20);
}

#[test]
fn no_effort_is_the_boards_gentle_grasp_once() {
    let mut gentle = grasp(0.0, 0.0);
    assert_eq!(gentle.step(Some(0)), Step::Send(Down::Begin(Behaviour::GentleGrasp)));
    assert!(matches!(gentle.step(Some(0)), Step::Over(_)));
}

#[test]
fn what_is_no_command_is_refused() {
    let of = |position, max_effort, ceiling| Grasp::of(&GripperCommand { position, max_effort }, ceiling);
    for (position, effort) in [(f64::NAN, 1.0), (0.0, f64::INFINITY), (-0.1, 1.0), (0.0, -1.0)] {
        assert!(of(position, effort, CEILING_MN).is_err(), "{position} {effort}");
    }
    for ceiling in [None, Some(0), Some(-1)] {
        assert!(of(0.0, 1.0, ceiling).is_err(), "{ceiling:?}");
    }
}
