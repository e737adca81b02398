//! The page's view of a board that goes away and comes back, of garbage and of another version: on real pseudo-terminals and
//! sockets.
//!
//! A program of its own: whatever another test starts would inherit these pseudo-terminals and pass for their holder.
#![cfg(unix)]

use std::io::Write;
use std::net::TcpListener;
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
fn a_board_that_is_served_again_is_watched_again() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let mut watch = Watch::of(&format!("tcp:{address}"));
    let serve = |listener: &TcpListener, sequence| {
        let (mut stream, _) = listener.accept().unwrap();
        stream.write_all(&frame(sequence)).unwrap();
        stream
    };
    let stream = serve(&listener, 7);
    watch.until("the first message", |view| view.counts.messages == 1);
    drop((stream, listener));
    watch.until("gone", |view| text(view, "gone").is_some());
    // Long enough for it to have been refused.
    thread::sleep(Duration::from_millis(1_200));
    let listener = TcpListener::bind(address).unwrap();
    let mut stream = serve(&listener, 0);
    watch.until("back", |view| text(view, "gone").is_none() && view.counts.messages == 1);

    // Garbage is counted, and what comes after it is heard.
    stream.write_all(&[&[0x55; 2_000][..], &[0], &frame(1)].concat()).unwrap();
    watch.until("the garbage", |view| {
        (view.counts.missed, view.counts.bad_frames, view.counts.messages) == (0, 1, 2)
    });
    stream.write_all(&foreign()).unwrap();
    let said = format!("of version {}, and this tool speaks {VERSION}", VERSION + 1);
    let is_foreign = |view: &View| text(view, "other_version").is_some_and(|own| own.starts_with(&said));
    watch.until(&said, is_foreign);
    // It was flashed anew.
    stream.write_all(&frame(2)).unwrap();
    watch.until("this version again", |view| text(view, "other_version").is_none());
}

#[test]
fn a_board_that_is_unplugged_and_plugged_in_again_is_watched_again() {
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
    // The cable is pulled: the port is gone, and so is its name.
    std::fs::remove_file(&at).unwrap();
    drop((board, port));
    watch.until("gone", |view| text(view, "gone").is_some());
    let (mut board, _port) = plug();
    watch.until("back", |view| text(view, "gone").is_none());
    say(&mut board, &mut watch);
}
