//! Equations 1 and 2 of Dubey 2006: an object between two fingers slips if `M a > F (mu_f + mu_s)`.
//!
//! F is the force of one finger, and both press with it; a is gravity and inertia together, as a vector's length.

/// What the object needs and what friction can give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrictionCheck {
    /// M a, mN.
    pub load_mn: i32,
    /// F (mu_f + mu_s), mN.
    pub limit_mn: i32,
}

impl FrictionCheck {
    /// Of an object of `mass_g` grams under `acceleration_mm_s2`, held with `force_mn`; friction of finger and sensor, per mille.
    #[must_use]
    pub fn of(
        mass_g: u32,
        acceleration_mm_s2: u32,
        force_mn: i32,
        mu_finger_permille: u16,
        mu_sensor_permille: u16,
    ) -> Self {
        let load_un = u64::from(mass_g) * u64::from(acceleration_mm_s2);
        let mu = i64::from(mu_finger_permille) + i64::from(mu_sensor_permille);
        let narrow = |mn: i64| mn.clamp(0, i64::from(i32::MAX)) as i32;
        Self {
            load_mn: narrow((load_un / 1_000) as i64),
            limit_mn: narrow(i64::from(force_mn.max(0)) * mu / 1_000),
        }
    }

    /// Equation 1.
    #[must_use]
    pub const fn slips(&self) -> bool {
        self.load_mn > self.limit_mn
    }

    /// What friction could carry more, mN; negative if it slips.
    #[must_use]
    pub const fn margin_mn(&self) -> i32 {
        self.limit_mn - self.load_mn
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_blocks_slip_just_where_equation_1_says() {
        // 105 g of aluminium between silicone rubber (0.8) and the strip (0.35): 1.03 N over 1.15.
        let held = |force_mn| FrictionCheck::of(105, 9_807, force_mn, 800, 350);
        assert_eq!(held(0).load_mn, 1_029);
        assert!(held(894).slips() && !held(896).slips());
        assert_eq!(held(1_000).margin_mn(), 1_150 - 1_029);
        // Equation 2 has equality on the safe side.
        let even = FrictionCheck { load_mn: 5, limit_mn: 5 };
        assert!(!even.slips() && even.margin_mn() == 0);
    }

    #[test]
    fn nothing_overflows() {
        let most = FrictionCheck::of(u32::MAX, u32::MAX, i32::MAX, u16::MAX, u16::MAX);
        assert_eq!((most.load_mn, most.limit_mn), (i32::MAX, i32::MAX));
        assert_eq!(FrictionCheck::of(1, 1, i32::MIN, 500, 500).limit_mn, 0);
    }
}
