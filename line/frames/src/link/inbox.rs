//! Messages from a line's bytes. Gaps in their numbers and frames that are no message are counted.

use std::fmt::{self, Display};

use tenax_hal_shim::wire::{BadFrame, Received, Receiver, Up};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    pub messages: u64,
    pub bad_frames: u64,
    /// Messages missing by their numbers: dropped by the board, or lost on the way.
    pub missed: u64,
}

impl Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { messages, bad_frames, missed } = self;
        write!(f, "{messages} messages, {bad_frames} bad frames skipped, {missed} messages missed")
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Heard {
    pub received: Received<Up>,
    pub missed: u16,
}

#[derive(Debug, Default)]
pub struct Inbox {
    receiver: Receiver,
    expected: Option<u16>,
    counts: Counts,
}

impl Inbox {
    /// Takes one byte. Some when it ends a frame.
    pub fn push(&mut self, byte: u8) -> Option<Result<Heard, BadFrame>> {
        let heard = match self.receiver.push::<Up>(byte)? {
            Err(bad) => {
                self.counts.bad_frames += 1;
                return Some(Err(bad));
            }
            Ok(received) => received,
        };
        // A board that starts counts from its first message again: that is not a loss.
        let restarted = matches!(heard.message, Up::Hello { .. });
        let missed = match self.expected {
            Some(expected) if !restarted => heard.sequence.wrapping_sub(expected),
            _ => 0,
        };
        self.expected = Some(heard.sequence.wrapping_add(1));
        self.counts.messages += 1;
        self.counts.missed += u64::from(missed);
        Some(Ok(Heard { received: heard, missed }))
    }

    pub const fn counts(&self) -> Counts {
        self.counts
    }

    pub const fn count_on(&mut self, before: Counts) {
        self.counts.messages += before.messages;
        self.counts.bad_frames += before.bad_frames;
        self.counts.missed += before.missed;
    }
}
