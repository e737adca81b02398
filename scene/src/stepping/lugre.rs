//! The LuGre model: friction as bristles that bend (Canudas de Wit, Olsson, Astrom and Lischinsky 1995).

use super::{Body, Load};
use crate::physics::stribeck::Stribeck;

/// z' = v - sigma0 |v| z / g(v), friction = sigma0 z + sigma1 z'.
///
/// g is `P mu(v)`, where `mu(v) = mu_d + (mu_s - mu_d) exp(-v/v_s)`. With a small Stribeck speed it is Coulomb's mu_s and mu_d made
/// smooth, so that it can be held against the same closed forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LuGre {
    /// sigma0, N/m.
    pub stiffness_n_per_m: f64,
    /// sigma1 as a part of critical damping of the body on its bristle.
    pub damping: f64,
    /// v_s of g, m/s.
    pub stribeck_m_s: f64,
}

impl LuGre {
    /// Stiff enough for a contact of some newtons to look like Coulomb's: the incline's onset is within 1 %.
    pub const SHARP: Self = Self::stiff(1e6);

    /// A bristle of `stiffness_n_per_m`, well damped.
    #[must_use]
    pub const fn stiff(stiffness_n_per_m: f64) -> Self {
        Self { stiffness_n_per_m, damping: 0.7, stribeck_m_s: 1e-3 }
    }

    /// sigma1 under a body, N s/m.
    #[must_use]
    pub fn damping_ns_per_m(&self, mass_kg: f64) -> f64 {
        2.0 * self.damping * (self.stiffness_n_per_m * mass_kg).sqrt()
    }

    /// sigma0 |v| / g(v), 1/s: how fast a sliding bristle forgets.
    pub(super) fn rate_per_s(&self, body: &dyn Body, load: &Load, slide_m_s: f64) -> f64 {
        let friction = body.friction();
        let law = Stribeck { mu_s: friction.mu_s, mu_d: friction.mu_d, speed_m_s: self.stribeck_m_s };
        self.stiffness_n_per_m * slide_m_s.abs() / (law.mu(slide_m_s) * load.normal_n)
    }

    /// z', m/s.
    pub(super) fn bending_m_s(&self, body: &dyn Body, load: &Load, slide_m_s: f64, bristle_m: f64) -> f64 {
        slide_m_s - self.rate_per_s(body, load, slide_m_s) * bristle_m
    }

    /// Friction on the body, N.
    pub(super) fn friction_n(&self, mass_kg: f64, bristle_m: f64, bending_m_s: f64) -> f64 {
        -self.stiffness_n_per_m * bristle_m - self.damping_ns_per_m(mass_kg) * bending_m_s
    }
}
