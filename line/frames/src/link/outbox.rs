//! Commands to numbered frames.

use std::io::{self, Write};
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use serde::Serialize;
use tenax_hal_shim::wire::{Down, FRAME_MAX, encode};

/// One end of a line, which numbers what it sends: a board from 0 on.
#[derive(Debug, Default)]
pub struct Encoder {
    next: u16,
    frame: Vec<u8>,
}

impl Encoder {
    /// The message's number and its frame, the final zero included. The frame of a message that is longer than any of
    /// the protocol is empty: its number is missing at the other end.
    pub fn frame(&mut self, message: &impl Serialize) -> (u16, &[u8]) {
        let number = self.next;
        self.next = number.wrapping_add(1);
        self.frame.resize(FRAME_MAX, 0);
        (number, encode(number, message, &mut self.frame).map_or(&[], |frame| frame))
    }
}

#[derive(Debug)]
pub struct Outbox<W> {
    line: W,
    encoder: Encoder,
}

impl<W: Write> Outbox<W> {
    /// Numbers what it sends from where no other client of a line does: each takes the answers with its own numbers for its own.
    pub fn new(line: W) -> Self {
        static OPENED: AtomicU32 = AtomicU32::new(0);
        let next = first_number(std::process::id(), OPENED.fetch_add(1, Relaxed));
        Self { line, encoder: Encoder { next, ..Encoder::default() } }
    }

    /// Sends one command; returns its number, which its answer names.
    pub fn send(&mut self, command: &Down) -> io::Result<u16> {
        let (number, frame) = self.encoder.frame(command);
        self.line.write_all(frame)?;
        self.line.flush()?;
        Ok(number)
    }
}

/// Multiples of 2^16 by golden ratio and root of two: processes and outboxes that follow each other begin far apart.
const fn first_number(process: u32, nth: u32) -> u16 {
    process.wrapping_mul(40_503).wrapping_add(nth.wrapping_mul(27_146)) as u16
}

#[cfg(test)]
mod tests {
    use super::first_number;

    #[test]
    fn clients_of_one_line_begin_far_apart() {
        for process in [1, 4_000, 65_535] {
            // Programs that are started one after the other, and outboxes of one program.
            let programs: Vec<u16> = (0..8).map(|n| first_number(process + n, 0)).collect();
            let outboxes: Vec<u16> = (0..8).map(|n| first_number(process, n)).collect();
            for numbers in [programs, outboxes] {
                for (n, a) in numbers.iter().enumerate() {
                    let apart = |b: &u16| a.wrapping_sub(*b).min(b.wrapping_sub(*a));
                    assert!(numbers[..n].iter().all(|b| apart(b) > 2_000), "{numbers:?}");
                }
            }
        }
    }
}
