//! A probe pulled over a surface by an arm's compliance: the problem of the map.

use super::Problem;
use crate::physics::friction::Friction;
use crate::stepping::{Body, Load, Method, run};

/// It is held, breaks loose, and then slides evenly, so that the speed in the bound of a sliding bristle is one number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stroke;

const MASS_KG: f64 = 0.2;
const ARM_N_PER_M: f64 = 1_000.0;
const ARM_DAMPING: f64 = 0.7;
const NORMAL_N: f64 = 2.0;
const FRICTION: Friction = Friction { mu_s: 0.5, mu_d: 0.4 };
/// The friction rig's.
const SPEED_M_S: f64 = 0.04;
const LOOKS: u64 = 25;
/// What the arm yields before the probe breaks loose.
const SIZE_M: f64 = 0.001;

impl Stroke {
    /// The mass, kg.
    pub const MASS_KG: f64 = MASS_KG;
    /// The speed at which it slides, m/s.
    pub const SPEED_M_S: f64 = SPEED_M_S;
    /// Friction while it slides, N.
    pub const SLIDING_N: f64 = FRICTION.mu_d * NORMAL_N;
    /// The longest step of the map, s: from one look to the next.
    pub const LONGEST_S: f64 = 0.1 / LOOKS as f64;
}

impl Body for Stroke {
    fn mass_kg(&self) -> f64 {
        MASS_KG
    }

    fn friction(&self) -> Friction {
        FRICTION
    }

    fn start(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn load(&self, t_s: f64, position_m: f64, speed_m_s: f64) -> Load {
        let damping_ns_per_m = 2.0 * ARM_DAMPING * (ARM_N_PER_M * MASS_KG).sqrt();
        let pull_n =
            ARM_N_PER_M * (SPEED_M_S * t_s - position_m) + damping_ns_per_m * (SPEED_M_S - speed_m_s);
        Load { force_n: pull_n, normal_n: NORMAL_N, surface_m_s: 0.0 }
    }
}

impl Problem for Stroke {
    fn name(&self) -> &'static str {
        "stroke"
    }

    fn duration_s(&self) -> f64 {
        LOOKS as f64 * Self::LONGEST_S
    }

    /// How far the probe has come, at each look.
    fn figures(&self, method: &dyn Method, dt_s: f64) -> Vec<f64> {
        let steps = self.steps(dt_s).next_multiple_of(LOOKS);
        let (mut n, mut figures) = (0, Vec::new());
        run(method, self, self.duration_s() / steps as f64, steps, |_, state| {
            n += 1;
            if n % (steps / LOOKS) == 0 {
                figures.push(state.position_m / SIZE_M);
            }
            true
        });
        figures
    }

    fn closed_form(&self) -> Option<Vec<f64>> {
        None
    }
}
