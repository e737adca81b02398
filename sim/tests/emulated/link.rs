//! Commands come down the line and answers go up.

use tenax_frames::link::{Encoder, Inbox};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{About, Answer, Down, Identity, Refusal, Setting, Up};
use tenax_hal_shim::words::Code;
use tenax_logic::setting::SettingId;
use tenax_scene::plant::{Pins, Plant};
use tenax_sim::board::agreement::Agreement;
use tenax_sim::board::emulated::Options;
use tenax_sim::board::simulated;

use crate::{Loaded, Rest, Run, Swing, drives, run};

const fn s2(permille: i32) -> Setting {
    Setting { id: SettingId::S2.number(), value: permille }
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
    assert_eq!(*second, Answer::Refused(Refusal::OutOfRange { min: 150, max: 1_500 }));
    assert_eq!(run.slows.last().map(|slow| slow.s2_permille), Some(400));
}

// Shows L3.
#[test]
fn a_drive_command_holds_as_long_as_it_says() {
    let drive = MotorDrive::Open(Duty::per_mille(250));
    let plant = Swing::new(0.8).sending(0.4, Down::Drive { drive, hold_ms: 100 });
    let run = run(Rest::new(plant), &Options::default());
    assert!(drives(&run, 0.0, 0.4).iter().all(|now| *now == MotorDrive::Coast));
    assert!(drives(&run, 0.405, 0.495).iter().all(|now| *now == drive));
    assert!(drives(&run, 0.505, 0.8).iter().all(|now| *now == MotorDrive::Coast));
}

/// What a stranger sends is refused, the session and the button notwithstanding each other, and both together move it.
// Shows L1.
#[test]
fn a_stranger_needs_a_session_and_somebody_at_the_hand() {
    let drive = MotorDrive::Open(Duty::per_mille(250));
    let command = Down::Drive { drive, hold_ms: 100 };
    let opened = |hello: bool, pressed: bool| {
        let mut plant = Swing::new(1.5).stranger().sending(0.3, command).sending(1.2, command);
        if hello {
            plant = plant.sending(0.4, Down::Hello);
        }
        if pressed {
            plant = plant.pressing(0.8);
        }
        run(Loaded(Rest::new(plant)), &Options::default())
    };
    let refused = |refusal| Answer::Refused(refusal);
    let answers = |run: &Run| run.answers.iter().map(|(_, answer)| answer.clone()).collect::<Vec<_>>();
    let run = opened(false, true);
    assert_eq!(answers(&run), [refused(Refusal::NoSession), refused(Refusal::NoSession)]);
    assert!(run.drives.iter().all(|now| *now == MotorDrive::Coast));
    let run = opened(true, false);
    assert_eq!(answers(&run)[2..], [Answer::Done, refused(Refusal::NotArmed)], "the session is open");
    assert!(run.drives.iter().all(|now| *now == MotorDrive::Coast));
    let run = opened(true, true);
    assert_eq!(run.answers.last(), Some(&(3, Answer::Done)));
    assert!(drives(&run, 1.21, 1.29).iter().all(|now| *now == drive));
    let agreement = Agreement::of(&run);
    assert!(agreement.holds(), "{agreement}");
}

