//! The palm's own serial line, to a PC: its fingers' lines pass through it, and it says what happens on the bus.
//!
//! Its frames are those of a fingertip's line, with these messages in them. What comes down a finger's line is a finger's to believe.

use heapless::{Deque, Vec};
use serde::{Deserialize, Serialize};
use tenax_hal_shim::wire::{Receiver, encode};

use crate::bus::{FINGERS_MAX, bytes};
use crate::palm::{Palm, Report};
use crate::places::Places;

/// Its rate, baud, 8N1: 50 MHz over 25. Five fingers that say all they can fill a line of the fingertip's rate.
pub const BAUD: u32 = 2_000_000;
/// Bytes of a finger's line in one message up, and down.
pub const PIECE_UP: usize = 200;
/// See [`PIECE_UP`].
pub const PIECE_DOWN: usize = 64;
/// The longest frame up, bytes.
pub const FRAME_UP_MAX: usize = 240;
/// Bytes of a finger's line that wait on their way up.
const WAITS_MAX: usize = 1_024;

/// From the palm to the PC.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Up {
    /// Bytes that came up a finger's line.
    Line {
        /// Its address, from 1 on.
        finger: u8,
        /// In order, whatever the fingertip's frames are.
        #[serde(with = "bytes")]
        bytes: Vec<u8, PIECE_UP>,
    },
    /// What happened on the bus.
    Bus(Report),
    /// The fingers of this hand: the answer to [`Down::Ask`] and [`Down::Keep`].
    Hand(Places),
    /// They are not kept: a finger holds something, or the flash failed.
    Refused,
}

/// From the PC to the palm.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Down {
    /// Bytes for a finger's line.
    Line {
        /// Its address, from 1 on.
        finger: u8,
        /// In order.
        #[serde(with = "bytes")]
        bytes: Vec<u8, PIECE_DOWN>,
    },
    /// Which fingers this hand has.
    Ask,
    /// Which it has from now on. Whatever is held is not let go of, but what the palm knows of it begins anew.
    Keep(Places),
}

/// What is answered next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Which fingers this hand has.
    Hand,
    /// That others are not kept.
    Refused,
}

/// What waits on the palm's line.
#[derive(Debug, Default)]
pub struct Lines {
    down: Receiver,
    up: [Deque<u8, WAITS_MAX>; FINGERS_MAX],
    /// Whose turn it is.
    next: usize,
    answer: Option<Answer>,
    number: u16,
}

impl Lines {
    /// A finger has answered a poll: its line goes up. What finds no room is lost, as it is where a line is slow.
    pub fn answered(&mut self, palm: &Palm, finger: usize) {
        let Some((line, state)) = self.up.get_mut(finger).zip(palm.state(finger)) else { return };
        state.line.iter().all(|&byte| line.push_back(byte).is_ok());
    }

    /// A byte comes down. Some if it ends the wish for another hand, which whoever has the flash carries out.
    pub fn hear(&mut self, byte: u8, palm: &mut Palm) -> Option<Places> {
        match self.down.push::<Down>(byte)?.ok()?.message {
            Down::Line { finger, bytes } => {
                let finger = usize::from(finger).wrapping_sub(1);
                bytes.iter().all(|&byte| palm.line_byte(finger, byte));
            }
            Down::Ask => self.answer(Answer::Hand),
            Down::Keep(_) if palm.holds() => self.answer(Answer::Refused),
            Down::Keep(places) => return Some(places),
        }
        None
    }

    /// This is said next.
    pub const fn answer(&mut self, answer: Answer) {
        self.answer = Some(answer);
    }

    /// How many bytes of `out` go up next, if any. Call it while nothing is on its way.
    pub fn next(&mut self, palm: &mut Palm, out: &mut [u8; FRAME_UP_MAX]) -> usize {
        let answer = self.answer.take().map(|answer| match answer {
            Answer::Hand => Up::Hand(palm.places()),
            Answer::Refused => Up::Refused,
        });
        let message = answer.or_else(|| palm.next_report().map(Up::Bus)).or_else(|| self.piece());
        let Some(message) = message else { return 0 };
        self.number = self.number.wrapping_add(1);
        encode(self.number, &message, out).map_or(0, |frame| frame.len())
    }

    /// What waits of the next finger that has something. The more waits, the more goes at once.
    fn piece(&mut self) -> Option<Up> {
        let turns = (0..FINGERS_MAX).map(|turn| (self.next + turn) % FINGERS_MAX);
        let finger = turns.into_iter().find(|&n| self.up.get(n).is_some_and(|line| !line.is_empty()))?;
        self.next = finger + 1;
        let line = self.up.get_mut(finger)?;
        let mut bytes = Vec::new();
        while !bytes.is_full()
            && let Some(byte) = line.pop_front()
        {
            let _fits = bytes.push(byte);
        }
        Some(Up::Line { finger: finger as u8 + 1, bytes })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::places::Place;

    #[test]
    fn every_message_up_fits_and_fingers_take_turns() {
        let place = Place { chip: [u32::MAX; 3], normal: [i16::MIN; 2], ceiling_mn: i32::MIN };
        let places: Places = (0..FINGERS_MAX).map(|_| place).collect();
        let (mut lines, mut palm) = (Lines::default(), Palm::new(&places, 0));
        let mut out = [0; FRAME_UP_MAX];
        for line in &mut lines.up[1..3] {
            (0..PIECE_UP + 10).for_each(|_| line.push_back(7).unwrap());
        }
        lines.answer(Answer::Hand);
        let mut receiver = Receiver::new();
        let mut heard = std::vec::Vec::new();
        loop {
            let length = lines.next(&mut palm, &mut out);
            if length == 0 {
                break;
            }
            heard.extend(
                out[..length]
                    .iter()
                    .filter_map(|&byte| receiver.push::<Up>(byte))
                    .map(|up| up.unwrap().message),
            );
        }
        let pieces: std::vec::Vec<(u8, usize)> = heard
            .iter()
            .filter_map(
                |up| if let Up::Line { finger, bytes } = up { Some((*finger, bytes.len())) } else { None },
            )
            .collect();
        assert_eq!(heard[0], Up::Hand(places));
        assert_eq!(pieces, [(2, PIECE_UP), (3, PIECE_UP), (2, 10), (3, 10)]);
    }
}
