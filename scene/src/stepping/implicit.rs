//! Backward Euler on LuGre: speed and bristle at the end of the step are solved for together.

use super::{Body, Bristle, LuGre, Method, State};

/// Friction is implicit, with g at the speed before the step; the other forces are those before the step.
///
/// With g held, the end speed is the root of a quadratic, so no iteration is needed and none can fail to end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Implicit(pub LuGre);

impl Method for Implicit {
    fn name(&self) -> &'static str {
        "implicit, LuGre"
    }

    fn step(&self, body: &dyn Body, state: &mut State, t_s: f64, dt_s: f64) {
        let mass_kg = body.mass_kg();
        let load = body.load(t_s + dt_s, state.position_m, state.speed_m_s);
        let slide_m_s = state.speed_m_s - load.surface_m_s;
        // 1/m: sigma0 / g. Taken at a speed that is never 0, where the rate is.
        let speed_m_s = slide_m_s.abs().max(1e-12);
        let per_m = self.0.rate_per_s(body, &load, speed_m_s) / speed_m_s;
        let sigma1 = self.0.damping_ns_per_m(mass_kg);
        // m v - push + grip z(v) = 0, z(v) = (z0 + dt v) / (1 + dt |v| per_m).
        let push_ns = mass_kg * slide_m_s + load.force_n * dt_s + sigma1 * state.bristle_m;
        let grip_ns_per_m = self.0.stiffness_n_per_m * dt_s + sigma1;
        // The sign at rest says which way it ends; turned that way round, the root is the positive one.
        let residue_ns = grip_ns_per_m * state.bristle_m - push_ns;
        let way = if residue_ns > 0.0 { -1.0 } else { 1.0 };
        let a = mass_kg * dt_s * per_m;
        let b = mass_kg - way * push_ns * dt_s * per_m + grip_ns_per_m * dt_s;
        let c = residue_ns.abs();
        let root = (b * b + 4.0 * a * c).sqrt();
        // The form that subtracts no two numbers that are nearly equal.
        let end_m_s = way * if b >= 0.0 { 2.0 * c / (b + root) } else { (root - b) / (2.0 * a) };
        state.bristle_m = (state.bristle_m + dt_s * end_m_s) / (1.0 + dt_s * end_m_s.abs() * per_m);
        state.speed_m_s = end_m_s + load.surface_m_s;
        state.position_m += state.speed_m_s * dt_s;
        state.slid_m += (state.speed_m_s - load.surface_m_s) * dt_s;
    }

    fn drag(&self, bristle: Bristle, bristle_m: f64, slide_m_s: f64, dt_s: f64) -> f64 {
        (bristle_m + slide_m_s * dt_s) / (1.0 + slide_m_s.abs() * dt_s / bristle.sliding_m)
    }
}
