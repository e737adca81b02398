//! What a monitor's screen makes of a board that goes away and comes back, of garbage and of another version: on real
//! pseudo-terminals and sockets, drawn as a person sees it.
//!
//! A program of its own: whatever another test starts would inherit these pseudo-terminals and pass for their holder.
#![cfg(unix)]

#[path = "line/picture.rs"]
mod picture;

use std::io::Write;
use std::net::{TcpListener, TcpStream};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use crc::{CRC_32_ISO_HDLC, Crc};
use serialport::{SerialPort, TTYPort};
use tenax_hal_shim::wire::{Counters, FRAME_MAX, Up, VERSION, encode};
use tenax_frames::link::Target;
use tenax_line::monitor::screen::Shown;
use tenax_line::monitor::source::{News, Places, start};
use tenax_line::monitor::view::View;

use self::picture::picture;

const WITHIN: Duration = Duration::from_secs(20);

fn frame(sequence: u16) -> Vec<u8> {
    let message = Up::Counters(Counters { frames: 1, ..Counters::default() });
    encode(sequence, &message, &mut [0; FRAME_MAX]).expect("it fits").to_vec()
}

/// The same of another version: its CRC is right.
fn foreign() -> Vec<u8> {
    let mut plain = vec![VERSION + 1, 0, 3, 0];
    let crc = Crc::<u32>::new(&CRC_32_ISO_HDLC).checksum(&plain);
    plain.extend(crc.to_le_bytes());
    let mut framed = vec![0; cobs::max_encoding_length(plain.len()) + 1];
    let length = cobs::encode(&plain, &mut framed);
    framed.truncate(length + 1);
    framed
}

struct Screen {
    view: View,
    news: Receiver<News>,
    shown: Shown,
    _commands: std::sync::mpsc::Sender<tenax_hal_shim::wire::Down>,
}

impl Screen {
    fn watching(place: &str) -> Self {
        let (commands, waiting) = channel();
        let (sender, news) = channel();
        let line: Target = place.parse().unwrap();
        start(&Places { line, truth: None }, waiting, sender);
        let shown = Shown { place: place.to_owned(), ..Shown::default() };
        Self { view: View::default(), news, shown, _commands: commands }
    }

    /// Draws until the picture is as wanted.
    fn shows(&mut self, what: &str, is_wanted: impl Fn(&str, &View) -> bool) {
        let began = Instant::now();
        loop {
            while let Ok(news) = self.news.try_recv() {
                self.view.take(news);
            }
            let picture = picture(&self.view, &self.shown, 80, 24);
            if is_wanted(&picture, &self.view) {
                return;
            }
            assert!(began.elapsed() < WITHIN, "it never shows {what}:\n{picture}");
            thread::sleep(Duration::from_millis(20));
        }
    }
}

#[test]
fn a_board_that_is_served_again_is_watched_again() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let place = format!("tcp:{}", listener.local_addr().unwrap());
    let mut screen = Screen::watching(&place);
    let serve = |listener: &TcpListener, sequence| -> TcpStream {
        let (mut stream, _) = listener.accept().unwrap();
        stream.write_all(&frame(sequence)).unwrap();
        stream
    };
    let stream = serve(&listener, 7);
    screen.shows("the first message", |_, view| view.counts.messages == 1);
    // The run is over, and its port is nobody's.
    let address = listener.local_addr().unwrap();
    drop((stream, listener));
    screen.shows("that the line is gone", |picture, _| picture.contains("NO LINE, trying again"));
    // Long enough for it to have been refused.
    thread::sleep(Duration::from_millis(1_200));
    screen.shows("that it still tries", |picture, _| picture.contains("NO LINE, trying again"));
    let listener = TcpListener::bind(address).unwrap();
    let mut stream = serve(&listener, 0);
    screen
        .shows("that it is back", |picture, view| !picture.contains("NO LINE") && view.counts.messages == 1);

    // Garbage is counted, and what comes after it is heard.
    stream.write_all(&[0x55; 2_000]).unwrap();
    stream.write_all(&[0]).unwrap();
    stream.write_all(&frame(1)).unwrap();
    screen.shows("the garbage", |picture, view| {
        picture.contains("missed 0 bad 1") && view.counts.messages == 2
    });

    stream.write_all(&foreign()).unwrap();
    let said = format!("a board of version {}, and this tool speaks {VERSION}", VERSION + 1);
    screen.shows(&said, |picture, _| picture.contains(&said));
    // It was flashed anew.
    stream.write_all(&frame(2)).unwrap();
    screen.shows("this version again", |picture, _| !picture.contains(&said));
}

#[test]
fn a_board_that_is_unplugged_and_plugged_in_again_is_watched_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path().join("board");
    let plug = || {
        let (board, mut port) = TTYPort::pair().expect("this machine has ptys");
        port.set_exclusive(false).unwrap();
        let name = port.name().expect("a pty has a name");
        let _none = std::fs::remove_file(&at);
        std::os::unix::fs::symlink(name, &at).unwrap();
        (board, port)
    };
    let (board, port) = plug();
    let mut screen = Screen::watching(at.to_str().unwrap());
    // As long as it takes: what is said before the monitor has opened the port is lost, as on a cable.
    let say = |board: TTYPort, screen: &mut Screen| {
        let sequence = std::cell::Cell::new(0);
        let board = std::cell::RefCell::new(board);
        screen.shows("messages", |_, view| {
            board.borrow_mut().write_all(&frame(sequence.get())).unwrap();
            sequence.set(sequence.get().wrapping_add(1));
            view.gone.is_none() && view.counts.messages > 0
        });
        board.into_inner()
    };
    let board = say(board, &mut screen);
    // The cable is pulled: the port is gone, and so is its name.
    std::fs::remove_file(&at).unwrap();
    drop((board, port));
    screen.shows("that the line is gone", |picture, _| picture.contains("NO LINE, trying again"));
    let (board, _port) = plug();
    screen.shows("that it is back", |picture, _| !picture.contains("NO LINE"));
    say(board, &mut screen);
}
