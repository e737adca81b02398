//! S2: incipient slip from Ft/Fn, and the stroke that measures it (Prosthesis, sections 4 and 5).
//!
//! "In the 'before sliding' situation a significant increment of the Ft/Fn ratio has been observed"; it rises to mu_s and
//! falls as sliding starts. A stroke over a surface shows that peak, as often as the finger sticks and slides; S2 is set
//! below the smallest one seen.

use crate::force::settings::FrictionConfig;

/// Part of S2 below which the warning ends, per mille: beyond the ratio's noise, and not so far that a load which falls
/// again is answered once more.
const OFF_PERMILLE: u32 = 960;
/// A ratio that has fallen below this part of its peak, per mille, has slid.
const FALL_PERMILLE: u32 = 850;
/// The smallest ratio that is taken for a peak, per mille: noise at the touch is not friction.
const PEAK_MIN_PERMILLE: u16 = 100;

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
            if self.highest >= PEAK_MIN_PERMILLE {
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

/// The detector.
#[derive(Clone, Debug, Default)]
pub struct FrictionDetector {
    s2: bool,
    ratio_permille: Option<u16>,
    stroke: Option<Stroke>,
}

impl FrictionDetector {
    /// Takes a ratio, None while there is none. Gives whether it warns.
    pub fn process(&mut self, config: &FrictionConfig, ratio_permille: Option<u16>) -> bool {
        self.ratio_permille = ratio_permille;
        let Some(ratio) = ratio_permille else {
            self.s2 = false;
            return false;
        };
        if let Some(stroke) = &mut self.stroke {
            stroke.add(ratio);
        }
        let threshold = u32::from(config.s2_permille) * if self.s2 { OFF_PERMILLE } else { 1_000 };
        self.s2 = u32::from(ratio) * 1_000 > threshold;
        self.s2
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
