//! The page's view of a board that goes away and comes back, of garbage and of another version.
//! A program of its own: what another test starts would inherit the pseudo-terminals and pass for their holder.
#![cfg(unix)]

use std::io::{Read, Write};
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use crc::{CRC_32_ISO_HDLC, Crc};
use serialport::{SerialPort, TTYPort};
use tenax_frames::link::{Board, Client};
use tenax_hal_shim::wire::{
    About, Answer, Counters, Down, FRAME_MAX, Identity, Receiver as Frames, Up, VERSION, encode,
};
use tenax_line::view::View;
use tenax_line::web::pages::Pages;
use tenax_line::web::source::{News, start};

const WITHIN: Duration = Duration::from_secs(20);

fn frame(sequence: u16) -> Vec<u8> {
    let message = Up::Counters(Counters { frames: 1, ..Counters::default() });
    encode(sequence, &message, &mut [0; FRAME_MAX]).expect("it fits").to_vec()
}

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
    pages: Pages,
    news: Receiver<News>,
    _commands: Sender<Down>,
}

impl Watch {
    fn of(place: &str) -> Self {
        let ((commands, waiting), (sender, news)) = (channel(), channel());
        start(&place.parse().unwrap(), waiting, sender);
        Self { pages: Pages::default(), news, _commands: commands }
    }

    fn until(&mut self, what: &str, mut is_so: impl FnMut(&View) -> bool) {
        let began = Instant::now();
        loop {
            self.news.try_iter().for_each(|news| self.pages.take(news));
            if is_so(&self.pages.view) {
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
    let before = watch.pages.view.counts;
    board.write_all(&[&[0x55; 2_000][..], &[0]].concat()).unwrap();
    board.write_all(&foreign()).unwrap();
    let said = format!("of version {}, and this tool speaks {VERSION}", VERSION + 1);
    watch.until(&said, |view| text(view, "other_version").is_some_and(|own| own.starts_with(&said)));
    assert_eq!(watch.pages.view.counts.bad_frames, before.bad_frames + 2);
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

/// A board that says its chip, and its port.
fn board_of(chip: u32) -> String {
    let (mut board, port) = TTYPort::pair().expect("this machine has ptys");
    let place = port.name().expect("a pty has a name");
    board.set_timeout(WITHIN).unwrap();
    thread::spawn(move || {
        // Held, so that the pty stays when a client leaves.
        let _port = port;
        let (mut frames, mut byte) = (Frames::default(), [0]);
        while board.read(&mut byte).is_ok() {
            let Some(Ok(heard)) = frames.push::<Down>(byte[0]) else { continue };
            let identity = Identity { chip: [chip; 3], ..Identity::default() };
            let answer = Answer::About(About { identity, ..About::default() });
            let answer = Up::Answer { of: heard.sequence, frame: 0, answer };
            board.write_all(encode(0, &answer, &mut [0; FRAME_MAX]).unwrap()).unwrap();
        }
    });
    place
}

/// Ports that are plugged in.
static PORTS: Mutex<Vec<String>> = Mutex::new(Vec::new());

#[test]
fn a_board_is_its_chip_wherever_it_is_plugged_in() {
    let folder = tempfile::tempdir().unwrap();
    let [near, far] = ["near", "far"].map(|name| folder.path().join(name));
    let plug = |boards: [&str; 2]| {
        for (port, board) in [&near, &far].into_iter().zip(boards) {
            let _none = std::fs::remove_file(port);
            std::os::unix::fs::symlink(board, port).unwrap();
        }
    };
    let (left, right) = (board_of(1), board_of(2));
    plug([&left, &right]);
    let place = near.to_str().unwrap();
    *PORTS.lock().unwrap() = vec![place.to_owned(), far.to_str().unwrap().to_owned()];
    let mut board = Board { ports: || PORTS.lock().unwrap().clone(), ..Board::at(place.parse().unwrap()) };
    let opened =
        |board: &mut Board| board.open().map(|(client, moved): (Client, _)| (client.can_send(), moved));
    assert_eq!(opened(&mut board).unwrap(), (true, None));
    assert_eq!(board.chip, Some([1; 3]));
    // The plugs are swapped.
    plug([&right, &left]);
    let (_, moved) = opened(&mut board).unwrap();
    let words = format!("chip 000000010000000100000001 was at {place}, and is at {} now", far.display());
    assert_eq!((moved, board.line.to_string()), (Some(words), far.display().to_string()));
    // Another board is in its place, and it is nowhere.
    plug([&right, &right]);
    let error = opened(&mut board).unwrap_err().to_string();
    assert!(
        error.ends_with("is chip 000000020000000200000002, and not chip 000000010000000100000001"),
        "{error}"
    );
}
