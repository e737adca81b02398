//! Explicit Euler on LuGre: what one writes first.

use super::{Body, Bristle, LuGre, Method, State};

/// Everything from the state before the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExplicitEuler(pub LuGre);

impl Method for ExplicitEuler {
    fn name(&self) -> &'static str {
        "explicit Euler, LuGre"
    }

    fn step(&self, body: &dyn Body, state: &mut State, t_s: f64, dt_s: f64) {
        let load = body.load(t_s, state.position_m, state.speed_m_s);
        let slide_m_s = state.speed_m_s - load.surface_m_s;
        let bending_m_s = self.0.bending_m_s(body, &load, slide_m_s, state.bristle_m);
        let friction_n = self.0.friction_n(body.mass_kg(), state.bristle_m, bending_m_s);
        state.position_m += state.speed_m_s * dt_s;
        state.slid_m += slide_m_s * dt_s;
        state.bristle_m += bending_m_s * dt_s;
        state.speed_m_s += (load.force_n + friction_n) / body.mass_kg() * dt_s;
    }

    fn drag(&self, bristle: Bristle, bristle_m: f64, slide_m_s: f64, dt_s: f64) -> f64 {
        bristle_m + (slide_m_s - slide_m_s.abs() * bristle_m / bristle.sliding_m) * dt_s
    }
}
