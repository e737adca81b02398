//! The far end of the serial line, at the rate of the real one.

use std::collections::VecDeque;

use rigless::chip::Timeline;
use rigless::chip::uart::Peer;
use rigless::snapshot::Store;
use rigless::time::VirtualNanos;

/// What a PC would have read, and what it has yet to send.
#[derive(Debug, Default)]
pub struct Line {
    /// Every byte that came up.
    pub up: Vec<u8>,
    /// Bytes on their way down; the model takes each when the one before has arrived.
    pub down: VecDeque<u8>,
}

impl Store for Line {}

impl Peer for Line {
    fn receive(&mut self, word: u16, _context: &mut Timeline<'_, '_>) {
        self.up.push(word as u8);
    }

    fn transmit(&mut self, _now: VirtualNanos) -> Option<u16> {
        self.down.pop_front().map(u16::from)
    }
}
