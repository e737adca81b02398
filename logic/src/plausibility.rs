//! Detectors that are ignored: those that report slip while the finger touches nothing.
//!
//! A detector that meets more noise than it was made for reports slip without end, and the reflex would close
//! up to the force ceiling.

use tenax_hal_shim::channel::SLOW_HZ;

use crate::array::SPECTRUM_WINDOW;
use crate::array::past::LAG_MAX;

/// Slow frames after which an empty hand's windows hold nothing of an object: the longest, twice, for the
/// verdict's own hold.
const EMPTY_AFTER: u16 = (2 * if SPECTRUM_WINDOW > LAG_MAX { SPECTRUM_WINDOW } else { LAG_MAX }) as u16;
/// Slow frames of silence in an empty hand after which the detector is believed again: ten seconds.
const SILENT_FOR: u16 = 10 * SLOW_HZ as u16;

#[derive(Clone, Copy, Debug, Default)]
pub struct Plausibility {
    empty: u16,
    silent: u16,
    ignored: bool,
}

impl Plausibility {
    /// One slow frame.
    pub fn step(&mut self, unloaded: bool, says: bool) {
        self.empty = if unloaded { self.empty.saturating_add(1) } else { 0 };
        if self.empty <= EMPTY_AFTER {
            return;
        }
        self.silent = if says { 0 } else { self.silent.saturating_add(1) };
        self.ignored = says || (self.ignored && self.silent < SILENT_FOR);
    }

    pub const fn is_ignored(&self) -> bool {
        self.ignored
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(guard: &mut Plausibility, frames: u16, unloaded: bool, says: bool) -> bool {
        (0..frames).for_each(|_| guard.step(unloaded, says));
        guard.is_ignored()
    }

    #[test]
    fn slip_of_an_empty_hand_is_implausible_and_silence_there_mends_it() {
        let mut guard = Plausibility::default();
        assert!(!after(&mut guard, 1_000, false, true), "something is held");
        assert!(!after(&mut guard, EMPTY_AFTER, true, true), "something was held");
        assert!(after(&mut guard, 1, true, true));
        assert!(after(&mut guard, 10_000, false, false), "silence in a grasp proves nothing");
        assert!(after(&mut guard, EMPTY_AFTER + SILENT_FOR - 1, true, false));
        assert!(after(&mut guard, 1, true, true), "it has spoken again");
        assert!(after(&mut guard, SILENT_FOR - 1, true, false));
        assert!(!after(&mut guard, 1, true, false));
    }
}
