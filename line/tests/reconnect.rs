//! The page's view of a board that goes away and comes back, of garbage and of another version.
//!
//! A program of its own: what another test starts would inherit the pseudo-terminals and pass for their holder.
#![cfg(unix)]

use std::io::Write;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use crc::{CRC_32_ISO_HDLC, Crc};
use serialport::{SerialPort, TTYPort};
use tenax_hal_shim::wire::{Counters, Down, FRAME_MAX, Up, VERSION, encode};
use tenax_line::web::source::{News, start};
use tenax_line::web::view::View;

const WITHIN: Duration = Duration::from_secs(20);

fn frame(sequence: u16) -> Vec<u8> {
    let message = Up::Counters(Counters { frames: 1, ..Counters::default() });
    encode(sequence, &message, &mut [0; FRAME_MAX]).expect("it fits").to_vec()
}

/// A frame of another version, with a right CRC.
fn foreign() -> Vec<u8> {
    let mut plain = vec![VERSION + 1, 0, 3, 0];
    let crc = Crc::<u32>::new(&CRC_32_ISO_HDLC).checksum(&plain);
    plain.extend(crc.to_le_bytes());
    let mut framed = vec![0; cobs::max_encoding_length(plain.len()) + 1];
    let length = cobs::encode(&plain, &mut framed);
    framed.truncate(length + 1);
    framed
}

struct Watch {
    view: View,
    news: Receiver<News>,
    _commands: Sender<Down>,
}

impl Watch {
    fn of(place: &str) -> Self {
        let ((commands, waiting), (sender, news)) = (channel(), channel());
        start(&place.parse().unwrap(), None, waiting, sender);
        Self { view: View::default(), news, _commands: commands }
    }

    fn until(&mut self, what: &str, mut is_so: impl FnMut(&View) -> bool) {
        let began = Instant::now();
        loop {
            self.news.try_iter().for_each(|news| self.view.take(news));
            if is_so(&self.view) {
                return;
            }
            assert!(began.elapsed() < WITHIN, "never {what}");
            thread::sleep(Duration::from_millis(20));
        }
    }
}

fn text<'a>(view: &'a View, key: &str) -> Option<&'a str> {
    view.state().get(key)?.as_str()
}

#[test]
fn a_board_that_is_unplugged_and_plugged_in_again_or_speaks_another_version_is_watched_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path().join("board");
    let plug = || {
        let (board, mut port) = TTYPort::pair().expect("this machine has ptys");
        port.set_exclusive(false).unwrap();
        let _none = std::fs::remove_file(&at);
        std::os::unix::fs::symlink(port.name().expect("a pty has a name"), &at).unwrap();
        (board, port)
    };
    // As long as it takes: what is said before the port is opened is lost, as on a cable.
    let say = |board: &mut TTYPort, watch: &mut Watch| {
        let mut numbers = 0..;
        watch.until("messages", |view| {
            board.write_all(&frame(numbers.next().unwrap())).unwrap();
            text(view, "gone").is_none() && view.counts.messages > 0
        });
    };
    let (mut board, port) = plug();
    let mut watch = Watch::of(at.to_str().unwrap());
    say(&mut board, &mut watch);
    // Garbage is counted, and what comes after it is heard.
    let before = watch.view.counts;
    board.write_all(&[&[0x55; 2_000][..], &[0]].concat()).unwrap();
    board.write_all(&foreign()).unwrap();
    let said = format!("of version {}, and this tool speaks {VERSION}", VERSION + 1);
    watch.until(&said, |view| text(view, "other_version").is_some_and(|own| own.starts_with(&said)));
    assert_eq!(watch.view.counts.bad_frames, before.bad_frames + 2);
    // It was flashed anew.
    say(&mut board, &mut watch);
    watch.until("this version again", |view| text(view, "other_version").is_none());
    // The cable is pulled: the port is gone, and so is its name.
    std::fs::remove_file(&at).unwrap();
    drop((board, port));
    watch.until("gone", |view| text(view, "gone").is_some());
    let (mut board, _port) = plug();
    watch.until("back", |view| text(view, "gone").is_none());
    say(&mut board, &mut watch);
}
