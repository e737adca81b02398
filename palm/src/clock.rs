//! A finger's clock, brought to the palm's by the stamps of its polls.

/// Polls of which each counts a sixteenth: 32 ms, in which two crystals part by 3 us at 100 ppm.
const PART: i32 = 16;
/// A stamp further off than this is a mistake, or another palm's, us.
const JUMP_US: u32 = 1_000;
/// So many of them in a row are another palm's.
const JUMPS: u8 = 3;

/// What the palm's clock shows more than the finger's own. Both wrap in 71 minutes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Clock {
    offset_us: Option<u32>,
    /// Parts of a microsecond, 1/256.
    rest: i32,
    jumps: u8,
}

impl Clock {
    /// A poll that began at `palm_us` by the palm began at `own_us` here. False if that cannot be: then who says so is not believed.
    pub fn follow(&mut self, palm_us: u32, own_us: u32) -> bool {
        let now_us = palm_us.wrapping_sub(own_us);
        let Some(offset_us) = self.offset_us else {
            self.offset_us = Some(now_us);
            return false;
        };
        let ahead_us = now_us.wrapping_sub(offset_us).cast_signed();
        if ahead_us.unsigned_abs() > JUMP_US {
            self.jumps += 1;
            if self.jumps >= JUMPS {
                *self = Self { offset_us: Some(now_us), rest: 0, jumps: 0 };
            }
            return false;
        }
        self.jumps = 0;
        self.rest += ahead_us * 256 / PART;
        self.offset_us = Some(offset_us.wrapping_add_signed(self.rest >> 8));
        self.rest &= 255;
        true
    }

    /// The palm's time at an instant of the own one. None before the first poll.
    #[must_use]
    pub fn palm_us(&self, own_us: u32) -> Option<u32> {
        Some(own_us.wrapping_add(self.offset_us?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crystal_that_runs_away_is_followed_across_the_wrap_and_one_wrong_stamp_is_not() {
        let mut clock = Clock::default();
        let mut worst_us = 0;
        for n in 0..100_000u32 {
            let palm_us = 0xFFFF_0000u32.wrapping_add(n * 2_000);
            // 100 ppm slow, and heard 0 to 30 us late.
            let own_us = (n * 2_000 - n / 5).wrapping_add(7);
            let late_us = n * 7_919 % 31;
            let stamp_us = if n % 1_000 == 999 { palm_us ^ 0x10_0000 } else { palm_us };
            clock.follow(stamp_us, own_us.wrapping_add(late_us));
            let error_us = clock.palm_us(own_us).unwrap().wrapping_sub(palm_us).cast_signed();
            worst_us = worst_us.max(error_us.abs());
        }
        assert!(worst_us <= 35, "{worst_us} us");
    }

    #[test]
    fn another_palm_is_followed_after_three_polls() {
        let mut clock = Clock::default();
        clock.follow(0, 0);
        (0..2).for_each(|_| assert!(!clock.follow(50_000, 0)));
        assert_eq!(clock.palm_us(0), Some(0));
        clock.follow(50_000, 0);
        assert_eq!(clock.palm_us(0), Some(50_000));
    }
}
