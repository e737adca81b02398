//! A block on an incline.

use super::Problem;
use crate::physics::GRAVITY_M_S2;
use crate::physics::friction::Friction;
use crate::stepping::{Body, Load, Method, run};

/// Slides from `tan = mu_s` on, then accelerates at `g (sin - mu_d cos)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incline {
    /// Of the block, kg.
    pub mass_kg: f64,
    /// Between block and incline.
    pub friction: Friction,
    /// Tangent of the angle.
    pub tan: f64,
}

impl Default for Incline {
    fn default() -> Self {
        Self { mass_kg: 0.3, friction: Friction { mu_s: 0.5, mu_d: 0.4 }, tan: 0.6 }
    }
}

impl Incline {
    /// `g (sin - mu_d cos)`, m/s^2.
    #[must_use]
    pub fn acceleration_m_s2(&self) -> f64 {
        GRAVITY_M_S2 * (self.tan - self.friction.mu_d) / (1.0 + self.tan * self.tan).sqrt()
    }

    /// The tangent at which the block gets away (1 mm/s) while the incline is tilted slowly, 0.1 a second.
    #[must_use]
    pub fn onset_tan(&self, method: &dyn Method, dt_s: f64) -> f64 {
        let mut onset = 0.0;
        let steps = (2.0 * self.friction.mu_s / TILT_PER_S / dt_s).ceil() as u64;
        run(method, &Tilting(*self), dt_s, steps, |t_s, state| {
            onset = t_s * TILT_PER_S;
            state.speed_m_s < 1e-3
        });
        onset
    }

    fn load_at(&self, tan: f64) -> Load {
        let normal_n = self.mass_kg * GRAVITY_M_S2 / (1.0 + tan * tan).sqrt();
        Load { force_n: normal_n * tan, normal_n, surface_m_s: 0.0 }
    }
}

const TILT_PER_S: f64 = 0.1;

/// The incline while it is tilted from level.
struct Tilting(Incline);

impl Body for Tilting {
    fn mass_kg(&self) -> f64 {
        self.0.mass_kg
    }

    fn friction(&self) -> Friction {
        self.0.friction
    }

    fn start(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn load(&self, t_s: f64, _: f64, _: f64) -> Load {
        self.0.load_at(TILT_PER_S * t_s)
    }
}

impl Body for Incline {
    fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    fn friction(&self) -> Friction {
        self.friction
    }

    fn start(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn load(&self, _: f64, _: f64, _: f64) -> Load {
        self.load_at(self.tan)
    }
}

impl Problem for Incline {
    fn name(&self) -> &'static str {
        "incline"
    }

    fn duration_s(&self) -> f64 {
        1.0
    }

    /// Speed in the end, and way.
    fn figures(&self, method: &dyn Method, dt_s: f64) -> Vec<f64> {
        let mut figures = vec![0.0; 2];
        run(method, self, dt_s, self.steps(dt_s), |t_s, state| {
            let speed_m_s = self.acceleration_m_s2() * t_s;
            figures = vec![state.speed_m_s / speed_m_s, state.position_m / (0.5 * speed_m_s * t_s)];
            true
        });
        figures
    }

    fn closed_form(&self) -> Option<Vec<f64>> {
        Some(vec![1.0, 1.0])
    }
}
