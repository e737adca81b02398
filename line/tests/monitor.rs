//! The monitor on a real serial line (a pty pair), with garbage on it, and unplugged.

use std::io::{Cursor, ErrorKind, Read, Write};
use std::thread;
use std::time::Duration;

use serialport::{SerialPort, TTYPort};
use tenax_hal_shim::wire::{Counters, FRAME_MAX, Up, encode};
use tenax_frames::link::{Client, Counts, Line};
use tenax_line::monitor;

fn frame(sequence: u16) -> Vec<u8> {
    let message = Up::Counters(Counters { frames: u32::from(sequence), ..Counters::default() });
    encode(sequence, &message, &mut [0; FRAME_MAX]).expect("it fits").to_vec()
}

/// Watches a line to its end: how it ended, what was counted and what was printed.
fn watch(up: impl Read + Send + 'static) -> (ErrorKind, Counts, String) {
    let (mut client, mut out) = (Client::from(Line { up: Box::new(up), down: None }), Vec::new());
    let end = monitor::watch(&mut client, &mut out).unwrap();
    (end.kind(), client.counts(), String::from_utf8(out).unwrap())
}

#[test]
fn a_board_that_is_unplugged_ends_the_watch_with_a_reason() {
    let (mut board, mut port) = TTYPort::pair().expect("this machine has ptys");
    port.set_timeout(Duration::from_millis(50)).unwrap();
    let unread = port.try_clone_native().unwrap();
    let sender = thread::spawn(move || {
        // It was switched on in the middle of a message, sends two, loses one, and has its cable pulled.
        board.write_all(&frame(0)[5..]).unwrap();
        for sequence in [1, 2, 4] {
            board.write_all(&frame(sequence)).unwrap();
        }
        board.flush().unwrap();
        // What is not read when the near end closes is lost.
        thread::sleep(Duration::from_millis(200));
        while unread.bytes_to_read().unwrap() > 0 {
            thread::sleep(Duration::from_millis(5));
        }
    });
    let (_, counts, text) = watch(port);
    sender.join().unwrap();
    assert_eq!(counts, Counts { messages: 3, bad_frames: 1, missed: 1 }, "{text}");
    assert!(text.contains("    2 counters: 2 frames"), "{text}");
    assert!(text.contains("# 1 messages missed\n    4 counters"), "said where they are missing: {text}");
}

#[test]
fn random_bytes_are_survived_and_counted() {
    // xorshift: any bytes will do, the same each time.
    let mut state = 0x2545_F491_4F6C_DD1D_u64;
    let noise = std::iter::repeat_with(|| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state as u8
    });
    let mut bytes: Vec<u8> = noise.take(1 << 20).collect();
    bytes.push(0);
    bytes.extend(frame(9));
    let (end, counts, _) = watch(Cursor::new(bytes));
    assert_eq!(end, ErrorKind::UnexpectedEof);
    assert_eq!(counts.messages, 1, "a CRC-32 lets one in four billion through");
    assert!(counts.bad_frames > 3_000, "{counts}");
}
