//! Consent to commands that move the hand or bear on its safety. Reading is always free.
//!
//! | consent | act at the hand | duration |
//! |---|---|---|
//! | [`Consent::Muscles`] | both muscles active for 2 s | 60 s |
//! | [`Consent::Button`] | the button pressed | 60 s |
//! | [`Consent::PowerUp`] | switched on with a finger that holds nothing | until it holds something, 10 s at most |
//!
//! Consent is an act, not a state: a humming electrode or a stuck button consents at most once.

use tenax_hal_shim::channel::{FRAME_HZ, frames};
use tenax_hal_shim::words::{Consent, Line};

pub const STEP_FRAMES: u32 = 5;
const CONSENT_STEPS: u32 = frames(60_000) / STEP_FRAMES;
const CO_CONTRACTION_STEPS: u32 = frames(2_000) / STEP_FRAMES;
/// Time for which the button must be up, then down, to count as pressed: longer than its contacts bounce.
pub const DEBOUNCE_FRAMES: u32 = frames(20);
pub const DEBOUNCE_STEPS: u32 = DEBOUNCE_FRAMES / STEP_FRAMES;
const POWER_UP_STEPS: u32 = frames(10_000) / STEP_FRAMES;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Signs {
    pub co_contraction: bool,
    pub button: bool,
    pub unloaded: Option<bool>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Act {
    on: u32,
    released: u32,
    done: bool,
}

impl Act {
    fn tick(&mut self, on: bool, long: u32) -> bool {
        if !on {
            self.on = 0;
            self.released = self.released.saturating_add(1);
            self.done &= self.released < DEBOUNCE_STEPS;
            return false;
        }
        // Stuck: on from the start, never seen to be off.
        self.done |= self.on == 0 && self.released < DEBOUNCE_STEPS;
        self.released = 0;
        self.on = self.on.saturating_add(1);
        let complete = !self.done && self.on >= long;
        self.done |= complete;
        complete
    }
}

#[derive(Clone, Debug)]
pub struct Arming {
    left: u32,
    power_up_left: u32,
    power_up: bool,
    muscles: Act,
    button: Act,
}

impl Default for Arming {
    fn default() -> Self {
        Self {
            left: 0,
            power_up_left: POWER_UP_STEPS,
            power_up: false,
            muscles: Act::default(),
            button: Act::default(),
        }
    }
}

impl Arming {
    pub const fn was_reset(&mut self) {
        self.power_up_left = 0;
    }

    pub fn tick(&mut self, signs: Signs) -> Option<Consent> {
        self.left = self.left.saturating_sub(1);
        self.power_up_left = match signs.unloaded {
            Some(false) => 0,
            _ => self.power_up_left.saturating_sub(1),
        };
        let began =
            core::mem::replace(&mut self.power_up, self.power_up_left > 0 && signs.unloaded == Some(true));
        let muscles = self.muscles.tick(signs.co_contraction, CO_CONTRACTION_STEPS);
        let button = self.button.tick(signs.button, DEBOUNCE_STEPS);
        if muscles || button {
            self.left = CONSENT_STEPS;
            return Some(if button { Consent::Button } else { Consent::Muscles });
        }
        (self.power_up && !began).then_some(Consent::PowerUp)
    }

    pub const fn is_deliberate(&self) -> bool {
        self.left > 0
    }

    pub fn line(&self, trusted: bool) -> Line {
        let left = if self.power_up { self.left.max(self.power_up_left) } else { self.left };
        match left.div_ceil(FRAME_HZ / STEP_FRAMES) {
            _ if trusted => Line::Trusted,
            0 => Line::Reading,
            left_s => Line::Armed { left_s: left_s as u8 },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOLDING: Signs = Signs { co_contraction: false, button: false, unloaded: Some(false) };
    const EMPTY: Signs = Signs { unloaded: Some(true), ..HOLDING };
    const BOTH: Signs = Signs { co_contraction: true, ..HOLDING };
    const PRESSED: Signs = Signs { button: true, ..HOLDING };

    fn run(arming: &mut Arming, signs: Signs, ms: u32) -> std::vec::Vec<Consent> {
        (0..frames(ms) / STEP_FRAMES).filter_map(|_| arming.tick(signs)).collect()
    }

    fn is_armed(arming: &Arming) -> bool {
        matches!(arming.line(false), Line::Armed { .. })
    }

    #[test]
    fn a_co_contraction_of_two_seconds_consents_once_for_a_minute() {
        let mut arming = Arming::default();
        assert_eq!(run(&mut arming, HOLDING, 100), []);
        assert_eq!(run(&mut arming, BOTH, 1_995), []);
        assert_eq!(run(&mut arming, BOTH, 100_000), [Consent::Muscles], "once, however long");
        assert!(!is_armed(&arming), "a muscle that hums for ever does not consent for ever");
        assert_eq!(run(&mut arming, HOLDING, 100), []);
        assert_eq!(run(&mut arming, BOTH, 2_000), [Consent::Muscles]);
        assert_eq!(arming.line(false), Line::Armed { left_s: 60 });
        assert_eq!(run(&mut arming, HOLDING, 59_995), []);
        assert_eq!(arming.line(false), Line::Armed { left_s: 1 });
        run(&mut arming, HOLDING, 5);
        assert_eq!(arming.line(false), Line::Reading);
    }

    #[test]
    fn a_press_of_the_button_consents_and_a_stuck_or_bouncing_one_does_not() {
        let mut arming = Arming::default();
        assert_eq!(run(&mut arming, PRESSED, 100_000), [], "stuck when it was switched on");
        run(&mut arming, HOLDING, 100);
        for _ in 0..50 {
            assert_eq!(run(&mut arming, PRESSED, 10), [], "it bounces");
            assert_eq!(run(&mut arming, HOLDING, 10), []);
        }
        run(&mut arming, HOLDING, 100);
        assert_eq!(run(&mut arming, PRESSED, 300), [Consent::Button]);
        assert!(is_armed(&arming) && arming.is_deliberate());
        run(&mut arming, HOLDING, 30_000);
        assert_eq!(run(&mut arming, PRESSED, 300), [Consent::Button], "renewed");
        run(&mut arming, HOLDING, 59_000);
        assert!(is_armed(&arming));
    }

    #[test]
    fn an_empty_hand_consents_for_ten_seconds_after_it_was_switched_on_and_not_after_a_reset() {
        let mut arming = Arming::default();
        assert_eq!(run(&mut arming, EMPTY, 9_995), [Consent::PowerUp]);
        assert!(is_armed(&arming) && !arming.is_deliberate());
        run(&mut arming, EMPTY, 5);
        assert!(!is_armed(&arming));

        let mut arming = Arming::default();
        run(&mut arming, EMPTY, 1_000);
        run(&mut arming, HOLDING, 5);
        assert!(!is_armed(&arming));
        assert_eq!(run(&mut arming, EMPTY, 5_000), [], "it has held something");

        let mut arming = Arming::default();
        arming.was_reset();
        assert_eq!(run(&mut arming, EMPTY, 20_000), []);
    }
}
