//! L0: rigid Coulomb friction. Sticks while |Q| <= mu_s P, slides at mu_d P.
//!
//! The step is Moreau's: friction is the impulse that would stop the motion, limited to `mu P dt`. It is stable at any step, and it
//! sticks exactly: the speed is 0.0, so nothing creeps.

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
    use crate::schedule::STEP_S;

    #[test]
    fn a_block_on_an_incline_slides_from_tan_equal_mu_s_at_any_step() {
        let friction = Friction { mu_s: 0.5, mu_d: 0.4 };
        for (dt_s, off_rad) in [1e-6, STEP_S, 1e-2].into_iter().flat_map(|dt_s| [(dt_s, -1e-9), (dt_s, 1e-9)])
        {
            let (sin, cos) = (friction.mu_s.atan() + off_rad).sin_cos();
            let mut contact = RigidCoulomb::default();
            // Of 1 kg, under a gravity of 1 m/s^2.
            let outcome = contact.step(cos, friction, 1.0, sin * dt_s, dt_s);
            assert_eq!((outcome.onset, outcome.speed_m_s > 0.0), (off_rad > 0.0, off_rad > 0.0), "{dt_s} s");
        }
    }
}
