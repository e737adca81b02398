//! Shear that rises towards the ratio at which the camera saw slip.
//!
//! Ft/Fn rises for as long as an object is lifted or filled, whether it will be held or not, and falls to sliding friction when it
//! slips. The camera says when: the mean ratio of its lessons of slip is the friction of this finger on what it holds. From then on
//! a ratio that will have come close to it within the time that the setting looks ahead, as fast as it rises now, means slip.
//!
//! How far to look ahead is a choice (`docs/hebbian.md`): the films hear the first places let go; shear only foretells it, and
//! does so in every lift that would have held by a little.

/// The part of the learned ratio that is close, per mille.
const CLOSE_PERMILLE: i32 = 850;
/// The part of it below which it is no more.
const FAR_PERMILLE: i32 = 750;
/// Readings over which a rise is taken: 25 ms.
const SPAN: usize = 2;
/// Time from one reading to the next, us.
const READING_US: i32 = 12_500;
/// Readings in a row that have to agree.
const AGREEING: u8 = 2;
/// The learned ratio follows the lessons over `2^FOLLOWS` readings, 0.4 s.
const FOLLOWS: u32 = 5;
/// The smallest ratio that is taken for friction, per mille, as S2's stroke does.
const LEAST_PERMILLE: i32 = 100;
/// Fraction bits of the learned ratio.
const FRACTION: u32 = 8;

/// What was learned, and what is felt.
#[derive(Clone, Debug, Default)]
pub(super) struct Shear {
    /// Ft/Fn of slip, per mille with [`FRACTION`] bits; 0 before a lesson.
    slips_at: i32,
    /// The last ratios, the newest first.
    before: [Option<u16>; SPAN],
    agreeing: u8,
    says: bool,
}

impl Shear {
    /// Takes a new ratio, per mille, None while there is none, and how far to look ahead.
    #[inline(never)]
    pub(super) fn feel(&mut self, ahead_ms: u16, ratio_permille: Option<u16>) {
        let [newer, oldest] = self.before;
        self.before = [ratio_permille, newer];
        let Some(ratio) = ratio_permille.map(i32::from) else {
            self.agreeing = 0;
            self.says = false;
            return;
        };
        let risen = oldest.map_or(0, |oldest| (ratio - i32::from(oldest)).max(0));
        // A ratio is below 2^16 and the look ahead below 2^8 ms, so the product is below 2^31 in ms.
        let ahead = risen * i32::from(ahead_ms) / (SPAN as i32 * READING_US / 1_000);
        let limit = (self.slips_at >> FRACTION) * if self.says { FAR_PERMILLE } else { CLOSE_PERMILLE };
        let close = self.slips_at >> FRACTION >= LEAST_PERMILLE
            && i64::from(ratio + ahead) * 1_000 >= i64::from(limit);
        self.agreeing = if close { self.agreeing.saturating_add(1) } else { 0 };
        self.says = close && (self.says || self.agreeing >= AGREEING);
    }

    /// The camera says that it slips: the newest ratio is that of slip.
    pub(super) fn learn(&mut self) {
        if let [Some(ratio), _] = self.before {
            let ratio = i32::from(ratio) << FRACTION;
            let off = ratio - self.slips_at;
            self.slips_at = if self.slips_at == 0 { ratio } else { self.slips_at + (off >> FOLLOWS) };
        }
    }

    /// Whether slip is near.
    pub(super) const fn says(&self) -> bool {
        self.says
    }

    /// No reading of now.
    pub(super) fn lose(&mut self) {
        *self = Self { slips_at: self.slips_at, ..Self::default() };
    }

    /// Ft/Fn of slip, per mille with [`FRACTION`] bits; 0 before a lesson.
    pub(super) const fn learned(&self) -> u32 {
        self.slips_at.unsigned_abs()
    }

    /// Takes up what was learned; what no ratio can be is none.
    pub(super) fn restore(&mut self, learned: u32) {
        self.slips_at = if learned >> FRACTION <= u16::MAX as u32 { learned as i32 } else { 0 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One that has learned that it slips at this ratio.
    fn taught(permille: u16) -> Shear {
        let mut shear = Shear::default();
        shear.feel(0, Some(permille));
        shear.learn();
        shear.lose();
        shear
    }

    /// The reading at which it says slip, of a ratio that rises by so much a reading.
    fn says_at(mut shear: Shear, ahead_ms: u16, rise: u16) -> Option<u16> {
        (0..600 / rise).map(|n| n * rise).find(|&ratio| {
            shear.feel(ahead_ms, Some(ratio));
            shear.says()
        })
    }

    #[test]
    fn before_a_lesson_it_says_nothing() {
        assert_eq!(says_at(Shear::default(), 200, 10), None);
    }

    #[test]
    fn what_is_no_friction_is_not_believed() {
        assert_eq!(says_at(taught(LEAST_PERMILLE as u16 - 1), 50, 10), None);
        assert!(says_at(taught(LEAST_PERMILLE as u16), 50, 10).is_some());
    }

    #[test]
    fn it_looks_ahead_as_far_as_it_is_told() {
        // 10 in 12.5 ms: 50 ms ahead is 40 more; the second reading in a row that says so counts.
        assert_eq!(says_at(taught(500), 0, 10), Some(440));
        assert_eq!(says_at(taught(500), 50, 10), Some(400));
        assert_eq!(says_at(taught(500), 100, 10), Some(360));
    }

    #[test]
    fn a_load_that_is_held_is_no_slip() {
        let mut shear = taught(500);
        for n in 0..400_u16 {
            // Risen to two thirds of it, with the noise of a reading.
            shear.feel(50, Some((n * 10).min(330) + n % 3));
            assert!(!shear.says(), "{n}");
        }
    }

    #[test]
    fn the_learned_ratio_is_the_mean_of_the_lessons_and_survives() {
        let mut shear = Shear::default();
        for n in 0..400_u16 {
            shear.feel(0, Some(400 + (n % 5) * 10));
            shear.learn();
        }
        assert!((418..=422).contains(&(shear.learned() >> FRACTION)), "{}", shear.learned());
        let mut other = Shear::default();
        other.restore(shear.learned());
        assert_eq!(other.learned(), shear.learned());
        other.restore(u32::MAX);
        assert_eq!(other.learned(), 0);
    }
}
