//! The button at the hand, for a wearer without a PC. Any press consents as well ([`arming`](crate::arming)).
//!
//! | the finger | pressed | the hand |
//! |---|---|---|
//! | holds something, or may | for 1 to 3 s, and let go | [`Press::Release`]: opens slowly |
//! | holds nothing | for 3 s | [`Press::Calibrate`]: asks for rest, closing and opening |
//! | opens after a release, or is calibrating | again | [`Press::Stop`] |
//!
//! A release waits for the button to be let go: a stuck or shorted button opens nothing.

use tenax_hal_shim::channel::frames;

use crate::arming::{DEBOUNCE_STEPS, STEP_FRAMES};

const RELEASE_STEPS: u32 = frames(1_000) / STEP_FRAMES;
const CALIBRATE_STEPS: u32 = frames(3_000) / STEP_FRAMES;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Press {
    Release,
    Calibrate,
    Stop,
}

#[derive(Clone, Copy, Debug, Default)]
pub struct Button {
    down: u32,
    up: u32,
    fresh: bool,
    held: bool,
}

impl Button {
    pub fn tick(&mut self, is_down: bool, empty: bool, busy: bool) -> Option<Press> {
        if !is_down {
            self.up = self.up.saturating_add(1);
            if self.up < DEBOUNCE_STEPS {
                return None;
            }
            let down = core::mem::take(&mut self.down);
            let long = (RELEASE_STEPS..CALIBRATE_STEPS).contains(&down);
            let asks = self.fresh && self.held && long && self.up == DEBOUNCE_STEPS;
            self.fresh = true;
            return asks.then_some(Press::Release);
        }
        if self.down == 0 {
            self.fresh &= self.up >= DEBOUNCE_STEPS;
            self.held = !empty;
        }
        self.up = 0;
        self.down = self.down.saturating_add(1);
        let press = match self.down {
            DEBOUNCE_STEPS if busy => Press::Stop,
            CALIBRATE_STEPS if !self.held && empty => Press::Calibrate,
            _ => return None,
        };
        core::mem::take(&mut self.fresh).then_some(press)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    fn press(ms: u32, empty: bool, busy: bool) -> Vec<Press> {
        let mut button = Button::default();
        let steps = |ms: u32| frames(ms) / STEP_FRAMES;
        let mut all = Vec::new();
        for (is_down, ms) in [(false, 100), (true, ms), (false, 100)] {
            all.extend((0..steps(ms)).filter_map(|_| button.tick(is_down, empty, busy)));
        }
        all
    }

    #[test]
    fn each_press_asks_once_for_what_its_length_says() {
        for (ms, empty, busy, asks) in [
            (200, false, false, None),
            (1_100, false, false, Some(Press::Release)),
            (2_900, false, false, Some(Press::Release)),
            (3_100, false, false, None),
            (60_000, false, false, None),
            (1_100, true, false, None),
            (3_100, true, false, Some(Press::Calibrate)),
            (60_000, true, false, Some(Press::Calibrate)),
            (200, false, true, Some(Press::Stop)),
            (1_100, false, true, Some(Press::Stop)),
            (5, false, true, None),
            (200, true, true, Some(Press::Stop)),
        ] {
            assert_eq!(press(ms, empty, busy), Vec::from_iter(asks), "{ms} ms, {empty}, {busy}");
        }
    }
}
