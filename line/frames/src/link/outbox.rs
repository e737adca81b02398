//! Commands to numbered frames.

use std::io::{self, Write};

use serde::Serialize;
use tenax_hal_shim::wire::{Down, FRAME_MAX, encode};

/// One end of a line, which numbers what it sends from 0 on.
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
    pub fn new(line: W) -> Self {
        Self { line, encoder: Encoder::default() }
    }

    /// Sends one command; returns its number, which its answer names.
    pub fn send(&mut self, command: &Down) -> io::Result<u16> {
        let (number, frame) = self.encoder.frame(command);
        self.line.write_all(frame)?;
        self.line.flush()?;
        Ok(number)
    }
}
