//! Detectors that are ignored: one that reports slip while the finger touches nothing, and the array's
//! verdicts that begin as the hand tightens on a warning of S2 or an impact rings ([`Disturbance`]).
//!
//! A detector that meets more noise than it was made for reports slip without end, and the reflex would close
//! up to the force ceiling. Closing and impacts move load between the array's elements as sliding does.

use tenax_hal_shim::channel::SLOW_HZ;

use crate::array::SPECTRUM_WINDOW;
use crate::array::past::LAG_MAX;
use crate::array::structure::LAGS;

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

/// Slow frames after a disturbance in which no verdict of the array that begins is believed.
const MOVED_FOR: u8 = LAGS[LAGS.len() - 1] as u8;

#[derive(Clone, Copy, Debug, Default)]
pub struct Disturbance {
    /// Slow frames since the array was disturbed, up to [`MOVED_FOR`].
    still: u8,
    says: bool,
    began_still: bool,
}

impl Disturbance {
    pub const fn begin(&mut self) {
        self.still = 0;
    }

    pub fn step(&mut self, disturbed: bool, says: bool) {
        self.still = if disturbed { 0 } else { self.still.saturating_add(1).min(MOVED_FOR) };
        self.says = says;
        self.began_still = says && (self.began_still || self.still >= MOVED_FOR);
    }

    pub const fn explains_it(&self) -> bool {
        self.says && !self.began_still
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

    #[test]
    fn what_begins_as_it_is_disturbed_is_the_disturbance_and_what_stood_before_is_not() {
        let mut disturbance = Disturbance::default();
        (0..MOVED_FOR).for_each(|_| disturbance.step(false, false));
        disturbance.step(false, true);
        assert!(!disturbance.explains_it());
        disturbance.step(true, true);
        assert!(!disturbance.explains_it(), "it stood before");
        disturbance.step(true, false);
        disturbance.step(true, true);
        assert!(disturbance.explains_it(), "it began anew");
        for _ in 1..MOVED_FOR {
            disturbance.step(false, true);
            assert!(disturbance.explains_it());
        }
        disturbance.step(false, true);
        assert!(!disturbance.explains_it(), "it has outlasted what it looks back on");
    }
}
