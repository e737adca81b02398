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

/// What hangs on a serial port of the chip.
pub trait FarEnd: Peer {
    /// How many bytes it has by now, each of which takes so long: one after the other without a pause.
    fn ready(&self, now: VirtualNanos, frame_ns: u64) -> u64;

    /// When the last byte set out on its way down.
    fn last_down(&self) -> Option<VirtualNanos>;
}

impl FarEnd for Line {
    fn ready(&self, _now: VirtualNanos, _frame_ns: u64) -> u64 {
        self.down.len() as u64
    }

    fn last_down(&self) -> Option<VirtualNanos> {
        self.last_down
    }
}

/// The wires of the palm's bus, as one finger's transceiver shows them.
#[derive(Debug, Default)]
pub struct BusEnd {
    /// Bytes that the port sent, and when each was over.
    pub up: Vec<(VirtualNanos, u8)>,
    /// Bytes on the wires, and when each begins.
    pub down: VecDeque<(VirtualNanos, u8)>,
    /// Bytes that it has taken.
    pub heard: Vec<u8>,
    last_down: Option<VirtualNanos>,
}

impl Store for BusEnd {}

impl Peer for BusEnd {
    fn receive(&mut self, word: u16, context: &mut Timeline<'_, '_>) {
        self.up.push((context.now(), word as u8));
    }

    fn transmit(&mut self, now: VirtualNanos) -> Option<u16> {
        let (_, byte) = self.down.pop_front_if(|(begins, _)| *begins <= now)?;
        self.heard.push(byte);
        self.last_down = Some(now);
        Some(u16::from(byte))
    }
}

impl FarEnd for BusEnd {
    fn ready(&self, now: VirtualNanos, frame_ns: u64) -> u64 {
        let in_time =
            self.down.iter().zip(0..).take_while(|((begins, _), n)| begins.0 <= now.0 + n * frame_ns);
        in_time.count() as u64
    }

    fn last_down(&self) -> Option<VirtualNanos> {
        self.last_down
    }
}

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
