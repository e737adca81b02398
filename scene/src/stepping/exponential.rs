//! An exponential step on LuGre: the bristle is solved exactly for the speed that the body has.

use super::{Body, Bristle, LuGre, Method, State};

/// Bristle first, by its own exponential; then the body, semi-implicitly.
///
/// A sliding bristle is stable at any step. A sticking one is a spring under the body, and is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential(pub LuGre);

/// z after `dt_s` at constant speed: z' = v - rate z.
fn relaxed(bristle_m: f64, slide_m_s: f64, rate_per_s: f64, dt_s: f64) -> f64 {
    let decay = rate_per_s * dt_s;
    // (1 - exp(-d)) / d, which is 1 at rest.
    let part = if decay > 0.0 { -libm::expm1(-decay) / decay } else { 1.0 };
    bristle_m + (slide_m_s - rate_per_s * bristle_m) * dt_s * part
}

impl Method for Exponential {
    fn name(&self) -> &'static str {
        "exponential, LuGre"
    }

    fn step(&self, body: &dyn Body, state: &mut State, t_s: f64, dt_s: f64) {
        let load = body.load(t_s, state.position_m, state.speed_m_s);
        let slide_m_s = state.speed_m_s - load.surface_m_s;
        let rate_per_s = self.0.rate_per_s(body, &load, slide_m_s);
        let bristle_m =
            if rate_per_s.is_finite() { relaxed(state.bristle_m, slide_m_s, rate_per_s, dt_s) } else { 0.0 };
        let bending_m_s = (bristle_m - state.bristle_m) / dt_s;
        let friction_n = self.0.friction_n(body.mass_kg(), bristle_m, bending_m_s);
        state.bristle_m = bristle_m;
        state.speed_m_s += (load.force_n + friction_n) / body.mass_kg() * dt_s;
        state.position_m += state.speed_m_s * dt_s;
        state.slid_m += (state.speed_m_s - load.surface_m_s) * dt_s;
    }

    fn drag(&self, bristle: Bristle, bristle_m: f64, slide_m_s: f64, dt_s: f64) -> f64 {
        relaxed(bristle_m, slide_m_s, slide_m_s.abs() / bristle.sliding_m, dt_s)
    }
}
