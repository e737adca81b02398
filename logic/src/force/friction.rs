//! Friction of the grasp: bounds S2 (Prosthesis, sections 4 and 5) and the look-ahead, and sizes the pulses.
//!
//! Ft/Fn rises to mu_s and falls as sliding starts. A stroke over a surface shows that peak; S2 is set below
//! the smallest one. A grasp shows it too: friction is at least the highest ratio that has lasted for 50 ms,
//! until the finger lets go or a muscle is active.

use tenax_hal_shim::detector::{DetectorHealth, DetectorId, Direction};
use tenax_hal_shim::wire::Forces;

use crate::detectors::{Description, Detector, Said, Sensed, confidence};
use crate::force::settings::FrictionConfig;
use crate::grip::slide::Carried;
use crate::latest;

/// Part of S2 below which the warning ends, per mille: beyond the ratio's noise, yet near enough that a load
/// which falls again is not answered twice.
const OFF_PERMILLE: u32 = 960;
/// Part of its peak below which a ratio has slid, per mille.
const FALL_PERMILLE: u32 = 850;
/// Least friction, per mille. A dry hand on metal has 0.1 or more, a wet one on glass 0.15, and what slides
/// keeps 0.6 of it.
pub const LEAST_PERMILLE: u16 = 70;
/// Least ratio that counts as friction where one is measured or learned, per mille: less is noise at the
/// touch.
pub const FOUND_PERMILLE: u16 = 100;
/// Readings for which a ratio has to last, 50 ms.
const SHOWN_FOR: usize = 4;

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

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measured {
    /// Smallest of the stroke's peaks of Ft/Fn, per mille.
    pub mu_s_permille: u16,
    pub s2_permille: u16,
}

#[derive(Clone, Copy, Debug, Default)]
struct Shown {
    before: [u16; SHOWN_FOR - 1],
    highest: u16,
}

impl Shown {
    fn add(&mut self, ratio: u16) {
        let least = self.before.iter().fold(ratio, |least, &before| least.min(before));
        self.highest = self.highest.max(least);
        latest::push(&mut self.before, ratio);
    }
}

/// Missing normal force of a warning, mN. None if unknown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lacks {
    pub warning_mn: Option<i32>,
    pub by_s2: bool,
}

/// Grip that a pulse aims at after a warning, as a part of what friction needs, per mille.
const WARNED_PERMILLE: i32 = 1_080;
/// Readings over which a growing load is extrapolated: 100 ms.
const CARRIED_FOR: usize = 8;

#[derive(Clone, Debug, Default)]
pub struct FrictionDetector {
    s2: bool,
    ratio_permille: Option<u16>,
    stroke: Option<Stroke>,
    shown: Shown,
    /// Ft of the last 100 ms in which the hand stood still, mN, the newest first. A sliding object carries
    /// less than its load.
    carried: Option<[i32; CARRIED_FOR]>,
    /// Readings since the hand moved.
    still: u8,
}

impl FrictionDetector {
    /// `moves`: the reflex moves the hand. Call it before [`process`](Self::process).
    #[inline(never)]
    pub fn carry(&mut self, ft_mn: Option<i32>, moves: bool) {
        let Some(ft_mn) = ft_mn else {
            self.carried = None;
            return;
        };
        let carried = self.carried.get_or_insert([ft_mn; CARRIED_FOR]);
        self.still = if moves { 0 } else { self.still.saturating_add(1) };
        if self.still > 1 {
            latest::push(carried, ft_mn);
        }
    }

    /// Load before a slide. None while there is no ratio.
    pub fn carried(&self) -> Option<Carried> {
        let carried = self.carried.as_ref()?;
        let [.., oldest_mn] = *carried;
        let ft_mn = carried.iter().fold(0, |most, &ft_mn| most.max(ft_mn));
        Some(Carried { ft_mn, grown_mn: (ft_mn - oldest_mn).max(0) })
    }

    /// aim x Ft / friction - Fn, mN, for a warning.
    #[must_use]
    #[inline(never)]
    pub fn lacks(&self, config: &FrictionConfig, forces: &Forces) -> Lacks {
        let (Some(ratio), Some([.., oldest_mn])) = (forces.ratio_permille, self.carried) else {
            return Lacks::default();
        };
        let friction = i32::from(ratio.max(LEAST_PERMILLE)).min(self.s2_permille(config).max(1).into());
        let grows_mn = (forces.ft_mn - oldest_mn).max(0);
        // Forces are below 2^17 mN, so that a product is below 2^31.
        let needed_mn = (forces.ft_mn + grows_mn).min(1 << 17) * WARNED_PERMILLE / friction;
        Lacks { warning_mn: Some(needed_mn - forces.fn_mn), by_s2: self.s2 }
    }

