//! Messages to bytes: the one place where the tool numbers messages and writes them as frames.

use serde::Serialize;
use tenax_hal_shim::wire::{FRAME_MAX, encode};

/// One end of a line, which numbers what it sends from 0 on.
#[derive(Debug)]
pub struct Encoder {
    next: u16,
    buffer: [u8; FRAME_MAX],
}

impl Default for Encoder {
    fn default() -> Self {
        Self { next: 0, buffer: [0; FRAME_MAX] }
    }
}

impl Encoder {
    /// The message's number and its frame, the final zero included. The frame of a message that is longer than any of
    /// the protocol is empty: its number is missing at the other end.
    pub fn frame(&mut self, message: &impl Serialize) -> (u16, &[u8]) {
        let number = self.next;
        self.next = number.wrapping_add(1);
        let frame: &[u8] = match encode(number, message, &mut self.buffer) {
            Some(frame) => frame,
            None => &[],
        };
        (number, frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_hal_shim::wire::{Down, Receiver};

    #[test]
    fn numbers_follow_one_another_across_their_wrap() {
        let mut encoder = Encoder { next: 65_535, ..Encoder::default() };
        let mut receiver = Receiver::new();
        for expected in [65_535, 0, 1] {
            let (number, frame) = encoder.frame(&Down::Ping);
            assert_eq!(number, expected);
            let heard = frame.iter().filter_map(|&byte| receiver.push::<Down>(byte)).next();
            assert_eq!(heard.unwrap().unwrap().sequence, expected);
        }
    }
}
