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
/// While the pad sticks each has what the other leaves. What slides pulls against its own direction: an object that turns
/// has little friction left along the pad and sinks, the more slowly the faster it turns.
#[derive(Clone, Debug)]
pub struct Pitch {
    offset_m: f64,
    hang_m: f64,
    gyration_m: f64,
    radius_m: f64,
    contact: RigidCoulomb,
    angle_rad: f64,
    speed_rad_s: f64,
    used_part: f64,
    slide_m_s: f64,
}

/// What a step of the pitch did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turn {
    /// Torsion on one pad, N m.
    pub torque_nm: f64,
    /// Speed of the patch's edge over the object, m/s.
    pub rub_m_s: f64,
    /// Whether it began to turn in this step.
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
            slide_m_s: 0.0,
        }
    }

    /// Goes on by one scan under a weight of `weight_n` (that of the hand's acceleration included, less what a table
    /// carries), pressed by each pad with `normal_n`. The shear of the step before took `shear_part` of the friction, and
    /// the object slid at `slide_m_s`, 0 while it sticks.
    pub fn step(
        &mut self,
        mass_kg: f64,
        weight_n: f64,
        normal_n: f64,
        friction: Friction,
        shear_part: f64,
        slide_m_s: f64,
    ) -> Turn {
        let inertia_kg_m2 = mass_kg * self.gyration_m * self.gyration_m;
        let (sin, cos) = (libm::sin(self.angle_rad), libm::cos(self.angle_rad));
        let pull_nm = weight_n * (self.offset_m * cos - self.hang_m * sin);
        let free_rad_s = self.speed_rad_s + pull_nm / inertia_kg_m2 * STEP_S;
        // The same step as along the pad: the limit is a torque, the mass an inertia.
        self.slide_m_s = slide_m_s;
        let part = if slide_m_s == 0.0 { left(shear_part) } else { share(self.turns_m_s(), slide_m_s) };
        let arm_m = 2.0 * TORSION * self.radius_m * part;
        let outcome = self.contact.step(normal_n * arm_m, friction, inertia_kg_m2, free_rad_s, STEP_S);
        self.speed_rad_s = outcome.speed_m_s;
        self.angle_rad += self.speed_rad_s * STEP_S;
        let whole_nm = 2.0 * TORSION * self.radius_m * friction.mu_s * normal_n;
        self.used_part = if whole_nm > 0.0 { (outcome.force_n.abs() / whole_nm).min(1.0) } else { 0.0 };
        Turn {
            torque_nm: -outcome.force_n / 2.0,
            rub_m_s: self.speed_rad_s * self.radius_m,
            onset: outcome.onset,
            needed_n: pull_nm.abs() / (2.0 * TORSION * self.radius_m * friction.mu_s),
        }
    }

    /// The friction along the pad that torsion leaves.
    #[must_use]
    pub fn leaves(&self, friction: Friction) -> Friction {
        let part = if self.turns() { share(self.slide_m_s, self.turns_m_s()) } else { left(self.used_part) };
        Friction { mu_s: friction.mu_s * part, mu_d: friction.mu_d * part }
    }

    /// The turning as a speed over the pad: that of the radius at which all friction would make its torque, m/s.
    fn turns_m_s(&self) -> f64 {
        self.speed_rad_s * TORSION * self.radius_m
    }

    /// Whether it turns.
    #[must_use]
    pub const fn turns(&self) -> bool {
        !self.contact.sticks()
    }

    /// How far it has turned, rad, positive towards the load.
    #[must_use]
    pub const fn angle_rad(&self) -> f64 {
        self.angle_rad
    }

    /// How fast it turns, rad/s.
    #[must_use]
    pub const fn speed_rad_s(&self) -> f64 {
        self.speed_rad_s
    }
}

/// No friction at all has no direction to begin in.
const LEAST: f64 = 0.03;

/// The other half-axis of the ellipse.
fn left(part: f64) -> f64 {
    (1.0 - part * part).max(LEAST * LEAST).sqrt()
}

/// The part of sliding friction that acts against one of two speeds.
fn share(own_m_s: f64, other_m_s: f64) -> f64 {
    let both_m_s = (own_m_s * own_m_s + other_m_s * other_m_s).sqrt();
    if both_m_s > 0.0 { (own_m_s.abs() / both_m_s).max(LEAST) } else { 1.0 }
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

    #[test]
    fn it_turns_from_the_torque_of_the_closed_form() {
        // m g x = 2 (3 pi / 16) mu_s P a, with no shear.
        let offset_m = 0.004;
        let critical_n = WEIGHT_N * offset_m / (2.0 * TORSION * FRICTION.mu_s * 0.005);
        let turns = |normal_n| {
            let mut pitch = pitch(offset_m * 1e3, 0.0);
            pitch.step(MASS_KG, WEIGHT_N, normal_n, FRICTION, 0.0, 0.0);
            pitch.turns()
        };
        assert!(!turns(critical_n * 1.001) && turns(critical_n * 0.999));
    }

    #[test]
    fn without_friction_it_swings_with_the_period_of_a_pendulum() {
        let (mut pitch, mut crossings, mut last) = (pitch(0.0, 20.0), Vec::new(), 1.0);
        pitch.angle_rad = 0.01;
        for n in 0..16_000 {
            pitch.step(MASS_KG, WEIGHT_N, 0.0, FRICTION, 0.0, 0.0);
            if pitch.angle_rad < 0.0 && last >= 0.0 {
                crossings.push(f64::from(n) * STEP_S);
            }
            last = pitch.angle_rad;
        }
        let period_s = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64;
        let closed_form_s = std::f64::consts::TAU * (0.025_f64.powi(2) / (GRAVITY_M_S2 * 0.020)).sqrt();
        assert!((period_s / closed_form_s - 1.0).abs() < 2e-3, "{period_s} for {closed_form_s} s");
    }

    #[test]
    fn shear_leaves_less_for_torsion() {
        let (mut alone, mut shared) = (pitch(2.0, 0.0), pitch(2.0, 0.0));
        alone.step(MASS_KG, WEIGHT_N, 2.0, FRICTION, 0.0, 0.0);
        shared.step(MASS_KG, WEIGHT_N, 2.0, FRICTION, 0.9, 0.0);
        assert!(!alone.turns() && shared.turns());
    }

    proptest! {
        #[test]
        fn torsional_friction_never_adds_energy(
            speed_rad_s in -20.0..20.0, normal_n in 0.0..50.0, shear_part in 0.0..1.0, mass_kg in 0.001..2.0,
        ) {
            let mut pitch = pitch(0.0, 0.0);
            pitch.speed_rad_s = speed_rad_s;
            pitch.step(mass_kg, 0.0, normal_n, FRICTION, shear_part, 0.0);
            prop_assert!(pitch.speed_rad_s.abs() <= speed_rad_s.abs());
        }
    }
}
