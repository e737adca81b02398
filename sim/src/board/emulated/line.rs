//! The far end of the serial line, at the rate of the real one.

use std::collections::VecDeque;

use rigless::chip::Timeline;
use rigless::chip::uart::Peer;
use rigless::snapshot::Store;
use rigless::time::VirtualNanos;
use tenax_hal_shim::wire::{Answer, Receiver, Up};

#[derive(Debug, Default)]
pub struct Line {
    pub up: Vec<u8>,
    pub down: VecDeque<u8>,
    pub listener: Option<Receiver>,
    pub offered: Option<u32>,
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

    fn transmit(&mut self, _now: VirtualNanos) -> Option<u16> {
        self.down.pop_front().map(u16::from)
    }
}
