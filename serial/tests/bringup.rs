//! Steps of bring-up on a board that is played: one that forgets what it told as saved.

use std::cell::Cell;
use std::io::{Read, Write};
use std::os::unix::net::UnixStream;
use std::thread;
use std::time::Duration;

use tenax_hal_shim::wire::{Answer, Down, FRAME_MAX, Receiver, Up, encode};
use tenax_hal_shim::words::Kept;
use tenax_logic::setting::SettingId;
use tenax_serial::guide::bringup::{Asked, STEPS, Wire};
use tenax_serial::link::{Client, Line};

/// Answers what `cuts` asks. Each time a setting is set, it is saved or not, which is told or not, and the board starts anew.
fn play(mut line: UnixStream, saves: fn(u32) -> bool, tells: fn(u32) -> bool) {
    let (mut receiver, mut sequence, mut set) = (Receiver::new(), 0, 0);
    let mut kept = tenax_hal_shim::wire::Setting { id: SettingId::S1.number(), value: 100 };
    let mut bytes = [0; 256];
    while let Ok(count @ 1..) = line.read(&mut bytes) {
        let commands: Vec<_> =
            bytes[..count].iter().filter_map(|&byte| receiver.push::<Down>(byte)).flatten().collect();
        for command in commands {
            let answer = |answer| Up::Answer { of: command.sequence, frame: 0, answer };
            let mut says = Vec::new();
            match command.message {
                Down::Get(_) => says.push(answer(Answer::Setting(kept))),
                Down::Set(setting) => {
                    says.push(answer(Answer::Setting(setting)));
                    set += 1;
                    kept = if saves(set) { setting } else { kept };
                    if tells(set) {
                        says.push(Up::Saved { frame: 0, kept: Kept::Settings });
                    }
                    says.push(Up::Hello { frame_hz: 2_000, after: None });
                }
                _ => says.push(answer(Answer::Done)),
            }
            for message in says {
                sequence = if matches!(message, Up::Hello { .. }) { 0 } else { sequence + 1 };
                line.write_all(encode(sequence, &message, &mut [0; FRAME_MAX]).unwrap()).unwrap();
            }
        }
    }
}

fn failing(saves: fn(u32) -> bool, tells: fn(u32) -> bool) -> Vec<String> {
    let (ours, boards) = UnixStream::pair().unwrap();
    ours.set_read_timeout(Some(Duration::from_millis(50))).unwrap();
    thread::spawn(move || play(boards, saves, tells));
    let line = Cell::new(Some(ours));
    let open = || {
        let up = line.take().expect("it is opened once");
        let down = Box::new(up.try_clone()?);
        Ok(Client::from(Line { up: Box::new(up), down: Some(down) }))
    };
    let cuts = STEPS.iter().find(|step| step.name == "cuts").unwrap();
    let asked = Asked { times: Some(3), ..Asked::default() };
    let figures = cuts.measure(&mut Wire::new(&open).unwrap(), &asked, &mut |_| Ok(())).unwrap();
    figures.iter().filter(|figure| !figure.passes()).map(|figure| figure.name.clone()).collect()
}

#[test]
fn a_value_that_was_told_as_saved_has_to_be_there() {
    assert!(failing(|n| n != 2, |n| n == 1).is_empty(), "one that was not told may be lost");
    assert_eq!(failing(|n| n != 2, |_| true), ["values that were told as saved and are not"]);
}