    /// Ft/Fn, per mille, None while there is none. True: S2 warns.
    pub fn process(&mut self, config: &FrictionConfig, ratio_permille: Option<u16>) -> bool {
        self.ratio_permille = ratio_permille;
        let Some(ratio) = ratio_permille else {
            self.s2 = false;
            self.renew();
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

    /// S2 in this grasp, per mille: as set or measured, or higher if the grasp has shown more friction.
    pub fn s2_permille(&self, config: &FrictionConfig) -> u16 {
        let shown = u32::from(self.shown.highest) * u32::from(config.s2_of_mu_s_permille) / 1_000;
        config.s2_permille.max(shown as u16)
    }

    /// A muscle changes the contact: the friction of this grasp is unknown again.
    pub fn renew(&mut self) {
        self.shown = Shown::default();
    }

    pub const fn ratio_permille(&self) -> Option<u16> {
        self.ratio_permille
    }

    pub fn begin_stroke(&mut self) {
        self.stroke = Some(Stroke::default());
    }

    /// None if the finger never slid. The caller sets S2.
    pub fn end_stroke(&mut self, config: &FrictionConfig) -> Option<Measured> {
        let mu_s_permille = self.stroke.take()?.mu_s?;
        let s2 = u32::from(mu_s_permille) * u32::from(config.s2_of_mu_s_permille) / 1_000;
        Some(Measured { mu_s_permille, s2_permille: s2.min(u32::from(u16::MAX)) as u16 })
    }
}

impl Detector for FrictionDetector {
    const ID: DetectorId = DetectorId::S2;
    type Config = FrictionConfig;

    fn step(&mut self, config: &FrictionConfig, sensed: &Sensed<'_>) -> Option<Said> {
        if sensed.wearer {
            self.renew();
        }
        let ratio = match sensed.forces {
            Some(_) if !sensed.forces_are_new => return None,
            Some(forces) => forces.ratio_permille,
            None => None,
        };
        self.carry(ratio.and(sensed.forces).map(|forces| forces.ft_mn), sensed.moves && !sensed.wearer);
        Some(Said { slip: false, incipient: self.process(config, ratio) })
    }

    fn describe(&self, config: &FrictionConfig) -> Description {
        let ratio = self.ratio_permille().map_or(0, i32::from);
        Description {
            confidence_permille: confidence(ratio, config.s2_permille.into()),
            direction: Direction::Unknown,
            health: match self.ratio_permille() {
                Some(_) => DetectorHealth::Working,
                None => DetectorHealth::Blind,
            },
            raw: ratio,
        }
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

    fn lacks(load_mn: i32, shears_mn: &[i32]) -> Lacks {
        let mut detector = FrictionDetector::default();
        let mut lacks = Lacks::default();
        for &ft_mn in shears_mn {
            let ratio_permille = Some((ft_mn * 1_000 / load_mn) as u16);
            detector.carry(Some(ft_mn), false);
            detector.process(&CONFIG, ratio_permille);
            let forces = Forces { fn_mn: load_mn, fx_mn: ft_mn, fy_mn: 0, ft_mn, load_mn, ratio_permille };
            lacks = detector.lacks(&CONFIG, &forces);
        }
        lacks
    }

    #[test]
    fn a_warning_lacks_what_brings_the_ratio_below_s2_by_its_margin() {
        let held = lacks(10_000, &[3_100; 20]);
        assert!(held.by_s2);
        assert_eq!(held.warning_mn, Some(3_100 * WARNED_PERMILLE / 300 - 10_000));
        let grows: [i32; 20] = core::array::from_fn(|n| 2_600 + n as i32 * 200 / 7);
        let expected = (grows[19] + grows[19] - grows[12]) * WARNED_PERMILLE / 300 - 10_000;
        assert!((expected - 10..=expected + 10).contains(&lacks(10_000, &grows).warning_mn.unwrap()));
        assert!(!lacks(10_000, &[1_000; 20]).by_s2);
    }

    #[test]
    fn a_hand_that_moves_shows_no_load() {
        let mut detector = FrictionDetector::default();
        detector.carry(Some(2_000), false);
        (0..20).for_each(|_| detector.carry(Some(4_000), true));
        detector.carry(Some(4_000), false);
        assert_eq!(detector.carried, Some([2_000; CARRIED_FOR]));
        detector.carry(None, false);
        assert_eq!(detector.carried, None);
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
    fn a_ratio_has_slid_below_its_part_of_the_peak_and_not_at_it() {
        for (peak, ratio, measured) in
            [(400, 340, None), (400, 339, Some(400)), (99, 50, None), (100, 50, Some(100))]
        {
            let mut detector = FrictionDetector::default();
            detector.begin_stroke();
            [peak, ratio].iter().for_each(|&ratio| _ = detector.process(&CONFIG, Some(ratio)));
            assert_eq!(detector.ratio_permille(), Some(ratio));
            assert_eq!(detector.end_stroke(&CONFIG).map(|measured| measured.mu_s_permille), measured);
        }
    }
}
