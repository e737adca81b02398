//! The far end of the serial line, at the rate of the real one.

use std::collections::VecDeque;

use rigless::chip::Timeline;
use rigless::chip::uart::Peer;
use rigless::snapshot::Store;
use rigless::time::VirtualNanos;
use tenax_hal_shim::wire::{Answer, Receiver, Up};

/// What a PC would have read, and what it has yet to send.
#[derive(Debug, Default)]
pub struct Line {
    /// Every byte that came up.
    pub up: Vec<u8>,
    /// Bytes on their way down; the model takes each when the one before has arrived.
    pub down: VecDeque<u8>,
    /// Listens for the number that a session opens with, once it was asked for.
    pub listener: Option<Receiver>,
    /// That number.
    pub offered: Option<u32>,
    /// When the last byte set out on its way down.
    pub last_down: Option<VirtualNanos>,
}

impl Store for Line {}

impl Peer for Line {
    fn receive(&mut self, word: u16, _context: &mut Timeline<'_, '_>) {
        self.up.push(word as u8);
        let heard = self.listener.as_mut().and_then(|listener| listener.push::<Up>(word as u8));
        if let Some(Ok(heard)) = heard
            && let Up::Answer { answer: Answer::Nonce(nonce), .. } = heard.message
        {
            self.offered = Some(nonce);
            self.listener = None;
        }
    }

    fn transmit(&mut self, now: VirtualNanos) -> Option<u16> {
        let byte = self.down.pop_front()?;
        self.last_down = Some(now);
        Some(u16::from(byte))
    }
}
