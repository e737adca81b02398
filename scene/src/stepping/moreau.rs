//! Moreau's step, which the scenes use: no bristle, an impulse that stops the motion, limited to `mu P dt`.

use super::{Body, Bristle, Method, State};

/// The scenes' own contact ([`crate::physics::contact`]), and semi-implicit Euler for everything else: speed first, then
/// position with the new speed (Moreau 1988; Stewart and Trinkle 1996).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moreau;

impl Method for Moreau {
    fn name(&self) -> &'static str {
        "Moreau, Coulomb"
    }

    fn step(&self, body: &dyn Body, state: &mut State, t_s: f64, dt_s: f64) {
        let mass_kg = body.mass_kg();
        let load = body.load(t_s + dt_s, state.position_m, state.speed_m_s);
        let free_m_s = state.speed_m_s + load.force_n / mass_kg * dt_s - load.surface_m_s;
        let slide_m_s = state.contact.step(load.normal_n, body.friction(), mass_kg, free_m_s, dt_s).speed_m_s;
        state.speed_m_s = slide_m_s + load.surface_m_s;
        state.position_m += state.speed_m_s * dt_s;
        state.slid_m += slide_m_s * dt_s;
    }

    /// What the impulse is to a rigid contact, the clamp is to a bristle: it holds exactly, then slides exactly.
    fn drag(&self, bristle: Bristle, bristle_m: f64, slide_m_s: f64, dt_s: f64) -> f64 {
        (bristle_m + slide_m_s * dt_s).clamp(-bristle.sliding_m, bristle.sliding_m)
    }
}
