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