/// Every kind of command, 5,000 a second: more than the line is ever asked for, and as much as it carries.
// Shows L5.
#[test]
fn a_flood_of_commands_makes_no_tick_late() {
    let duty = Duty::per_mille(300);
    let kinds = [
        Down::Ping,
        Down::Set(s2(400)),
        Down::Drive { drive: MotorDrive::Close(duty), hold_ms: 250 },
        Down::Network,
        Down::Teach { codes: [Code::Minus, Code::Plus], age_ms: 40 },
        Down::Samples,
        Down::Settings(0),
        Down::Drive { drive: MotorDrive::Open(duty), hold_ms: 250 },
    ];
    for stranger in [false, true] {
        let mut plant = Swing::new(1.5);
        if stranger {
            plant = plant.stranger();
        }
        for n in 0..5_000u32 {
            plant = plant.sending(0.3 + f64::from(n) / 5_000.0, kinds[n as usize % kinds.len()]);
        }
        let run = run(plant, &Options::default());
        let counters = run.counters;
        println!("{counters:?}, {} answered, {} missed", run.answers.len(), run.messages_missed);
        assert_eq!((counters.ticks_late, counters.frames_lost, counters.overruns), (0, 0, 0), "{counters:?}");
        assert_eq!((counters.bad_frames, counters.telemetry_dropped, run.messages_missed), (0, 0, 0));
        assert_eq!(run.slows.len(), 120, "telemetry goes on");
        let agreement = Agreement::of(&run);
        assert!(agreement.holds(), "{agreement}");
    }
}
/// What came up a line, without what the two boards tell at other instants: the counters, and the frame before which a
/// command was taken or a record saved, which is given apart.
fn messages(line: &[u8], frames: u32) -> (Vec<Up>, Vec<u32>) {
    let (mut inbox, mut times) = (Inbox::default(), Vec::new());
    let mut told = |up| match up {
        Up::Counters(_) => None,
        Up::Slow(ref slow) if slow.frame >= frames => None,
        // The one is an image on a chip, the other is not.
        Up::About(about) => Some(Up::About(About { identity: Identity::default(), ..about })),
        Up::Answer { of, frame, answer } => {
            times.push(frame);
            Some(Up::Answer { of, frame: 0, answer })
        }
        Up::Saved { frame, kept } => {
            times.push(frame);
            Some(Up::Saved { frame: 0, kept })
        }
        other => Some(other),
    };
    let heard = line.iter().filter_map(|&byte| inbox.push(byte)).map(|heard| heard.expect("a message"));
    let messages = heard.filter_map(|heard| told(heard.received.message)).collect();
    assert_eq!((inbox.counts().missed, inbox.counts().bad_frames), (0, 0));
    (messages, times)
}

#[test]
fn the_hosts_board_says_on_its_line_what_the_image_says() {
    // In the middle of a slow frame, so that both take them in the same one.
    let plant = || {
        let swing = Swing::new(1.0).sending(0.206, Down::Ping).sending(0.206, Down::Set(s2(400)));
        Rest::new(swing.sending(0.306, Down::Settings(17)).sending(0.306, Down::Zero))
    };
    let (image, image_times) = messages(&run(plant(), &Options::default()).line, 2_000);
    let (host, host_times) = messages(&simulated::run(plant(), &mut |_| {}).0.line, 2_000);
    assert!(matches!(image[0], Up::Hello { .. }));
    assert!(image.iter().any(|up| matches!(up, Up::Saved { .. })), "the setting was saved");
    assert_eq!(host, image);
    for (host, image) in host_times.iter().zip(&image_times) {
        assert!(host.abs_diff(*image) <= 4, "host {host_times:?}, image {image_times:?}");
    }
}

/// Every pin at rest, and bytes that come down as they are.
struct Typed(Swing, Vec<u8>);

impl Plant for Typed {
    fn within(&self) -> Option<&dyn Plant> {
        Some(&self.0)
    }

    fn within_mut(&mut self) -> Option<&mut dyn Plant> {
        Some(&mut self.0)
    }

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.0.scan(drive)
    }

    fn line_bytes(&mut self) -> Vec<u8> {
        if self.0.t_s() < 0.2 { Vec::new() } else { std::mem::take(&mut self.1) }
    }
}

#[test]
fn bytes_that_a_client_sends_are_commands_like_any_other() {
    let mut encoder = Encoder::default();
    let mut bytes = b"no message at all\0".to_vec();
    for command in [Down::Ping, Down::Set(s2(400)), Down::Get(s2(0).id)] {
        bytes.extend(encoder.frame(&command).1);
    }
    let run = run(Typed(Swing::new(0.5).sending(0.3, Down::Ping), bytes), &Options::default());
    let set = Answer::Setting(s2(400));
    assert_eq!(run.answers, [(0, Answer::Done), (1, set.clone()), (2, set), (0, Answer::Done)]);
    assert_eq!(run.counters.bad_frames, 1);
    let agreement = Agreement::of(&run);
    assert!(agreement.holds(), "{agreement}");
}
