//! The select lines of the analogue switches: whether the switches show the inputs that the board asks for.
//!
//! Inputs [`HIGH_SELECT`] and [`LOW_SELECT`] of switch B, neighbours, are at the supply and at ground. With any line that is cut, stuck or
//! shorted this pair is missing in its place, or is seen in another one. The switches share the lines, so it speaks for both.

use tenax_hal_shim::channel::{HIGH_SELECT, LOW_SELECT, MYO_SELECT, SLOW_HZ, SWITCH_INPUTS, sample_from_mv};

/// Least sample at the supply, and most at ground: beyond the limits of every sensor.
const HIGH: u16 = sample_from_mv(3_270);
const LOW: u16 = sample_from_mv(40);
const PLACE: usize = HIGH_SELECT as usize / 2;
const _: () =
    assert!(LOW_SELECT == HIGH_SELECT + 1 && HIGH_SELECT.is_multiple_of(2) && LOW_SELECT < SWITCH_INPUTS);

/// Right slow frames after which lost lines are believed again, 1 s.
const BACK_AFTER: u8 = SLOW_HZ as u8;

/// What is known of the pair.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Pair {
    /// It was seen nowhere yet: a board without it is not watched.
    #[default]
    Unknown,
    /// It is in its place, and nowhere else.
    Right,
    /// Not so in the last slow frame: a second one loses the lines.
    Doubted,
}

/// Watches the select lines.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SelectLines {
    pair: Pair,
    /// Right slow frames until the lines are believed; 0: they are.
    until_back: u8,
    /// What is hidden of a sample: nothing, or all of it. Each tick asks, so that this is a word.
    hidden: u16,
    /// The same of a myosensor's sample.
    hidden_muscle: u16,
}

impl SelectLines {
    /// Takes the last sample of each input of switch B, once a slow frame.
    #[inline(never)]
    pub fn look(&mut self, switch_b: &[u16; SWITCH_INPUTS as usize]) {
        let (pairs, _) = switch_b.as_chunks();
        let is_pair = |&[even, odd]: &[u16; 2]| even >= HIGH && odd <= LOW;
        let is_there = pairs.get(PLACE).is_some_and(is_pair);
        let right = is_there && pairs.iter().filter(|two| is_pair(two)).count() == 1;
        if right {
            self.pair = Pair::Right;
            self.until_back = self.until_back.saturating_sub(1);
        } else if self.pair == Pair::Right {
            self.pair = Pair::Doubted;
        } else if self.pair == Pair::Doubted {
            self.until_back = BACK_AFTER;
            // A line that is stuck high leaves the pair in its place and both myosensors on their inputs, or shows them the pair, which
            // is beyond their limits. Two broken neighbours look the same, and are no reason to be deaf to the wearer.
            self.hidden_muscle |= if is_there { 0 } else { u16::MAX };
        }
        self.hidden = if self.until_back == 0 { 0 } else { u16::MAX };
        self.hidden_muscle &= self.hidden;
    }

    /// A switched sample, or 0 while the lines are lost: no switched signal can be believed then, and 0 is a dead one's.
    #[inline]
    pub const fn believed(self, sample: u16) -> u16 {
        sample & !self.hidden
    }

    /// The same of a myosensor's sample.
    #[inline]
    pub const fn believed_muscle(self, sample: u16) -> u16 {
        sample & !self.hidden_muscle
    }
}

/// A line stuck high, but for the lowest, does not move the inputs of the myosensors, or moves them to the pair.
const _: () = assert!(MYO_SELECT.is_multiple_of(2) && HIGH_SELECT & MYO_SELECT == MYO_SELECT);
