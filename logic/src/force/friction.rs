//! Friction of the grasp, in one place: what is known of it bounds S2 (Prosthesis, sections 4 and 5), what shear foretells
//! ([`Ahead`](super::Ahead)), and what can slip at all.
//!
//! "In the 'before sliding' situation a significant increment of the Ft/Fn ratio has been observed"; it rises to mu_s and
//! falls as sliding starts. A stroke over a surface shows that peak, as often as the finger sticks and slides; S2 is set
//! below the smallest one seen.
//!
//! A grasp shows it, too: Ft is never above mu Fn, whether the object holds or slides, so that friction is no lower than the highest ratio
//! that has stood for a moment. S2 is set below that as below a stroke's, if it is higher, until the finger lets go or a muscle is active.
//! And nothing slips at a ratio below [`LEAST_PERMILLE`], whoever says so.

use crate::force::settings::FrictionConfig;

/// Part of S2 below which the warning ends, per mille: beyond the ratio's noise, and not so far that a load which falls
/// again is answered once more.
const OFF_PERMILLE: u32 = 960;
/// A ratio that has fallen below this part of its peak, per mille, has slid.
const FALL_PERMILLE: u32 = 850;
/// The least friction, per mille: nothing that a finger holds slips at a smaller ratio. A dry hand on metal has 0.1 or more, a wet one on
/// glass 0.15, and what slides keeps 0.6 of it.
pub const LEAST_PERMILLE: u16 = 70;

/// The smallest ratio that is taken for friction where one is measured or learned, per mille: noise at the touch is none.
pub const FOUND_PERMILLE: u16 = 100;
/// Readings for which a ratio has to be there, 50 ms.
const SHOWN_FOR: usize = 4;

/// A stroke in progress.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Stroke {
    highest: u16,
    mu_s: Option<u16>,
}

impl Stroke {
    fn add(&mut self, ratio: u16) {
        self.highest = self.highest.max(ratio);
        let slid = u32::from(ratio) * 1_000 < u32::from(self.highest) * FALL_PERMILLE;
        if slid {
            if self.highest >= FOUND_PERMILLE {
                self.mu_s = Some(self.mu_s.map_or(self.highest, |mu_s| mu_s.min(self.highest)));
            }
            self.highest = ratio;
        }
    }
}

/// What a stroke measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measured {
    /// The smallest peak of Ft/Fn, per mille.
    pub mu_s_permille: u16,
    /// S2 from it, per mille.
    pub s2_permille: u16,
}

/// What this grasp has shown of friction: no ratio is ever above it, whether the object holds or slides.
#[derive(Clone, Copy, Debug, Default)]
struct Shown {
    before: [u16; SHOWN_FOR - 1],
    highest: u16,
}

impl Shown {
    fn add(&mut self, ratio: u16) {
        let least = self.before.iter().fold(ratio, |least, &before| least.min(before));
        self.highest = self.highest.max(least);
        self.before.rotate_right(1);
        self.before[0] = ratio;
    }
}

/// The detector.
#[derive(Clone, Debug, Default)]
pub struct FrictionDetector {
    s2: bool,
    ratio_permille: Option<u16>,
    stroke: Option<Stroke>,
    shown: Shown,
}

impl FrictionDetector {
    /// Takes a ratio, None while there is none. Gives whether it warns.
    pub fn process(&mut self, config: &FrictionConfig, ratio_permille: Option<u16>) -> bool {
        self.ratio_permille = ratio_permille;
        let Some(ratio) = ratio_permille else {
            self.s2 = false;
            self.shown = Shown::default();
            return false;
        };
        self.shown.add(ratio);
        if let Some(stroke) = &mut self.stroke {
            stroke.add(ratio);
        }
        let threshold = u32::from(self.s2_permille(config)) * if self.s2 { OFF_PERMILLE } else { 1_000 };
        self.s2 = u32::from(ratio) * 1_000 > threshold;
        self.s2
    }

    /// S2 in this grasp: what was set or measured, or what the grasp has shown.
    #[must_use]
    pub fn s2_permille(&self, config: &FrictionConfig) -> u16 {
        let shown = u32::from(self.shown.highest) * u32::from(config.s2_of_mu_s_permille) / 1_000;
        config.s2_permille.max(shown as u16)
    }

    /// A muscle is active: what it does to the contact nobody knows.
    pub fn renew(&mut self) {
        self.shown = Shown::default();
    }

    /// The last ratio, None while there is none.
    #[must_use]
    pub const fn ratio_permille(&self) -> Option<u16> {
        self.ratio_permille
    }

    /// Begins a stroke.
    pub fn begin_stroke(&mut self) {
        self.stroke = Some(Stroke::default());
    }

    /// Ends it; gives what it measured, None if the finger never slid. The caller sets S2.
    pub fn end_stroke(&mut self, config: &FrictionConfig) -> Option<Measured> {
        let mu_s_permille = self.stroke.take()?.mu_s?;
        let s2 = u32::from(mu_s_permille) * u32::from(config.s2_of_mu_s_permille) / 1_000;
        Some(Measured { mu_s_permille, s2_permille: s2.min(u32::from(u16::MAX)) as u16 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONFIG: FrictionConfig =
        FrictionConfig { s2_permille: 300, s2_of_mu_s_permille: 800, loaded_mn: 600 };

    #[test]
    fn it_warns_above_s2_with_hysteresis_and_never_without_a_load() {
        let mut detector = FrictionDetector::default();
        let seen = [Some(300), Some(301), Some(289), Some(288), Some(289), None, Some(900), None]
            .map(|ratio| detector.process(&CONFIG, ratio));
        assert_eq!(seen, [false, true, true, false, false, false, true, false]);
    }

    #[test]
    fn a_ratio_that_stood_in_this_grasp_is_friction_until_the_finger_lets_go_or_a_muscle_moves_it() {
        let mut detector = FrictionDetector::default();
        let mut after = |ratios: &[Option<u16>]| {
            ratios.iter().for_each(|&ratio| _ = detector.process(&CONFIG, ratio));
            detector.s2_permille(&CONFIG)
        };
        assert_eq!(after(&[Some(600); SHOWN_FOR - 1]), 300, "a moment of noise");
        assert_eq!(after(&[Some(600)]), 480);
        assert_eq!(after(&[Some(500), Some(310), Some(200)]), 480, "what it carried once it carries");
        assert_eq!(after(&[None]), 300);
        after(&[Some(600); SHOWN_FOR]);
        detector.renew();
        assert_eq!(detector.s2_permille(&CONFIG), 300);
    }

    #[test]
    fn a_stroke_measures_the_smallest_peak() {
        // Figure 7b: up to 0.5, loss of contact, up to the same value again.
        let mut detector = FrictionDetector::default();
        detector.begin_stroke();
        for ratio in [20, 200, 400, 510, 350, 360, 440, 490, 300, 310] {
            detector.process(&CONFIG, Some(ratio));
        }
        assert_eq!(detector.end_stroke(&CONFIG), Some(Measured { mu_s_permille: 490, s2_permille: 392 }));
        assert_eq!(detector.end_stroke(&CONFIG), None);
    }

    #[test]
    fn a_stroke_that_never_slid_measures_nothing() {
        let mut detector = FrictionDetector::default();
        detector.begin_stroke();
        for ratio in [20, 200, 400, 410, 400, 50] {
            detector.process(&CONFIG, Some(ratio).filter(|&r| r > 100));
        }
        assert_eq!(detector.end_stroke(&CONFIG), None);
    }
}
