//! Commands come down the line and answers go up.

use tenax_frames::link::{Encoder, Inbox};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::{About, Answer, Down, Identity, Setting, Up};
use tenax_hal_shim::words::Code;
use tenax_logic::setting::SettingId;
use tenax_sim::board::emulated::Options;
use tenax_sim::board::simulated;

use crate::{Swing, agrees, run};

const fn s2(permille: i32) -> Setting {
    Setting { id: SettingId::S2.number(), value: permille }
}

/// Every kind of command, 5,000 a second: as much as the line carries.
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
        let mut plant = Swing { trusts_line: !stranger, ..Swing::new(1.5) };
        for n in 0..5_000u32 {
            plant = plant.sending(0.3 + f64::from(n) / 5_000.0, kinds[n as usize % kinds.len()]);
        }
        let run = run(plant, &Options::default());
        let counters = run.counters;
        assert_eq!((counters.ticks_late, counters.frames_lost, counters.overruns), (0, 0, 0), "{counters:?}");
        assert_eq!((counters.bad_frames, counters.telemetry_dropped, run.messages_missed), (0, 0, 0));
        assert_eq!(run.slows.len(), 120, "telemetry goes on");
        agrees("flood", &run);
    }
}
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
        swing.sending(0.306, Down::Settings(17)).sending(0.306, Down::Zero).at_rest()
    };
    let (image, image_times) = messages(&run(plant(), &Options::default()).line, 2_000);
    let (host, host_times) = messages(&simulated::run(plant()).0.line, 2_000);
    assert!(matches!(image[0], Up::Hello { .. }));
    assert!(image.iter().any(|up| matches!(up, Up::Saved { .. })), "the setting was saved");
    assert_eq!(host, image);
    for (host, image) in host_times.iter().zip(&image_times) {
        assert!(host.abs_diff(*image) <= 4, "host {host_times:?}, image {image_times:?}");
    }
}

#[test]
fn bytes_that_a_client_sends_are_commands_like_any_other() {
    let mut encoder = Encoder::default();
    let mut swing = Swing::new(0.5).sending(0.3, Down::Ping);
    swing.bytes = b"no message at all\0".to_vec();
    for command in [Down::Ping, Down::Set(s2(400)), Down::Get(s2(0).id)] {
        swing.bytes.extend(encoder.frame(&command).1);
    }
    let run = run(swing, &Options::default());
    let set = Answer::Setting(s2(400));
    assert_eq!(run.answers, [(0, Answer::Done), (1, set.clone()), (2, set), (0, Answer::Done)]);
    assert_eq!(run.counters.bad_frames, 1);
    agrees("bytes", &run);
}
