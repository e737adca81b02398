//! Rotation of a held object about its pads: a load off centre against the torsional friction of two patches.

use super::contact::RigidCoulomb;
use super::friction::Friction;
use crate::file::sections;
use crate::schedule::STEP_S;

/// Torsional friction of a Hertzian patch: `M = (3 pi / 16) mu P a` (Johnson 1985, section 7.4, all of it slipping).
pub const TORSION: f64 = 3.0 * std::f64::consts::PI / 16.0;

/// A pendulum with dry friction at its pivot: `I w' = m g (x cos - h sin) - M`, I = m r^2.
///
/// Shear and torsion share one friction: `(Q / Q_max)^2 + (M / M_max)^2 <= 1` (Howe and Cutkosky 1996, the ellipsoid).
/// While the pad sticks each has what the other leaves. What slides pulls against its own direction, and the skin needs
/// some way to lean into a new one: an object that turns loses its friction along the pad over that way and sinks, the
/// more slowly the faster it turns.
#[derive(Clone, Debug)]
pub struct Pitch {
    offset_m: f64,
    hang_m: f64,
    gyration_m: f64,
    radius_m: f64,
    contact: RigidCoulomb,
    /// Positive towards the load.
    pub(crate) angle_rad: f64,
    speed_rad_s: f64,
    used_part: f64,
    turn_part: f64,
    slide_part: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    pub mass_kg: f64,
    pub weight_n: f64,
    pub normal_n: f64,
    pub shear_part: f64,
    pub slide_m_s: f64,
    pub drag_ns_per_m: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turn {
    pub torque_nm: f64,
    pub rub_m_s: f64,
    pub onset: bool,
    /// The least force of each pad that would keep it from turning, N, if nothing slid.
    pub needed_n: f64,
}

impl Pitch {
    pub(crate) fn new(pitch: &sections::Pitch, radius_mm: f64) -> Self {
        Self {
            offset_m: pitch.offset_mm.get() / 1e3,
            hang_m: pitch.hang_mm.get() / 1e3,
            gyration_m: pitch.gyration_mm.get() / 1e3,
            radius_m: radius_mm / 1e3,
            contact: RigidCoulomb::default(),
            angle_rad: 0.0,
            speed_rad_s: 0.0,
            used_part: 0.0,
            turn_part: 1.0,
            slide_part: 1.0,
        }
    }

    pub fn step(&mut self, load: Load, friction: Friction) -> Turn {
        let Load { mass_kg, weight_n, normal_n, .. } = load;
        let inertia_kg_m2 = mass_kg * self.gyration_m * self.gyration_m;
        let (sin, cos) = (libm::sin(self.angle_rad), libm::cos(self.angle_rad));
        let pull_nm = weight_n * (self.offset_m * cos - self.hang_m * sin);
        let arm_m = TORSION * self.radius_m;
        let drag_nms = load.drag_ns_per_m * arm_m * arm_m;
        let free_rad_s =
            (self.speed_rad_s + pull_nm / inertia_kg_m2 * STEP_S) / (1.0 + drag_nms / inertia_kg_m2 * STEP_S);
        self.lean(load.shear_part, load.slide_m_s);
        // The same step as along the pad: the limit is a torque, the mass an inertia.
        let limit_nm = 2.0 * normal_n * arm_m * self.turn_part;
        let outcome = self.contact.step(limit_nm, friction, inertia_kg_m2, free_rad_s, STEP_S);
        self.speed_rad_s = outcome.speed_m_s;
        self.angle_rad += self.speed_rad_s * STEP_S;
        let whole_nm = 2.0 * arm_m * friction.mu_s * normal_n;
        self.used_part = if whole_nm > 0.0 { (outcome.force_n.abs() / whole_nm).min(1.0) } else { 0.0 };
        Turn {
            torque_nm: (drag_nms * free_rad_s - outcome.force_n) / 2.0,
            rub_m_s: self.speed_rad_s * self.radius_m,
            onset: outcome.onset,
            needed_n: pull_nm.abs() / (2.0 * arm_m * friction.mu_s),
        }
    }

