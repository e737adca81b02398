//! Decides when records are saved: without a command, and seldom enough for the flash.

use tenax_hal_shim::words::Kept;

use super::payload::ZeroBytes;
use tenax_hal_shim::channel::frames;

const CHANGED_FRAMES: u32 = frames(3_000);
const LEARNED_FRAMES: u32 = frames(60_000);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Now {
    pub settings_changed: u32,
    pub calibrated: u32,
    pub zero: ZeroBytes,
    pub updates: u32,
    pub at_rest: bool,
    pub asked: bool,
}

#[derive(Clone, Debug)]
pub struct Keeper {
    settings_changed: u32,
    calibrated: u32,
    zero: ZeroBytes,
    updates: u32,
    since: [u32; Kept::ALL.len()],
}

impl Keeper {
    pub const fn new(now: &Now) -> Self {
        Self {
            settings_changed: now.settings_changed,
            calibrated: now.calibrated,
            zero: now.zero,
            updates: now.updates,
            since: [u32::MAX; Kept::ALL.len()],
        }
    }

    pub fn pass(&mut self, frames: u32) {
        for since in &mut self.since {
            *since = since.saturating_add(frames);
        }
    }

    /// The returned record counts as saved from now on.
    pub fn next(&mut self, now: &Now) -> Option<Kept> {
        let since = |kept: Kept| self.since[kept as usize];
        let learned = now.updates != self.updates;
        let kept = if now.settings_changed != self.settings_changed && since(Kept::Settings) >= CHANGED_FRAMES
        {
            self.settings_changed = now.settings_changed;
            Kept::Settings
        } else if now.calibrated != self.calibrated {
            // A calibration takes 15 s: a pause of its own.
            self.calibrated = now.calibrated;
            Kept::Emg
        } else if now.zero != self.zero && since(Kept::Zero) >= CHANGED_FRAMES {
            self.zero = now.zero;
            Kept::Zero
        } else if now.asked || (learned && now.at_rest && since(Kept::Network) >= LEARNED_FRAMES) {
            self.updates = now.updates;
            Kept::Network
        } else {
            return None;
        };
        self.since[kept as usize] = 0;
        Some(kept)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn now(settings_changed: u32, zero: u8, updates: u32, at_rest: bool) -> Now {
        Now { settings_changed, calibrated: 0, zero: [zero; _], updates, at_rest, asked: false }
    }

    #[test]
    fn a_change_is_saved_at_once_and_a_flood_of_them_seldom() {
        let mut keeper = Keeper::new(&now(1, 1, 0, true));
        assert_eq!(keeper.next(&now(1, 1, 0, true)), None);
        assert_eq!(keeper.next(&now(2, 1, 0, false)), Some(Kept::Settings));
        assert_eq!(keeper.next(&now(2, 1, 0, false)), None);
        keeper.pass(CHANGED_FRAMES - 1);
        assert_eq!(keeper.next(&now(3, 1, 0, false)), None);
        assert_eq!(keeper.next(&now(3, 2, 0, false)), Some(Kept::Zero), "each has its own pause");
        keeper.pass(1);
        assert_eq!(keeper.next(&now(3, 2, 0, false)), Some(Kept::Settings), "nothing is forgotten meanwhile");
        assert_eq!(keeper.next(&now(3, 2, 0, false)), None);
    }

    #[test]
    fn what_is_learned_is_saved_once_a_minute_at_rest() {
        let mut keeper = Keeper::new(&now(1, 1, 0, true));
        assert_eq!(keeper.next(&now(1, 1, 9, false)), None, "something moves");
        assert_eq!(keeper.next(&now(1, 1, 9, true)), Some(Kept::Network));
        keeper.pass(LEARNED_FRAMES);
        assert_eq!(keeper.next(&now(1, 1, 9, true)), None, "nothing was learned since");
        assert_eq!(keeper.next(&now(1, 1, 10, true)), Some(Kept::Network));
        assert_eq!(keeper.next(&now(1, 1, 11, true)), None);
        let asked = Now { asked: true, ..now(1, 1, 11, false) };
        assert_eq!(keeper.next(&asked), Some(Kept::Network), "asked for");
        assert_eq!(keeper.next(&now(1, 1, 11, false)), None);
    }
}
