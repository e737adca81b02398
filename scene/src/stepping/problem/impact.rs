//! Something slips out of the fingers, which still rub on it, and falls on the table.

use super::Problem;
use crate::physics::GRAVITY_M_S2;
use crate::physics::friction::Friction;
use crate::stepping::{Body, Load, Method, run};

/// Falls, is thrown back by the table's undamped mat, and rises, under constant friction all the time.
///
/// Friction is less than the weight, so it never sticks, and depth and height follow from the energies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Of the mat, N/m: above about 250, else friction swallows all the energy and nothing rises.
    pub mat_n_per_m: f64,
}

const MASS_KG: f64 = 0.3;
const FRICTION: Friction = Friction { mu_s: 0.5, mu_d: 0.4 };
/// Of both fingers together, N.
const NORMAL_N: f64 = 2.5;
const HEIGHT_M: f64 = 0.005;
const SPEED_M_S: f64 = -0.5;

impl Default for Impact {
    fn default() -> Self {
        Self { mat_n_per_m: 2_000.0 }
    }
}

impl Impact {
    /// The mass that falls, kg.
    pub const MASS_KG: f64 = MASS_KG;

    /// How deep it goes into the mat, and how high it then rises, m.
    #[must_use]
    pub fn depth_and_height_m(&self) -> (f64, f64) {
        let friction_n = FRICTION.mu_d * NORMAL_N;
        let falling_n = MASS_KG * GRAVITY_M_S2 - friction_n;
        // Twice the kinetic energy at the mat, J.
        let vis_viva_j = MASS_KG * SPEED_M_S * SPEED_M_S + 2.0 * falling_n * HEIGHT_M;
        let depth_m =
            (falling_n + (falling_n * falling_n + self.mat_n_per_m * vis_viva_j).sqrt()) / self.mat_n_per_m;
        let left_j = vis_viva_j - 4.0 * friction_n * depth_m;
        (depth_m, left_j / (2.0 * (MASS_KG * GRAVITY_M_S2 + friction_n)))
    }
}

impl Body for Impact {
    fn mass_kg(&self) -> f64 {
        MASS_KG
    }

    fn friction(&self) -> Friction {
        FRICTION
    }

    fn start(&self) -> (f64, f64) {
        (HEIGHT_M, SPEED_M_S)
    }

    fn load(&self, _: f64, position_m: f64, _: f64) -> Load {
        let mat_n = self.mat_n_per_m * (-position_m).max(0.0);
        Load { force_n: mat_n - MASS_KG * GRAVITY_M_S2, normal_n: NORMAL_N, surface_m_s: 0.0 }
    }
}

impl Problem for Impact {
    fn name(&self) -> &'static str {
        "impact with the table"
    }

    /// Falling and rising, and a whole swing of the mat, which is longer than any half with a load on it.
    fn duration_s(&self) -> f64 {
        0.1 + std::f64::consts::TAU * (MASS_KG / self.mat_n_per_m).sqrt()
    }

    /// Depth and height.
    fn figures(&self, method: &dyn Method, dt_s: f64) -> Vec<f64> {
        let (depth_m, height_m) = self.depth_and_height_m();
        let (mut lowest_m, mut then_highest_m) = (f64::INFINITY, 0.0_f64);
        run(method, self, dt_s, self.steps(dt_s), |_, state| {
            if state.position_m < lowest_m {
                (lowest_m, then_highest_m) = (state.position_m, state.position_m);
            }
            then_highest_m = then_highest_m.max(state.position_m);
            state.position_m.is_finite()
        });
        vec![-lowest_m / depth_m, then_highest_m / height_m]
    }

    fn closed_form(&self) -> Option<Vec<f64>> {
        Some(vec![1.0, 1.0])
    }
}
