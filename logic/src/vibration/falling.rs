//! Falling shear: what begins to slide under a steady normal force carries less than it did.
//!
//! Static friction is higher than sliding friction, and what gets wet loses more. A light object or a slow slide is heard far below S1; a
//! shear that falls at the same time tells its sound from noise. A shear that falls to less than a third is none that slides: the object
//! stands on something, or is taken.

use tenax_hal_shim::wire::Forces;

use crate::latest;

/// Readings that are compared with the newest, 37.5 ms.
const SPAN: usize = 3;
/// A shear has fallen if it is below this part of one before, per mille: mu_d is 0.6 to 0.95 of mu_s.
const FALLEN_PERMILLE: i32 = 850;
/// A smaller fall is noise, mN.
const NOISE_MN: i32 = 20;
/// A shear below this part of one before is no longer that of a sliding object: 1/3.
const GONE_PART: i32 = 3;
/// The normal force is steady if it differs from that before by less than this part of it: 1/20.
const STEADY_PART: i32 = 20;
/// Readings for which a fall counts, 50 ms.
const COUNTS_FOR: u8 = 4;

/// The last readings, and how long the shear counts as falling.
#[derive(Clone, Copy, Debug, Default)]
pub struct Falling {
    /// Fn and Ft, mN, the newest first.
    before: [[i32; 2]; SPAN],
    left: u8,
}

impl Falling {
    /// Takes a reading. None: the force is unknown, or nothing is held.
    #[inline(never)]
    pub fn feel(&mut self, forces: Option<&Forces>) {
        let Some(forces) = forces.filter(|forces| forces.ratio_permille.is_some()) else {
            *self = Self::default();
            return;
        };
        let (fn_mn, ft_mn) = (forces.fn_mn, forces.ft_mn);
        // Forces are below 2^17 mN, the products below 2^27.
        let falls = self.before.iter().any(|&[before_mn, most_mn]| {
            most_mn - ft_mn > NOISE_MN
                && ft_mn * 1_000 < most_mn * FALLEN_PERMILLE
                && ft_mn * GONE_PART > most_mn
                && (fn_mn - before_mn).abs() * STEADY_PART < before_mn
        });
        latest::push(&mut self.before, [fn_mn, ft_mn]);
        self.left = if falls { COUNTS_FOR } else { self.left.saturating_sub(1) };
    }

    /// Whether the shear falls, or has just fallen.
    #[must_use]
    pub const fn is_on(&self) -> bool {
        self.left > 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn reading(fn_mn: i32, ft_mn: i32) -> Forces {
        Forces { fn_mn, fx_mn: ft_mn, fy_mn: 0, ft_mn, load_mn: fn_mn, ratio_permille: Some(0) }
    }

    /// Whether it falls after these readings of Fn and Ft, mN.
    fn falls(readings: &[[i32; 2]]) -> bool {
        let mut falling = Falling::default();
        readings.iter().for_each(|&[fn_mn, ft_mn]| falling.feel(Some(&reading(fn_mn, ft_mn))));
        falling.is_on()
    }

    #[test]
    fn a_shear_that_falls_under_a_steady_force_slides() {
        assert!(falls(&[[1_500, 434], [1_516, 359]]));
        assert!(falls(&[[1_500, 434], [1_500, 410], [1_500, 390], [1_500, 360]]), "within three readings");
        assert!(!falls(&[[1_500, 434], [1_500, 420], [1_500, 400], [1_500, 385], [1_500, 360]]), "slowly");
        assert!(!falls(&[[1_500, 434], [1_500, 434]]));
        assert!(!falls(&[[1_500, 300], [1_500, 434]]), "it grows");
    }

    #[test]
    fn its_limits_are_15_percent_20_mn_a_third_and_a_twentieth() {
        assert_eq!(
            [851, 850, 849].map(|ft_mn| falls(&[[4_000, 1_000], [4_000, ft_mn]])),
            [false, false, true]
        );
        assert_eq!([20, 19].map(|ft_mn| falls(&[[1_000, 40], [1_000, ft_mn]])), [false, true]);
        assert_eq!([334, 333].map(|ft_mn| falls(&[[4_000, 1_000], [4_000, ft_mn]])), [true, false]);
        assert_eq!([3_801, 3_800].map(|fn_mn| falls(&[[4_000, 1_000], [fn_mn, 700]])), [true, false]);
        assert_eq!([4_199, 4_200].map(|fn_mn| falls(&[[4_000, 1_000], [fn_mn, 700]])), [true, false]);
    }

    #[test]
    fn it_counts_for_four_readings_and_not_without_a_ratio() {
        let mut falling = Falling::default();
        falling.feel(Some(&reading(1_500, 434)));
        // Each reading less than 15 % below one before, once the first has gone.
        let lasted = (0..9).map(|_| {
            falling.feel(Some(&reading(1_500, 350)));
            falling.is_on()
        });
        assert_eq!(lasted.filter(|&is_on| is_on).count(), SPAN + usize::from(COUNTS_FOR) - 1);
        for none in [None, Some(&Forces { ratio_permille: None, ..reading(1_500, 300) })] {
            falling.feel(Some(&reading(1_500, 434)));
            falling.feel(Some(&reading(1_500, 350)));
            assert!(falling.is_on());
            falling.feel(none);
            assert!(!falling.is_on());
            falling.feel(Some(&reading(1_500, 200)));
            assert!(!falling.is_on(), "another grasp");
        }
    }
}
