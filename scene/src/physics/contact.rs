//! L0: rigid Coulomb friction. Sticks while |Q| <= mu_s P, slides at mu_d P.
//!
//! The step is Moreau's: friction is the impulse that would stop the motion, limited to `mu P dt`. It is stable at any
//! step, and it sticks exactly: the speed is 0.0, not a small number, so nothing creeps however long it is held.

use super::friction::Friction;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidCoulomb {
    sticks: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    pub speed_m_s: f64,
    pub force_n: f64,
    pub onset: bool,
}

impl Default for RigidCoulomb {
    fn default() -> Self {
        Self { sticks: true }
    }
}

impl RigidCoulomb {
    pub const fn sticks(&self) -> bool {
        self.sticks
    }

    /// Goes on by `dt_s`. `free_m_s` is the speed that a body of `mass_kg` would have after the step without friction;
    /// `normal_n` is the sum over all pads.
    pub fn step(
        &mut self,
        normal_n: f64,
        friction: Friction,
        mass_kg: f64,
        free_m_s: f64,
        dt_s: f64,
    ) -> Outcome {
        let stopping_ns = -mass_kg * free_m_s;
        let mu = if self.sticks { friction.mu_s } else { friction.mu_d };
        let limit_ns = mu * normal_n.max(0.0) * dt_s;
        if stopping_ns.abs() <= limit_ns {
            self.sticks = true;
            return Outcome { speed_m_s: 0.0, force_n: stopping_ns / dt_s, onset: false };
        }
        let onset = std::mem::replace(&mut self.sticks, false);
        let sliding_ns = (friction.mu_d * normal_n.max(0.0) * dt_s).copysign(stopping_ns);
        Outcome { speed_m_s: free_m_s + sliding_ns / mass_kg, force_n: sliding_ns / dt_s, onset }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::GRAVITY_M_S2;
    use crate::schedule::STEP_S;
    use proptest::prelude::*;

    const FRICTION: Friction = Friction { mu_s: 0.5, mu_d: 0.4 };
    const MASS_KG: f64 = 0.3;

    fn incline(contact: &mut RigidCoulomb, speed_m_s: f64, angle_rad: f64, dt_s: f64) -> Outcome {
        let (sin, cos) = angle_rad.sin_cos();
        let free_m_s = speed_m_s + GRAVITY_M_S2 * sin * dt_s;
        contact.step(MASS_KG * GRAVITY_M_S2 * cos, FRICTION, MASS_KG, free_m_s, dt_s)
    }

    #[test]
    fn a_block_on_an_incline_slides_from_tan_equal_mu_s() {
        let critical_rad = FRICTION.mu_s.atan();
        for dt_s in [1e-6, STEP_S, 1e-2] {
            let below = incline(&mut RigidCoulomb::default(), 0.0, critical_rad - 1e-9, dt_s);
            assert_eq!((below.speed_m_s, below.onset), (0.0, false));
            let above = incline(&mut RigidCoulomb::default(), 0.0, critical_rad + 1e-9, dt_s);
            assert!(above.onset && above.speed_m_s > 0.0);
        }
    }

    #[test]
    fn then_it_accelerates_at_g_sin_minus_mu_d_cos() {
        let angle_rad: f64 = 0.6;
        let mut contact = RigidCoulomb::default();
        let mut speed_m_s = 0.0;
        for _ in 0..8_000 {
            speed_m_s = incline(&mut contact, speed_m_s, angle_rad, STEP_S).speed_m_s;
        }
        let closed_form = GRAVITY_M_S2 * (angle_rad.sin() - FRICTION.mu_d * angle_rad.cos());
        assert!((speed_m_s - closed_form).abs() < 1e-9, "{speed_m_s} for {closed_form} m/s after 1 s");
    }

    #[test]
    fn it_stops_where_the_closed_form_stops_it() {
        let mut contact = RigidCoulomb { sticks: false };
        let (mut speed_m_s, mut way_m) = (0.5, 0.0);
        while speed_m_s != 0.0 {
            speed_m_s = incline(&mut contact, speed_m_s, 0.0, STEP_S).speed_m_s;
            way_m += speed_m_s * STEP_S;
        }
        let closed_form = 0.5 * 0.5 / (2.0 * FRICTION.mu_d * GRAVITY_M_S2);
        // The step's own error: half a step at the first speed.
        assert!((way_m - closed_form).abs() <= 0.5 * STEP_S, "{way_m} for {closed_form} m");
        assert!(contact.sticks());
    }

    #[test]
    fn an_hour_of_sticking_moves_it_by_nothing_at_all() {
        let mut contact = RigidCoulomb::default();
        let (mut speed_m_s, mut way_m) = (0.0, 0.0);
        // 1 h in steps of 1 ms, on a slope at 99 % of the critical angle, shaken sideways within the cone.
        for n in 0..3_600_000_u32 {
            let shake = if n % 2 == 0 { 1e-6 } else { -1e-6 };
            speed_m_s = incline(&mut contact, speed_m_s, 0.99 * FRICTION.mu_s.atan() + shake, 1e-3).speed_m_s;
            way_m += speed_m_s * 1e-3;
        }
        assert_eq!(way_m, 0.0);
    }

    proptest! {
        #[test]
        fn friction_never_adds_energy_nor_turns_the_motion_round(
            sticks: bool, normal_n in -10.0..150.0, mu_d in 0.01..1.5, excess in 0.0..0.5,
            mass_kg in 0.001..5.0, free_m_s in -3.0..3.0, dt_s in 1e-6..1e-1,
        ) {
            let friction = Friction { mu_s: mu_d + excess, mu_d };
            let after = RigidCoulomb { sticks }.step(normal_n, friction, mass_kg, free_m_s, dt_s);
            prop_assert!(after.speed_m_s.abs() <= free_m_s.abs());
            prop_assert!(after.speed_m_s * free_m_s >= 0.0);
            prop_assert!(after.force_n.abs() <= friction.mu_s * normal_n.max(0.0) * (1.0 + 1e-12));
        }
    }
}
