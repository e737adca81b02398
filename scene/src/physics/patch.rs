//! L1 at work: a mass that is held by brush patches, moved by one scan at a time.

use super::brush::{BrushPatch, ELEMENTS, Pad};
use super::level::{Outcome, Push};

/// The skin of one pad: a [`BrushPatch`] whose bristles are damped as rubber is.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    brush: BrushPatch,
    stiffness_n_per_m: f64,
    /// Damping over stiffness of the rubber, s: only what sticks deforms, so only that is damped.
    relaxation_s: f64,
    shear_n: f64,
    stuck_part: f64,
}

impl Patch {
    pub fn new(pad: Pad, relaxation_s: f64) -> Self {
        Self {
            brush: BrushPatch::new(pad, ELEMENTS),
            stiffness_n_per_m: pad.stiffness_n_per_m(),
            relaxation_s,
            shear_n: 0.0,
            stuck_part: 1.0,
        }
    }

    pub fn energy_j(&self) -> f64 {
        self.brush.energy_j()
    }

    /// Moves a mass on `pads` like this one; see [`super::level::Level::step`].
    ///
    /// Backward Euler over what sticks: `m v = m v_free - dt (Q + K v dt + K tau v)`. Each term takes energy or moves it
    /// between mass and bristles, so none grows, at any step and stiffness. What slides pulls with the shear that it has;
    /// when the mass turns round, all of it sticks again and is a spring too.
    pub(super) fn step(&mut self, push: Push, dt_s: f64) -> Outcome {
        let Push { normal_n, pads, friction, mass_kg, free_m_s } = push;
        // The pad's last shear, limited by this step's load.
        let limit_n = friction.mu_s * normal_n;
        let pull_n = pads * self.shear_n.clamp(-limit_n, limit_n);
        let momentum_ns = mass_kg * free_m_s - pull_n * dt_s;
        let turns_round = momentum_ns * self.shear_n < 0.0;
        let springs_n_per_m = pads * self.stiffness_n_per_m * if turns_round { 1.0 } else { self.stuck_part };
        let speed_m_s = momentum_ns / (mass_kg + springs_n_per_m * dt_s * (dt_s + self.relaxation_s));

        let outcome = self.brush.step(normal_n, friction, speed_m_s * dt_s);
        self.shear_n = outcome.shear_n;
        self.stuck_part = outcome.stuck_part.min(1.0);
        Outcome {
            speed_m_s,
            force_n: mass_kg * (speed_m_s - free_m_s) / dt_s,
            sticks: self.stuck_part > 0.0,
            stuck_part: self.stuck_part,
            let_go: outcome.let_go,
            released_n: outcome.released_n,
        }
    }
}
