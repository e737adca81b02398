//! Levels of contact: rigid (L0), or a patch (L1).

use super::brush::{Pad, Patch, closed_form};
use super::contact::RigidCoulomb;
use super::friction::Friction;
use crate::file::{SceneFile, sections};

/// A contact of the level that the scene file names. Pads press alike; each has a share of the friction.
#[derive(Clone, Debug, PartialEq)]
pub enum Level {
    /// L0: all of it sticks or all of it slides.
    Rigid(RigidCoulomb),
    Patch(Patch),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    pub normal_n: f64,
    pub pads: f64,
    pub friction: Friction,
    pub mass_kg: f64,
    pub free_m_s: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    pub speed_m_s: f64,
    pub force_n: f64,
    pub sticks: bool,
    pub stuck_part: f64,
    pub let_go: usize,
    pub released_n: f64,
}

impl Level {
    pub fn of(scene: &SceneFile) -> Self {
        Self::new(&scene.contact)
    }

    pub(crate) fn new(contact: &sections::Contact) -> Self {
        match contact.level {
            sections::Level::L0 => Self::Rigid(RigidCoulomb::default()),
            sections::Level::L1 => {
                let radius_m = contact.patch_radius_mm.get() / 1e3;
                let area_m2 = std::f64::consts::PI * radius_m * radius_m;
                let stiffness_n_per_m3 = contact.skin_n_per_mm.get() * 1e3 / area_m2;
                Self::Patch(Patch::new(Pad { radius_m, stiffness_n_per_m3 }, contact.skin_ms.get() / 1e3))
            }
        }
    }

    pub fn holds(&self, friction: Friction) -> f64 {
        match self {
            Self::Rigid(_) => friction.mu_s,
            Self::Patch(_) => friction.mu_s * closed_form::peak(friction),
        }
    }

    pub fn step(&mut self, push: Push, dt_s: f64) -> Outcome {
        let push = Push { normal_n: push.normal_n.max(0.0), ..push };
        match self {
            Self::Rigid(contact) => rigid(contact, push, dt_s),
            Self::Patch(patch) => patch.step(push, dt_s),
        }
    }

    pub fn energy_j(&self, pads: f64) -> f64 {
        match self {
            Self::Patch(patch) => pads * patch.energy_j(),
            Self::Rigid(_) => 0.0,
        }
    }
}

fn rigid(contact: &mut RigidCoulomb, push: Push, dt_s: f64) -> Outcome {
    let Push { normal_n, pads, friction, mass_kg, free_m_s } = push;
    let outcome = contact.step(pads * normal_n, friction, mass_kg, free_m_s, dt_s);
    Outcome {
        speed_m_s: outcome.speed_m_s,
        force_n: outcome.force_n,
        sticks: contact.sticks(),
        stuck_part: if contact.sticks() { 1.0 } else { 0.0 },
        let_go: usize::from(outcome.onset),
        released_n: if outcome.onset { (friction.mu_s - friction.mu_d) * normal_n } else { 0.0 },
    }
}
