//! One second of picking something up too gently, and catching it.

use super::Problem;
use crate::physics::GRAVITY_M_S2;
use crate::physics::friction::Friction;
use crate::stepping::{Body, Load, Method, run};

/// An object on the table's mat. The hand rises around it with too weak a grip, slides along it, then squeezes: the
/// object is caught up and lifted. How far it slid is what the scenes are about.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PickUp;

const MASS_KG: f64 = 0.2;
const FRICTION: Friction = Friction { mu_s: 0.5, mu_d: 0.4 };
const MAT_N_PER_M: f64 = 2_000.0;
const MAT_DAMPING: f64 = 0.7;
const LIFT_M: f64 = 0.05;
const LIFT_AT_S: f64 = 0.1;
const LIFT_FOR_S: f64 = 0.7;
/// Of both fingers together, N: before the squeeze, and after.
const GRIP_N: (f64, f64) = (3.0, 9.0);
const SQUEEZE_AT_S: f64 = 0.35;
const SQUEEZE_FOR_S: f64 = 0.1;
/// The slide is compared so often.
const LOOKS: u64 = 20;
/// Its natural size, m: about what it slides in all.
const SIZE_M: f64 = 0.01;

fn progress(t_s: f64, at_s: f64, for_s: f64) -> f64 {
    ((t_s - at_s) / for_s).clamp(0.0, 1.0)
}

impl Body for PickUp {
    fn mass_kg(&self) -> f64 {
        MASS_KG
    }

    fn friction(&self) -> Friction {
        FRICTION
    }

    fn start(&self) -> (f64, f64) {
        (-MASS_KG * GRAVITY_M_S2 / MAT_N_PER_M, 0.0)
    }

    fn load(&self, t_s: f64, position_m: f64, speed_m_s: f64) -> Load {
        let mat_ns_per_m = 2.0 * MAT_DAMPING * (MAT_N_PER_M * MASS_KG).sqrt();
        let mat_n = if position_m < 0.0 {
            (-MAT_N_PER_M * position_m - mat_ns_per_m * speed_m_s).max(0.0)
        } else {
            0.0
        };
        let squeeze = progress(t_s, SQUEEZE_AT_S, SQUEEZE_FOR_S);
        let lift = progress(t_s, LIFT_AT_S, LIFT_FOR_S);
        // The speed of a minimum-jerk reach (Flash and Hogan 1985).
        let reach = 30.0 * lift * lift * (1.0 - lift) * (1.0 - lift);
        Load {
            force_n: mat_n - MASS_KG * GRAVITY_M_S2,
            normal_n: GRIP_N.0 + (GRIP_N.1 - GRIP_N.0) * squeeze,
            surface_m_s: LIFT_M / LIFT_FOR_S * reach,
        }
    }
}

impl Problem for PickUp {
    fn name(&self) -> &'static str {
        "1 s pick-up"
    }

    fn duration_s(&self) -> f64 {
        1.0
    }

    /// How far it has slid, 20 times.
    fn figures(&self, method: &dyn Method, dt_s: f64) -> Vec<f64> {
        let steps = self.steps(dt_s).next_multiple_of(LOOKS);
        let (mut n, mut figures) = (0, Vec::new());
        run(method, self, self.duration_s() / steps as f64, steps, |_, state| {
            n += 1;
            if n % (steps / LOOKS) == 0 {
                figures.push(state.slid_m / SIZE_M);
            }
            true
        });
        figures
    }

    fn closed_form(&self) -> Option<Vec<f64>> {
        None
    }
}
