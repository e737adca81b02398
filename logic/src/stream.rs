//! Messages on request ([`Down::Stream`](tenax_hal_shim::wire::Down::Stream)); no decision depends on them.

use tenax_hal_shim::channel::{FRAME_HZ, FRAMES_PER_SLOW_FRAME, SWITCH_INPUTS};
use tenax_hal_shim::frame::Frame;
use tenax_hal_shim::wire::{FRAMES_PER_RAW, Raw};

const _: () = assert!((FRAMES_PER_SLOW_FRAME as usize).is_multiple_of(FRAMES_PER_RAW));
const EVER: u32 = u32::MAX;
pub const SENSES_SLOT: u8 = 2;

#[derive(Clone, Debug, Default)]
pub struct Stream {
    next: u32,
    pub raw: bool,
    senses: bool,
    left: u32,
    gathered: Raw,
    /// Sent in the tick after its last frame: two long messages do not fit in one.
    whole: Raw,
    is_whole: bool,
    pub raw_is_ready: bool,
    pub senses_are_due: bool,
    is_torn: bool,
}

impl Stream {
    pub const fn start(&mut self) {
        self.raw = true;
        self.left = EVER;
    }

    pub fn ask(&mut self, raw: bool, senses: bool, hold_s: u16) {
        self.is_torn |= raw && !self.raw && !(self.next as usize).is_multiple_of(FRAMES_PER_RAW);
        self.left = u32::from(hold_s) * FRAME_HZ;
        (self.raw, self.senses) = (raw && hold_s > 0, senses && hold_s > 0);
    }

    pub fn record(&mut self, frame: &Frame) {
        self.next = frame.sequence.wrapping_add(1);
        if self.left > 0 || self.is_whole {
            self.gather(frame);
        }
    }

    #[inline(never)]
    fn gather(&mut self, frame: &Frame) {
        self.raw_is_ready = core::mem::take(&mut self.is_whole);
        if self.raw {
            self.gathered.put(frame);
            if (frame.sequence as usize + 1).is_multiple_of(FRAMES_PER_RAW) {
                self.whole = self.gathered;
                self.is_whole = !core::mem::take(&mut self.is_torn);
            }
        }
        let all_came = frame.sequence >= SWITCH_INPUTS.into();
        self.senses_are_due = self.senses && frame.slot() == SENSES_SLOT && all_came;
        if self.left != EVER && self.left > 0 {
            self.left -= 1;
            let goes_on = self.left > 0;
            (self.raw, self.senses) = (self.raw && goes_on, self.senses && goes_on);
        }
    }

    pub const fn next(&self) -> u32 {
        self.next
    }

    pub fn take_raw(&mut self) -> Option<Raw> {
        core::mem::take(&mut self.raw_is_ready).then_some(self.whole)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    fn firsts(stream: &mut Stream, frames: core::ops::Range<u32>) -> Vec<u32> {
        let step = |sequence| {
            stream.record(&Frame::lost(sequence));
            stream.take_raw().map(|raw| raw.first)
        };
        frames.filter_map(step).collect()
    }

    #[test]
    fn frames_come_five_at_a_time_and_only_whole_fives() {
        let mut stream = Stream::default();
        assert_eq!(firsts(&mut stream, 0..7), []);
        stream.ask(true, false, 1);
        assert_eq!(firsts(&mut stream, 7..26), [10, 15, 20]);
        stream.ask(false, true, 1);
        assert_eq!(firsts(&mut stream, 26..53), []);
        assert!(stream.senses_are_due, "slot 2");
    }

    #[test]
    fn it_ends_when_nobody_asks_any_more_unless_it_is_for_ever() {
        let mut stream = Stream::default();
        stream.ask(true, true, 1);
        assert_eq!(firsts(&mut stream, 0..10 * FRAME_HZ).len(), FRAME_HZ as usize / FRAMES_PER_RAW);
        stream.start();
        let seen = firsts(&mut stream, 0..10 * FRAME_HZ + 1).len();
        assert_eq!(seen, 10 * FRAME_HZ as usize / FRAMES_PER_RAW);
        stream.ask(true, true, 0);
        assert_eq!(firsts(&mut stream, 0..100), []);
    }
}
