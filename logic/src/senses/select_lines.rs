//! Watch of the analogue switches' select lines: the supply at [`HIGH_SELECT`] and ground at [`LOW_SELECT`] are
//! seen in another place if a line is cut, stuck or shorted.

use tenax_hal_shim::channel::{HIGH_SELECT, LOW_SELECT, MYO_SELECT, SLOW_HZ, SWITCH_INPUTS, sample_from_mv};

const HIGH: u16 = sample_from_mv(3_270);
const LOW: u16 = sample_from_mv(40);
const PLACE: usize = HIGH_SELECT as usize / 2;
const _: () =
    assert!(LOW_SELECT == HIGH_SELECT + 1 && HIGH_SELECT.is_multiple_of(2) && LOW_SELECT < SWITCH_INPUTS);

const BACK_AFTER: u8 = SLOW_HZ as u8;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Pair {
    /// Seen nowhere yet: a board without the pair is not watched.
    #[default]
    Unknown,
    Right,
    /// Not in its place in the last slow frame: a second one loses the lines.
    Doubted,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SelectLines {
    pair: Pair,
    until_back: u8,
    hidden: u16,
    hidden_muscle: u16,
}

impl SelectLines {
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

    /// 0, a dead sensor's sample, while the lines are lost.
    #[inline]
    pub const fn believed(self, sample: u16) -> u16 {
        sample & !self.hidden
    }

    #[inline]
    pub const fn believed_muscle(self, sample: u16) -> u16 {
        sample & !self.hidden_muscle
    }
}

const _: () = assert!(MYO_SELECT.is_multiple_of(2) && HIGH_SELECT & MYO_SELECT == MYO_SELECT);