    pub fn leaves(&self, friction: Friction) -> Friction {
        Friction { mu_s: friction.mu_s * self.slide_part, mu_d: friction.mu_d * self.slide_part }
    }

    fn lean(&mut self, shear_part: f64, slide_m_s: f64) {
        if !self.turns() && slide_m_s == 0.0 {
            (self.turn_part, self.slide_part) = (left(shear_part), left(self.used_part));
            return;
        }
        let turns_m_s = self.turns_m_s();
        let both_m_s = (turns_m_s * turns_m_s + slide_m_s * slide_m_s).sqrt();
        if both_m_s == 0.0 {
            return;
        }
        let leans = 1.0 - libm::exp(-both_m_s * STEP_S / LEANS_M);
        let lean =
            |part: f64, own_m_s: f64| (part + leans * (own_m_s.abs() / both_m_s - part)).clamp(LEAST, 1.0);
        self.turn_part = lean(self.turn_part, turns_m_s);
        self.slide_part = lean(self.slide_part, slide_m_s);
    }

    pub(crate) fn turns_m_s(&self) -> f64 {
        self.speed_rad_s * TORSION * self.radius_m
    }

    pub const fn turns(&self) -> bool {
        !self.contact.sticks()
    }
}

/// The way over which the skin leans into a new direction, m: that over which a pad of 2 N/mm takes up the shear of 1 N
/// (assumed; a bristle's relaxation length is the deflection at which it slides).
const LEANS_M: f64 = 0.5e-3;
/// No friction at all has no direction to begin in.
const LEAST: f64 = 0.03;

fn left(part: f64) -> f64 {
    (1.0 - part * part).max(LEAST * LEAST).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::quantity::{Lever, Millimetres};
    use crate::physics::GRAVITY_M_S2;
    use proptest::prelude::*;

    const MASS_KG: f64 = 0.2;
    const WEIGHT_N: f64 = MASS_KG * GRAVITY_M_S2;
    const FRICTION: Friction = Friction { mu_s: 0.5, mu_d: 0.4 };

    fn pitch(offset_mm: f64, hang_mm: f64) -> Pitch {
        let section = sections::Pitch {
            offset_mm: Lever::of(offset_mm),
            hang_mm: Lever::of(hang_mm),
            gyration_mm: Millimetres::of(25.0),
        };
        Pitch::new(&section, 5.0)
    }

    fn under(normal_n: f64) -> Load {
        Load { mass_kg: MASS_KG, weight_n: WEIGHT_N, normal_n, ..Load::default() }
    }

    #[test]
    fn it_turns_from_the_torque_of_the_closed_form() {
        // m g x = 2 (3 pi / 16) mu_s P a, with no shear.
        let offset_m = 0.004;
        let critical_n = WEIGHT_N * offset_m / (2.0 * TORSION * FRICTION.mu_s * 0.005);
        let turns = |normal_n| {
            let mut pitch = pitch(offset_m * 1e3, 0.0);
            pitch.step(under(normal_n), FRICTION);
            pitch.turns()
        };
        assert!(!turns(critical_n * 1.001) && turns(critical_n * 0.999));
    }

    proptest! {
        #[test]
        fn torsional_friction_never_adds_energy(
            speed_rad_s in -20.0..20.0, normal_n in 0.0..50.0, shear_part in 0.0..1.0, mass_kg in 0.001..2.0,
        ) {
            let mut pitch = pitch(0.0, 0.0);
            pitch.speed_rad_s = speed_rad_s;
            pitch.step(Load { mass_kg, normal_n, shear_part, ..Load::default() }, FRICTION);
            prop_assert!(pitch.speed_rad_s.abs() <= speed_rad_s.abs());
        }
    }
}
