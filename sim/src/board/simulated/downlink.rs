//! The host board's line down: the plant's own commands, and bytes that become commands through the same receiver and the
//! same allowance as in the image.

use std::collections::VecDeque;

use tenax_hal_shim::wire::{BadFrame, Counters, Down, Received, Receiver};
use tenax_logic::allowance::{Allowance, BURST};

#[derive(Debug, Default)]
pub struct Downlink {
    receiver: Receiver,
    allowance: Allowance,
    frame: u32,
    waiting: VecDeque<Received<Down>>,
    bad_frames: u32,
    skipped: u32,
    number: u16,
    hello: Option<u16>,
    opening: Option<u32>,
}

impl Downlink {
    pub fn number(&mut self, message: Down) -> Received<Down> {
        let sequence = self.number;
        self.number = sequence.wrapping_add(1);
        if message == Down::Hello {
            self.hello = Some(sequence);
        }
        Received { sequence, message }
    }

    pub fn offered(&mut self, of: u16, nonce: u32) {
        if self.hello == Some(of) {
            self.hello = None;
            self.opening = Some(nonce);
        }
    }

    pub fn opening(&mut self) -> Vec<Received<Down>> {
        self.opening.take().map(|nonce| self.number(Down::Open { nonce })).into_iter().collect()
    }

    pub fn take(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            let frame = self.frame;
            match self.receiver.push_if::<Down>(byte, || self.allowance.admits(frame)) {
                None => {}
                Some(Ok(command))
                    if self.allowance.affords(&command.message) && self.waiting.len() < BURST as usize =>
                {
                    self.waiting.push_back(command);
                }
                Some(Ok(_) | Err(BadFrame::Skipped)) => self.skipped += 1,
                Some(Err(_)) => self.bad_frames += 1,
            }
        }
    }

    pub fn command(&mut self, frame: u32) -> Option<Received<Down>> {
        self.frame = frame;
        self.waiting.pop_front()
    }

    pub fn counters(&self, frames: u32) -> Counters {
        Counters {
            frames,
            ticks: frames,
            bad_frames: self.bad_frames,
            commands_skipped: self.skipped,
            ..Counters::default()
        }
    }
}
