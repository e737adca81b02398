//! The select lines of the analogue switches: whether the switches show the inputs that the board asks for.
//!
//! Inputs [`HIGH_SELECT`] and [`LOW_SELECT`] of switch B, neighbours, are at the supply and at ground. With any line that is cut, stuck or
//! shorted this pair is missing in its place, or is seen in another one. The switches share the lines, so it speaks for both.

use tenax_hal_shim::channel::{HIGH_SELECT, LOW_SELECT, SLOW_HZ, SWITCH_INPUTS, sample_from_mv};

/// Least sample at the supply, and most at ground: beyond the limits of every sensor.
const HIGH: u16 = sample_from_mv(3_270);
const LOW: u16 = sample_from_mv(40);
const PLACE: usize = HIGH_SELECT as usize / 2;
const _: () =
    assert!(LOW_SELECT == HIGH_SELECT + 1 && HIGH_SELECT.is_multiple_of(2) && LOW_SELECT < SWITCH_INPUTS);

/// Right slow frames after which lost lines are believed again, 1 s.
const BACK_AFTER: u8 = SLOW_HZ as u8;

/// Where the pair was seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Pair {
    /// Nowhere yet: a board without it is not watched.
    #[default]
    Unknown,
    /// In its place, and nowhere else.
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
}

impl SelectLines {
    /// Takes the last sample of each input of switch B, once a slow frame.
    #[inline(never)]
    pub fn look(&mut self, switch_b: &[u16; SWITCH_INPUTS as usize]) {
        let (pairs, _) = switch_b.as_chunks();
        let is_right =
            |(place, &[even, odd]): (usize, &[u16; 2])| (even >= HIGH && odd <= LOW) == (place == PLACE);
        let right = pairs.iter().enumerate().all(is_right);
        (self.pair, self.until_back) = match (self.pair, right) {
            (_, true) => (Pair::Right, self.until_back.saturating_sub(1)),
            (Pair::Unknown, false) => return,
            (Pair::Right, false) => (Pair::Doubted, self.until_back),
            (Pair::Doubted, false) => (Pair::Doubted, BACK_AFTER),
        };
        self.hidden = if self.until_back == 0 { 0 } else { u16::MAX };
    }

    /// A switched sample, or 0 while the lines are lost: no switched signal can be believed then, and 0 is a dead one's.
    #[inline]
    pub const fn believed(self, sample: u16) -> u16 {
        sample & !self.hidden
    }
}
