//! What a monitor's screen makes of a board that goes away and comes back, of garbage and of another version: on real
//! pseudo-terminals and sockets, drawn as a person sees it.

use std::io::Write;
use std::net::{TcpListener, TcpStream};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use ratatui::Terminal;
use ratatui::backend::TestBackend;
use serialport::{SerialPort, TTYPort};
use tenax_hal_shim::wire::{Counters, FRAME_MAX, Up, VERSION, encode};
use tenax_serial::link::Target;
use tenax_serial::monitor::screen::{Shown, draw};
use tenax_serial::monitor::source::{News, Places, start};
use tenax_serial::monitor::view::View;

const WITHIN: Duration = Duration::from_secs(20);

fn frame(sequence: u16) -> Vec<u8> {
    let message = Up::Counters(Counters { frames: 1, ..Counters::default() });
    encode(sequence, &message, &mut [0; FRAME_MAX]).expect("it fits").to_vec()
}

/// The same of another version: its CRC is right.
fn foreign() -> Vec<u8> {
    let mut plain = vec![VERSION + 1, 0, 3, 0];
    plain.extend(crc32(&plain).to_le_bytes());
    let mut framed = vec![0; 32];
    let length = cobs(&plain, &mut framed);
    framed.truncate(length);
    framed
}

/// ISO-HDLC.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32| (0..8).fold(crc, |crc, _| crc >> 1 ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 });
    !bytes.iter().fold(!0, |crc, &byte| step(crc ^ u32::from(byte)))
}

fn cobs(plain: &[u8], out: &mut [u8]) -> usize {
    let (mut code_at, mut at) = (0, 1);
    for &byte in plain {
        if byte == 0 {
            out[code_at] = (at - code_at) as u8;
            code_at = at;
        } else {
            out[at] = byte;
        }
        at += 1;
    }
    out[code_at] = (at - code_at) as u8;
    at + 1
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

    fn picture(&self) -> String {
        let mut terminal = Terminal::new(TestBackend::new(80, 24)).unwrap();
        terminal.draw(|frame| draw(frame, &self.view, &self.shown)).unwrap();
        let buffer = terminal.backend().buffer();
        let line = |y| (0..80).map(|x| buffer[(x, y)].symbol()).collect::<String>();
        (0..24).map(|y| line(y) + "\n").collect()
    }

    /// Draws until the picture is as wanted.
    fn shows(&mut self, what: &str, is_wanted: impl Fn(&str, &View) -> bool) {
        let began = Instant::now();
        loop {
            while let Ok(news) = self.news.try_recv() {
                self.view.take(news);
            }
            let picture = self.picture();
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
