//! A fingertip's line through a palm's: what comes up and goes down it travels in the palm's messages.

use std::collections::VecDeque;
use std::io::{self, Read, Write};

use tenax_hal_shim::wire::{FRAME_MAX, Receiver, encode};
use tenax_palm::line::{Down, PIECE_DOWN, Up};

use super::Line;

/// The line of a finger, from 1 on, of the palm at `line`.
pub fn finger(line: Line, finger: u8) -> Line {
    let up = FromFinger { palm: line.up, finger, receiver: Receiver::new(), ready: VecDeque::new() };
    let down = line.down.map(|palm| Box::new(ToFinger { palm, finger, number: 0 }) as Box<dyn Write + Send>);
    Line { up: Box::new(up), down }
}

struct FromFinger {
    palm: Box<dyn Read + Send>,
    finger: u8,
    receiver: Receiver,
    ready: VecDeque<u8>,
}

impl Read for FromFinger {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while self.ready.is_empty() {
            let mut bytes = [0; 4096];
            let length = self.palm.read(&mut bytes)?;
            if length == 0 {
                return Ok(0);
            }
            for &byte in &bytes[..length] {
                if let Some(Ok(heard)) = self.receiver.push::<Up>(byte)
                    && let Up::Line { finger, bytes } = heard.message
                    && finger == self.finger
                {
                    self.ready.extend(bytes);
                }
            }
        }
        self.ready.read(buffer)
    }
}

struct ToFinger {
    palm: Box<dyn Write + Send>,
    finger: u8,
    number: u16,
}

impl Write for ToFinger {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        for piece in buffer.chunks(PIECE_DOWN) {
            let down = Down::Line { finger: self.finger, bytes: piece.iter().copied().collect() };
            self.palm.write_all(&frame(self.number, &down))?;
            self.number = self.number.wrapping_add(1);
        }
        Ok(buffer.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.palm.flush()
    }
}

/// A message to a palm.
pub fn frame(number: u16, down: &Down) -> Vec<u8> {
    encode(number, down, &mut [0; FRAME_MAX]).expect("every message fits").to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::{Client, Encoder};
    use std::sync::mpsc::{Sender, channel};
    use tenax_hal_shim::wire::{self, Answer, Received};

    struct Sent(Sender<u8>);

    impl Write for Sent {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            bytes.iter().for_each(|&byte| self.0.send(byte).unwrap());
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_fingers_messages_are_told_from_its_neighbours_and_commands_reach_it() {
        let mut encoder = Encoder::default();
        let mut up = vec![0xFF, 0];
        for n in 0..40u16 {
            let message = wire::Up::Answer { of: n, frame: 0, answer: Answer::Done };
            for (n, piece) in encoder.frame(&message).1.chunks(3).enumerate() {
                let bytes = |bytes: &[u8]| bytes.iter().copied().collect();
                for line in [
                    Up::Line { finger: 1, bytes: bytes(&[7; 5]) },
                    Up::Line { finger: 2, bytes: bytes(piece) },
                ] {
                    up.extend_from_slice(encode(n as u16, &line, &mut [0; FRAME_MAX]).unwrap());
                }
            }
        }
        let (sent, bytes) = channel();
        let palm = Line { up: Box::new(io::Cursor::new(up)), down: Some(Box::new(Sent(sent))) };
        let mut client = Client::from(finger(palm, 2));
        for n in 0..40 {
            let heard = client.next_message().unwrap().expect("it came");
            assert!(matches!(heard.received.message, wire::Up::Answer { of, .. } if of == n), "{heard:?}");
        }
        assert_eq!((client.counts().missed, client.counts().bad_frames), (0, 0));

        client.send(&wire::Down::Ping).unwrap();
        let mut receiver = Receiver::new();
        let palms: Vec<Received<Down>> =
            bytes.try_iter().filter_map(|byte| receiver.push::<Down>(byte)).map(Result::unwrap).collect();
        let [Received { message: Down::Line { finger: 2, bytes }, .. }] = palms.as_slice() else {
            panic!("{palms:?}")
        };
        let mut receiver = Receiver::new();
        let command = bytes.iter().find_map(|&byte| receiver.push::<wire::Down>(byte)).unwrap().unwrap();
        assert_eq!(command.message, wire::Down::Ping);
    }
}
