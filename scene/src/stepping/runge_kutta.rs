//! The classical fourth-order Runge-Kutta method on LuGre: what a simulator takes by default.

use super::{Body, Bristle, LuGre, Method, State};

/// Four looks a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RungeKutta4(pub LuGre);

/// Position, speed, way slid, bristle.
type Vector = [f64; 4];

impl RungeKutta4 {
    fn slope(&self, body: &dyn Body, t_s: f64, [position_m, speed_m_s, _, bristle_m]: Vector) -> Vector {
        let load = body.load(t_s, position_m, speed_m_s);
        let slide_m_s = speed_m_s - load.surface_m_s;
        let bending_m_s = self.0.bending_m_s(body, &load, slide_m_s, bristle_m);
        let friction_n = self.0.friction_n(body.mass_kg(), bristle_m, bending_m_s);
        [speed_m_s, (load.force_n + friction_n) / body.mass_kg(), slide_m_s, bending_m_s]
    }
}

/// `y + dt * slope`.
fn along(y: Vector, slope: Vector, dt_s: f64) -> Vector {
    std::array::from_fn(|n| y[n] + slope[n] * dt_s)
}

/// The slope that the four looks make.
fn mean([k1, k2, k3, k4]: [Vector; 4]) -> Vector {
    std::array::from_fn(|n| (k1[n] + 2.0 * (k2[n] + k3[n]) + k4[n]) / 6.0)
}

impl Method for RungeKutta4 {
    fn name(&self) -> &'static str {
        "RK4, LuGre"
    }

    fn step(&self, body: &dyn Body, state: &mut State, t_s: f64, dt_s: f64) {
        let y = [state.position_m, state.speed_m_s, state.slid_m, state.bristle_m];
        let half_s = dt_s / 2.0;
        let k1 = self.slope(body, t_s, y);
        let k2 = self.slope(body, t_s + half_s, along(y, k1, half_s));
        let k3 = self.slope(body, t_s + half_s, along(y, k2, half_s));
        let k4 = self.slope(body, t_s + dt_s, along(y, k3, dt_s));
        [state.position_m, state.speed_m_s, state.slid_m, state.bristle_m] =
            along(y, mean([k1, k2, k3, k4]), dt_s);
    }

    fn drag(&self, bristle: Bristle, bristle_m: f64, slide_m_s: f64, dt_s: f64) -> f64 {
        let slope = |z: f64| slide_m_s - slide_m_s.abs() * z / bristle.sliding_m;
        let k1 = slope(bristle_m);
        let k2 = slope(bristle_m + k1 * dt_s / 2.0);
        let k3 = slope(bristle_m + k2 * dt_s / 2.0);
        let k4 = slope(bristle_m + k3 * dt_s);
        bristle_m + (k1 + 2.0 * (k2 + k3) + k4) / 6.0 * dt_s
    }
}
