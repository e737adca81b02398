//! A block on a moving belt, held by a spring: it sticks, slips, sticks.

use super::Problem;
use crate::physics::friction::Friction;
use crate::stepping::{Body, Load, Method, run};

/// The undamped limit cycle, whose closed form is a straight line and an arc of a sine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StickSlip {
    /// Of the block, kg.
    pub mass_kg: f64,
    /// Of its spring, N/m.
    pub stiffness_n_per_m: f64,
    /// Of the belt, m/s.
    pub belt_m_s: f64,
    /// On the belt, N.
    pub normal_n: f64,
    /// Between block and belt.
    pub friction: Friction,
}

impl Default for StickSlip {
    fn default() -> Self {
        Self {
            mass_kg: 0.2,
            stiffness_n_per_m: 1_000.0,
            belt_m_s: 0.01,
            normal_n: 2.0,
            friction: Friction { mu_s: 0.5, mu_d: 0.4 },
        }
    }
}

impl StickSlip {
    fn omega_rad_s(&self) -> f64 {
        (self.stiffness_n_per_m / self.mass_kg).sqrt()
    }

    /// How far the spring is beyond its sliding balance when the block breaks loose, m.
    fn excess_m(&self) -> f64 {
        (self.friction.mu_s - self.friction.mu_d) * self.normal_n / self.stiffness_n_per_m
    }

    /// Half the way between the extremes, m: the arc starts at `excess_m` with the belt's speed.
    #[must_use]
    pub fn amplitude_m(&self) -> f64 {
        libm::hypot(self.excess_m(), self.belt_m_s / self.omega_rad_s())
    }

    /// From one break to the next, s: it sticks over twice `excess_m`, and slides the rest of the arc.
    #[must_use]
    pub fn period_s(&self) -> f64 {
        let omega_rad_s = self.omega_rad_s();
        let angle_rad = libm::atan2(self.excess_m() * omega_rad_s, self.belt_m_s);
        2.0 * self.excess_m() / self.belt_m_s + 2.0 * (std::f64::consts::PI - angle_rad) / omega_rad_s
    }

    fn balance_m(&self) -> f64 {
        self.friction.mu_d * self.normal_n / self.stiffness_n_per_m
    }
}

impl Body for StickSlip {
    fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    fn friction(&self) -> Friction {
        self.friction
    }

    fn start(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn load(&self, _: f64, position_m: f64, _: f64) -> Load {
        Load {
            force_n: -self.stiffness_n_per_m * position_m,
            normal_n: self.normal_n,
            surface_m_s: self.belt_m_s,
        }
    }
}

impl Problem for StickSlip {
    fn name(&self) -> &'static str {
        "stick-slip cycle"
    }

    fn duration_s(&self) -> f64 {
        2.0
    }

    /// Amplitude and period of the cycles in the second half.
    fn figures(&self, method: &dyn Method, dt_s: f64) -> Vec<f64> {
        let balance_m = self.balance_m();
        let (mut low_m, mut high_m) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut before_m, mut crossings) = (f64::NAN, Vec::new());
        run(method, self, dt_s, self.steps(dt_s), |t_s, state| {
            let at_m = state.position_m - balance_m;
            if t_s > self.duration_s() / 2.0 {
                (low_m, high_m) = (low_m.min(at_m), high_m.max(at_m));
                if before_m <= 0.0 && at_m > 0.0 {
                    crossings.push(t_s - dt_s * at_m / (at_m - before_m));
                }
            }
            before_m = at_m;
            at_m.is_finite()
        });
        let period_s = match (crossings.first(), crossings.last()) {
            (Some(first), Some(last)) if crossings.len() > 1 => (last - first) / (crossings.len() - 1) as f64,
            _ => f64::NAN,
        };
        vec![(high_m - low_m) / (2.0 * self.amplitude_m()), period_s / self.period_s()]
    }

    fn closed_form(&self) -> Option<Vec<f64>> {
        Some(vec![1.0, 1.0])
    }
}
