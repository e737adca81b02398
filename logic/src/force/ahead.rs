//! Look-ahead: warns while Ft/Fn, extrapolated by `hebbian-ahead-ms`, comes close to the ratio at which the
//! camera saw slip. The mean ratio in lessons of slip is the friction of this finger on its object. A ratio
//! learned on a slippery object would warn of a rough one without end, so the warnings of one grasp add
//! limited force ([`Asked`]).

use tenax_hal_shim::wire::Forces;

use super::Asked;
use super::friction::FOUND_PERMILLE;

/// Part of the learned ratio from which it warns, per mille.
const CLOSE_PERMILLE: i32 = 850;
/// Part of the learned ratio below which the warning ends, per mille.
const FAR_PERMILLE: i32 = 750;
/// Readings over which a rise is taken: 25 ms.
const SPAN: usize = 2;
const READING_US: i32 = 12_500;
const AGREEING: u8 = 2;
/// The learned ratio follows the lessons over `2^FOLLOWS` readings, 0.4 s.
const FOLLOWS: u32 = 5;
const FRACTION: u32 = 8;

#[derive(Clone, Debug, Default)]
pub struct Ahead {
    /// Ft/Fn of slip, per mille with [`FRACTION`] bits; 0 before a lesson.
    slips_at: i32,
    before: [Option<u16>; SPAN],
    agreeing: u8,
    says: bool,
    asked: Asked,
}

impl Ahead {
    /// `ahead_ms`: time to extrapolate; 0: no warnings. `forces`: None if unknown.
    #[inline(never)]
    pub fn feel(&mut self, ahead_ms: u16, forces: Option<&Forces>) {
        let [newer, oldest] = self.before;
        let ratio_permille = forces.and_then(|forces| forces.ratio_permille);
        self.before = [ratio_permille, newer];
        let (Some(forces), Some(ratio_permille)) = (forces, ratio_permille.filter(|_| ahead_ms > 0)) else {
            self.agreeing = 0;
            self.says = false;
            return;
        };
        let ratio = i32::from(ratio_permille);
        let risen = oldest.map_or(0, |oldest| (ratio - i32::from(oldest)).max(0));
        // A ratio is below 2^16 and the look ahead below 2^8 ms, so the product is below 2^31 in ms.
        let ahead = risen * i32::from(ahead_ms) / (SPAN as i32 * READING_US / 1_000);
        let limit = (self.slips_at >> FRACTION) * if self.says { FAR_PERMILLE } else { CLOSE_PERMILLE };
        let close = self.slips_at >> FRACTION >= i32::from(FOUND_PERMILLE)
            && i64::from(ratio + ahead) * 1_000 >= i64::from(limit)
            && !self.asked.in_vain(forces, 0);
        self.agreeing = if close { self.agreeing.saturating_add(1) } else { 0 };
        self.says = close && (self.says || self.agreeing >= AGREEING);
        if self.says {
            self.asked.begin(forces);
        }
    }

    pub const fn renew(&mut self) {
        self.asked.renew();
    }

    pub fn learn(&mut self) {
        if let [Some(ratio), _] = self.before {
            let ratio = i32::from(ratio) << FRACTION;
            let off = ratio - self.slips_at;
            self.slips_at = if self.slips_at == 0 { ratio } else { self.slips_at + (off >> FOLLOWS) };
            self.renew();
        }
    }

    pub const fn warns(&self) -> bool {
        self.says
    }

    /// A lost reading; the grasp is the same.
    pub fn lose(&mut self) {
        *self = Self { slips_at: self.slips_at, asked: self.asked, ..Self::default() };
    }

    /// Ft/Fn of slip, per mille with [`FRACTION`] bits; 0 before a lesson.
    pub const fn learned(&self) -> u32 {
        self.slips_at.unsigned_abs()
    }

    pub fn restore(&mut self, learned: u32) {
        self.slips_at = if learned >> FRACTION <= u16::MAX as u32 { learned as i32 } else { 0 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A reading under this load.
    const fn reading(ratio_permille: u16, load_mn: i32) -> Forces {
        Forces { fn_mn: load_mn, fx_mn: 0, fy_mn: 0, ft_mn: 0, load_mn, ratio_permille: Some(ratio_permille) }
    }

    /// One that has learned that it slips at this ratio.
    fn taught(permille: u16) -> Ahead {
        let mut shear = Ahead::default();
        shear.feel(0, Some(&reading(permille, 2_000)));
        shear.learn();
        shear.lose();
        shear
    }

    /// The reading at which it warns, of a ratio that rises by so much a reading.
    fn warns_at(mut shear: Ahead, ahead_ms: u16, rise: u16) -> Option<u16> {
        (0..600 / rise).map(|n| n * rise).find(|&ratio| {
            shear.feel(ahead_ms, Some(&reading(ratio, 2_000)));
            shear.warns()
        })
    }

    #[test]
    fn what_is_no_friction_is_not_believed() {
        assert_eq!(warns_at(taught(FOUND_PERMILLE - 1), 50, 10), None);
        assert!(warns_at(taught(FOUND_PERMILLE), 50, 10).is_some());
    }

    #[test]
    fn it_looks_ahead_as_far_as_it_is_told() {
        // 10 in 12.5 ms: 50 ms ahead is 40 more; the second reading in a row that says so counts.
        assert_eq!(warns_at(taught(500), 1, 10), Some(440));
        assert_eq!(warns_at(taught(500), 50, 10), Some(400));
        assert_eq!(warns_at(taught(500), 100, 10), Some(360));
    }

    #[test]
    fn not_looking_ahead_is_no_warning_and_learns_all_the_same() {
        let mut shear = taught(500);
        assert_eq!(warns_at(shear.clone(), 0, 10), None);
        assert_eq!(shear.learned() >> FRACTION, 500);
        for _ in 0..2 {
            shear.feel(1, Some(&reading(600, 2_000)));
        }
        assert!(shear.warns());
        shear.feel(0, Some(&reading(600, 2_000)));
        assert!(!shear.warns());
    }

    #[test]
    fn the_learned_ratio_is_the_mean_of_the_lessons_and_survives() {
        let mut shear = Ahead::default();
        for n in 0..400_u16 {
            shear.feel(0, Some(&reading(400 + (n % 5) * 10, 2_000)));
            shear.learn();
        }
        assert!((418..=422).contains(&(shear.learned() >> FRACTION)), "{}", shear.learned());
        let mut other = Ahead::default();
        other.restore(shear.learned());
        assert_eq!(other.learned(), shear.learned());
        other.restore(u32::MAX);
        assert_eq!(other.learned(), 0);
    }

    #[test]
    fn a_lost_reading_warns_of_nothing_and_what_was_before_it_is_no_rise() {
        let mut shear = taught(500);
        (0..AGREEING).for_each(|_| shear.feel(50, Some(&reading(450, 2_000))));
        assert!(shear.warns());
        shear.lose();
        assert!(!shear.warns());
        let mut shear = taught(500);
        (0..AGREEING).for_each(|_| shear.feel(200, Some(&reading(0, 2_000))));
        shear.lose();
        (0..AGREEING).for_each(|_| shear.feel(200, Some(&reading(300, 2_000))));
        assert!(!shear.warns());
    }
}
