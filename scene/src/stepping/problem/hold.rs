//! A block that is held and shaken: does it stay?

use crate::physics::GRAVITY_M_S2;
use crate::physics::friction::Friction;
use crate::stepping::{Body, Load, Method, run};

/// A block on a pad, loaded gently to 60 % of the friction that it has, shaken by 15 %: never as much as sliding takes.
///
/// Coulomb's block does not move at all. LuGre's bristles creep, a little at every shake: the model's known fault, "drift"
/// (Dupont, Hayward, Armstrong and Altpeter 2002), which no smaller step cures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShakenHold {
    /// How long, s.
    pub duration_s: f64,
}

const MASS_KG: f64 = 0.3;
const FRICTION: Friction = Friction { mu_s: 0.5, mu_d: 0.4 };
const STEADY_PART: f64 = 0.60;
const SHAKE_PART: f64 = 0.15;
const SHAKE_HZ: f64 = 20.0;
const LOADING_S: f64 = 0.5;

impl ShakenHold {
    /// How far it has crept in the end, m.
    #[must_use]
    pub fn drift_m(&self, method: &dyn Method, dt_s: f64) -> f64 {
        let mut drift_m = 0.0;
        run(method, self, dt_s, (self.duration_s / dt_s).round() as u64, |_, state| {
            drift_m = state.slid_m;
            true
        });
        drift_m
    }
}

impl Body for ShakenHold {
    fn mass_kg(&self) -> f64 {
        MASS_KG
    }

    fn friction(&self) -> Friction {
        FRICTION
    }

    fn start(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn load(&self, t_s: f64, _: f64, _: f64) -> Load {
        let normal_n = MASS_KG * GRAVITY_M_S2 / (STEADY_PART * FRICTION.mu_s);
        // A triangle, so that an hour of it costs no sines.
        let phase = (t_s * SHAKE_HZ).fract();
        let shake = SHAKE_PART * (4.0 * (phase - 0.5).abs() - 1.0);
        let loaded = (t_s / LOADING_S).min(1.0);
        Load {
            force_n: loaded * (STEADY_PART + shake) * FRICTION.mu_s * normal_n,
            normal_n,
            surface_m_s: 0.0,
        }
    }
}
