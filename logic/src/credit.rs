//! Whether a detector can be believed: not while it says slip of an empty hand.
//!
//! The array's network knows the noise that it was trained with. With more of it, from a bad supply or a motor's cable, it
//! takes noise for slip, and the reflex would answer with pulse after pulse up to the force ceiling: nothing that is held
//! ever stops it. What it says while the finger is known to touch nothing is certainly wrong, and costs it its credit.

use tenax_hal_shim::channel::SLOW_HZ;

use crate::array::SPECTRUM_WINDOW;
use crate::array::past::LAG_MAX;

/// Slow frames after which an empty hand's windows hold nothing any more of what was held or dropped before: the longest,
/// twice, for the verdict's own hold.
const EMPTY_AFTER: u16 = (2 * if SPECTRUM_WINDOW > LAG_MAX { SPECTRUM_WINDOW } else { LAG_MAX }) as u16;
/// Slow frames of silence in an empty hand that win the credit back: ten seconds.
const SILENT_FOR: u16 = 10 * SLOW_HZ as u16;

/// A detector's credit. It has some until it has lost it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Credit {
    empty: u16,
    silent: u16,
    lost: bool,
}

impl Credit {
    /// Takes a slow frame: whether the finger is known to touch nothing, and whether the detector says slip all the same.
    pub fn take(&mut self, unloaded: bool, slip: bool) {
        self.empty = if unloaded { self.empty.saturating_add(1) } else { 0 };
        if self.empty <= EMPTY_AFTER {
            return;
        }
        self.silent = if slip { 0 } else { self.silent.saturating_add(1) };
        self.lost = slip || (self.lost && self.silent < SILENT_FOR);
    }

    /// Whether it is not to be believed.
    #[must_use]
    pub const fn is_lost(&self) -> bool {
        self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(credit: &mut Credit, frames: u16, unloaded: bool, slip: bool) -> bool {
        (0..frames).for_each(|_| credit.take(unloaded, slip));
        credit.is_lost()
    }

    #[test]
    fn slip_of_an_empty_hand_costs_it_and_silence_there_wins_it_back() {
        let mut credit = Credit::default();
        assert!(!after(&mut credit, 1_000, false, true), "something is held");
        assert!(!after(&mut credit, EMPTY_AFTER, true, true), "something was held");
        assert!(after(&mut credit, 1, true, true));
        assert!(after(&mut credit, 10_000, false, false), "silence in a grasp proves nothing");
        assert!(after(&mut credit, EMPTY_AFTER + SILENT_FOR - 1, true, false));
        assert!(after(&mut credit, 1, true, true), "it has spoken again");
        assert!(after(&mut credit, SILENT_FOR - 1, true, false));
        assert!(!after(&mut credit, 1, true, false));
    }
}
