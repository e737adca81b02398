//! Levels of contact: rigid (L0), a patch (L1), or friction that falls with speed (L2).

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
    Patch(Patch),
    Stribeck(Falling),
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
                let stiffness_n_per_m3 = contact.skin_n_per_mm().get() * 1e3 / area_m2;
                Self::Patch(Patch::new(Pad { radius_m, stiffness_n_per_m3 }, contact.skin_ms().get() / 1e3))
            }
            sections::Level::L2 => {
                let speed_m_s = contact.stribeck_mm_s().get() / 1e3;
                Self::Stribeck(Falling { contact: RigidCoulomb::default(), speed_m_s, before_m_s: 0.0 })
            }
        }
    }

    pub fn holds(&self, friction: Friction) -> f64 {
        match self {
            Self::Rigid(_) | Self::Stribeck(..) => friction.mu_s,
            Self::Patch(_) => friction.mu_s * closed_form::peak(friction),
        }
    }

    pub fn step(&mut self, push: Push, dt_s: f64) -> Outcome {
        let push = Push { normal_n: push.normal_n.max(0.0), ..push };
        match self {
            Self::Rigid(contact) => rigid(contact, push, dt_s),
            Self::Stribeck(falling) => falling.step(push, dt_s),
            Self::Patch(patch) => patch.step(push, dt_s),
        }
    }

    pub fn energy_j(&self, pads: f64) -> f64 {
        match self {
            Self::Patch(patch) => pads * patch.energy_j(),
            Self::Rigid(_) | Self::Stribeck(..) => 0.0,
        }
    }
}

/// L2's contact: L0's, with sliding friction that falls with speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Falling {
    contact: RigidCoulomb,
    speed_m_s: f64,
    before_m_s: f64,
}

/// Longer inner steps than this part of `m v_s / (P (mu_s - mu_d))` would be off in the growth of the vibration by more
/// than 1 % (`docs/stepping.md`).
const INNER_STEP_PART: f64 = 0.02;
/// More inner steps than this are not taken: a mass that wants more is too light for its friction to be resolved.
const INNER_STEPS_MAX: f64 = 1_000.0;

impl Falling {
    fn step(&mut self, push: Push, dt_s: f64) -> Outcome {
        let Friction { mu_s, mu_d } = push.friction;
        let curve = Stribeck { mu_s, mu_d, speed_m_s: self.speed_m_s };
        let fall_n = push.pads * push.normal_n * (mu_s - mu_d);
        let count = (dt_s * fall_n / (INNER_STEP_PART * push.mass_kg * self.speed_m_s)).ceil();
        let count = count.clamp(1.0, INNER_STEPS_MAX);
        let gain_m_s = (push.free_m_s - self.before_m_s) / count;
        let (mut force_n, mut let_go, mut released_n) = (0.0, 0, 0.0_f64);
        for _ in 0..count as u32 {
            let free_m_s = self.before_m_s + gain_m_s;
            let friction = Friction { mu_s, mu_d: curve.mu(free_m_s) };
            let inner = rigid(&mut self.contact, Push { friction, free_m_s, ..push }, dt_s / count);
            self.before_m_s = inner.speed_m_s;
            force_n += inner.force_n / count;
            let_go += inner.let_go;
            released_n = released_n.max(inner.released_n);
        }
        let sticks = self.contact.sticks();
        let stuck_part = if sticks { 1.0 } else { 0.0 };
        Outcome { speed_m_s: self.before_m_s, force_n, sticks, stuck_part, let_go, released_n }
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
