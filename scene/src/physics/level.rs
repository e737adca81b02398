//! How much of a contact a scene needs: rigid (L0), a patch (L1), or friction that falls with speed (L2).

use super::brush::{Pad, closed_form};
use super::contact::RigidCoulomb;
use super::friction::Friction;
use super::patch::Patch;
use super::stribeck::Stribeck;
use crate::file::{SceneFile, sections};

/// A contact of the level that the scene file names. Pads press alike; each has a share of the friction.
#[derive(Clone, Debug, PartialEq)]
pub enum Level {
    /// L0: all of it sticks or all of it slides.
    Rigid(RigidCoulomb),
    /// L1: it begins to slide at its edge.
    Patch(Patch),
    /// L2: it slides the more easily the faster it slides, with Stribeck's speed in m/s.
    Stribeck(RigidCoulomb, f64),
}

/// What a step of any level did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Speed of the mass after the step, m/s.
    pub speed_m_s: f64,
    /// Mean friction of all pads during the step, N, on the mass.
    pub force_n: f64,
    /// Whether any of it sticks.
    pub sticks: bool,
    /// The part of the area that sticks.
    pub stuck_part: f64,
    /// Elements of one pad that let go.
    pub let_go: usize,
    /// The shear that one pad let go of, N.
    pub released_n: f64,
}

impl Level {
    /// At rest, as a scene has it.
    #[must_use]
    pub fn of(scene: &SceneFile) -> Self {
        Self::new(&scene.contact)
    }

    pub(crate) fn new(contact: &sections::Contact) -> Self {
        match contact.level {
            sections::Level::L0 => Self::Rigid(RigidCoulomb::default()),
            sections::Level::L1 => {
                let radius_m = contact.patch_radius_mm.get() / 1e3;
                let area_m2 = std::f64::consts::PI * radius_m * radius_m;
                let stiffness_n_per_m3 = contact.skin_n_per_mm().get() * 1e3 / area_m2;
                Self::Patch(Patch::new(Pad { radius_m, stiffness_n_per_m3 }, contact.skin_ms().get() / 1e3))
            }
            sections::Level::L2 => {
                Self::Stribeck(RigidCoulomb::default(), contact.stribeck_mm_s().get() / 1e3)
            }
        }
    }

    /// The greatest shear over normal force at which a slow pull still finds it sticking.
    #[must_use]
    pub fn holds(&self, friction: Friction) -> f64 {
        match self {
            Self::Rigid(_) | Self::Stribeck(..) => friction.mu_s,
            Self::Patch(_) => friction.mu_s * closed_form::peak(friction),
        }
    }

    /// Goes on by `dt_s`. `free_m_s` is the speed that the mass would have after it without friction; each of the `pads`
    /// presses with `normal_n`.
    pub fn step(
        &mut self,
        normal_n: f64,
        pads: f64,
        friction: Friction,
        mass_kg: f64,
        free_m_s: f64,
        dt_s: f64,
    ) -> Outcome {
        let normal_n = normal_n.max(0.0);
        match self {
            Self::Rigid(contact) => rigid(contact, normal_n, pads, friction, mass_kg, free_m_s, dt_s),
            Self::Stribeck(contact, speed_m_s) => {
                let curve = Stribeck { mu_s: friction.mu_s, mu_d: friction.mu_d, speed_m_s: *speed_m_s };
                let sliding = Friction { mu_s: friction.mu_s, mu_d: curve.mu(free_m_s) };
                rigid(contact, normal_n, pads, sliding, mass_kg, free_m_s, dt_s)
            }
            Self::Patch(patch) => patch.step(normal_n, pads, friction, mass_kg, free_m_s, dt_s),
        }
    }

    /// Energy that the pads could give back, J.
    #[must_use]
    pub fn energy_j(&self, pads: f64) -> f64 {
        match self {
            Self::Patch(patch) => pads * patch.energy_j(),
            Self::Rigid(_) | Self::Stribeck(..) => 0.0,
        }
    }
}

/// L0's step, in the words of every level.
fn rigid(
    contact: &mut RigidCoulomb,
    normal_n: f64,
    pads: f64,
    friction: Friction,
    mass_kg: f64,
    free_m_s: f64,
    dt_s: f64,
) -> Outcome {
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
