//! Commands come down the line and answers go up.

use tenax::board::emulated::Options;
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::setting::SettingId;
use tenax_hal_shim::wire::{Answer, Down, Refusal, Setting};

use crate::{Rest, Swing, drives, run};

const fn s2(permille: i32) -> Setting {
    Setting { id: SettingId::S2 as u8, value: permille }
}

#[test]
fn every_command_is_answered_in_order() {
    let plant = Swing::new(0.6)
        .sending(0.2, Down::Ping)
        .sending(0.2, Down::Set(s2(400)))
        .sending(0.2, Down::Set(s2(40)))
        .sending(0.3, Down::Samples);
    let run = run(Rest::new(plant), &Options::default());
    let [(0, Answer::Done), (1, first), (2, second), (3, Answer::Samples(_))] = &run.answers[..] else {
        panic!("{:?}", run.answers);
    };
    assert_eq!(*first, Answer::Setting(s2(400)));
    assert_eq!(*second, Answer::Refused(Refusal::OutOfRange { min: 50, max: 1_500 }));
    assert_eq!(run.slows.last().map(|slow| slow.s2_permille), Some(400));
}

#[test]
fn a_drive_command_holds_as_long_as_it_says() {
    let drive = MotorDrive::Open(Duty::per_mille(250));
    let plant = Swing::new(0.8).sending(0.4, Down::Drive { drive, hold_ms: 100 });
    let run = run(Rest::new(plant), &Options::default());
    assert!(drives(&run, 0.0, 0.4).iter().all(|now| *now == MotorDrive::Coast));
    assert!(drives(&run, 0.405, 0.495).iter().all(|now| *now == drive));
    assert!(drives(&run, 0.505, 0.8).iter().all(|now| *now == MotorDrive::Coast));
}
