//! What comes up a line: messages, the gaps between their numbers, and what is no message. Nothing on it is trusted.

use std::fmt::{self, Display};

use tenax_hal_shim::wire::{BadFrame, Received, Receiver, Up};

/// What came, and what should have come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    pub messages: u64,
    /// Frames that were no message.
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

/// A message, and how many are missing before it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Heard {
    /// The message and its number.
    pub received: Received<Up>,
    /// Messages missing between the last one and this.
    pub missed: u16,
}

/// Takes a line's bytes as they come and gives messages.
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_hal_shim::wire::{Answer, FRAME_MAX, encode};

    fn frame(sequence: u16) -> Vec<u8> {
        let message = Up::Answer { of: 7, frame: 0, answer: Answer::Done };
        encode(sequence, &message, &mut [0; FRAME_MAX]).expect("it fits").to_vec()
    }

    fn counts(bytes: &[u8]) -> Counts {
        let mut inbox = Inbox::default();
        bytes.iter().for_each(|&byte| _ = inbox.push(byte));
        inbox.counts()
    }

    #[test]
    fn gaps_in_the_numbers_are_counted_across_their_wrap() {
        let counted = counts(&[frame(65_534), frame(1), frame(2)].concat());
        assert_eq!(counted, Counts { messages: 3, bad_frames: 0, missed: 2 });
    }

    #[test]
    fn ten_minutes_of_numbers_come_round_five_times_and_any_shorter_gap_is_counted() {
        let mut inbox = Inbox::default();
        let mut hear = |number: u32| {
            frame(number as u16).into_iter().for_each(|byte| _ = inbox.push(byte));
            inbox.counts().missed
        };
        // 572 messages a second.
        assert_eq!((0..343_200).map(&mut hear).last(), Some(0));
        // A gap over a wrap, and the longest one that is told.
        let wrap = 6 * 65_536;
        (343_200..wrap - 10).for_each(|number| _ = hear(number));
        assert_eq!(hear(wrap + 1_000), 1_010);
        assert_eq!(hear(wrap + 1_001 + 65_535), 1_010 + 65_535);
        // What the page says of a longer one.
        assert_eq!(hear(wrap + 1_001 + 65_535 + 65_537 + 7), 1_010 + 65_535 + 7);
    }

    #[test]
    fn garbage_is_skipped_and_the_next_message_is_heard() {
        let mut torn = frame(0);
        torn[3] ^= 0x40;
        let counted = counts(&[torn, vec![0xff; 2_000], vec![0], frame(0)].concat());
        assert_eq!(counted, Counts { messages: 1, bad_frames: 2, missed: 0 });
    }

    #[test]
    fn a_board_that_starts_anew_counts_anew() {
        let hello = encode(0, &Up::Hello { frame_hz: 2_000, after: None }, &mut [0; FRAME_MAX])
            .expect("it fits")
            .to_vec();
        assert_eq!(counts(&[frame(700), hello, frame(1)].concat()).missed, 0);
    }
}
