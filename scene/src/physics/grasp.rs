//! An object between two fingers, over a table.

use super::contact::RigidCoulomb;
use super::friction::Surface;
use super::hand::Hand;
use super::{GRAVITY_M_S2, TOUCH_N, Touch};
use crate::file::sections::{Fill, Object, Table};
use crate::schedule::{STEP_S, Span};

/// The object, what is poured into it, the table under it, and the two pads at its sides.
///
/// Vertical motion only: `m(t) v' = Q_1 + Q_2 - m(t) g + N` (`SCENES.md`, object and gripper), stepped in the hand's
/// frame, where the arm's acceleration is an inertial force and sticking is rest. The two fingers press alike and share
/// the shear; one of them is sensed. The table wears a mat, a spring and damper, so that the weight passes from the
/// table to the hand over a millimetre and not between two scans.
#[derive(Clone, Debug)]
pub struct Grasp {
    empty_kg: f64,
    fills: Vec<(Span, f64)>,
    surface: Surface,
    width_mm: f64,
    stiffness_n_per_mm: f64,
    pad_m: f64,
    mat_n_per_m: f64,
    mat_ns_per_m: f64,
    rest_m: f64,
    contact: RigidCoulomb,
    in_hand: bool,
    lifted: bool,
    slid_m: f64,
    speed_m_s: f64,
    mass_kg: f64,
    table_n: f64,
    needed_n: f64,
}

impl Grasp {
    pub(crate) fn new(object: &Object, fills: &[Fill], table: &Table, surface: Surface, pad_mm: f64) -> Self {
        let empty_kg = object.mass_kg.get();
        let mat_n_per_m = table.mat_n_per_mm.get() * 1e3;
        // Damping of the mat with the empty object on it, as a part of critical.
        let mat_ns_per_m = 2.0 * table.damping.get() * (mat_n_per_m * empty_kg).sqrt();
        let fills = fills
            .iter()
            .map(|fill| (Span::new(fill.at_s.get_ref().get(), fill.for_s.get()), fill.add_kg.get_ref().get()))
            .collect();
        Self {
            empty_kg,
            fills,
            surface,
            width_mm: object.width_mm.get(),
            stiffness_n_per_mm: object.stiffness_n_per_mm.get(),
            pad_m: pad_mm / 1e3,
            mat_n_per_m,
            mat_ns_per_m,
            rest_m: -empty_kg * GRAVITY_M_S2 / mat_n_per_m,
            contact: RigidCoulomb::default(),
            in_hand: true,
            lifted: false,
            slid_m: 0.0,
            speed_m_s: 0.0,
            mass_kg: empty_kg,
            table_n: empty_kg * GRAVITY_M_S2,
            needed_n: 0.0,
        }
    }

    /// Goes on by one scan to `t_s`, pressed by each finger with `grip_n`.
    pub fn step(&mut self, t_s: f64, hand: &Hand, grip_n: f64) -> Touch {
        let poured_kg = self.fills.iter().map(|(span, kg)| kg * span.progress(t_s)).sum::<f64>();
        self.mass_kg = self.empty_kg + poured_kg;
        let friction = self.surface.at(t_s);
        let grip_n = if self.in_hand { grip_n } else { 0.0 };

        let depth_m = -self.height_m(hand);
        let sinking_m_s = -(self.speed_m_s + hand.speed_m_s());
        self.table_n = if depth_m > 0.0 {
            (self.mat_n_per_m * depth_m + self.mat_ns_per_m * sinking_m_s).max(0.0)
        } else {
            0.0
        };
        let free_n = self.table_n - self.mass_kg * (GRAVITY_M_S2 + hand.acceleration_m_s2());
        let free_m_s = self.speed_m_s + free_n / self.mass_kg * STEP_S;
        let outcome = self.contact.step(2.0 * grip_n, friction, self.mass_kg, free_m_s, STEP_S);
        self.speed_m_s = outcome.speed_m_s;
        self.slid_m += self.speed_m_s * STEP_S;

        self.needed_n = free_n.abs() / 2.0 / friction.mu_s;
        self.lifted |= grip_n > TOUCH_N && self.table_n == 0.0;
        self.in_hand &= self.slid_m.abs() <= self.pad_m;
        Touch {
            normal_n: grip_n,
            shear_n: outcome.force_n / 2.0,
            slide_m_s: -self.speed_m_s,
            sticks: self.contact.sticks(),
            released_n: if outcome.onset { (friction.mu_s - friction.mu_d) * grip_n } else { 0.0 },
            drop_n: (friction.mu_s - friction.mu_d) * grip_n,
        }
    }

    /// How the fingers feel it: its width, mm, and the stiffness of pad and object together, N/mm a finger. None once
    /// it has left the pads: the fingers close on nothing.
    #[must_use]
    pub fn between_the_fingers(&self) -> Option<(f64, f64)> {
        self.in_hand.then_some((self.width_mm, self.stiffness_n_per_mm))
    }

    /// Over where it stood, m.
    #[must_use]
    pub fn height_m(&self, hand: &Hand) -> f64 {
        self.rest_m + hand.height_m() + self.slid_m
    }

    /// With what is in it, kg.
    #[must_use]
    pub const fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    /// The part of its weight that stands on the table.
    #[must_use]
    pub fn table_part(&self) -> f64 {
        self.table_n / (self.mass_kg * GRAVITY_M_S2)
    }

    /// Whether nothing but the hand carries it.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.in_hand && self.lifted && self.table_n == 0.0
    }

    /// Whether it was lifted and has then left the pads.
    #[must_use]
    pub const fn is_dropped(&self) -> bool {
        self.lifted && !self.in_hand
    }

    /// The least grip force that would hold it at this instant, N.
    #[must_use]
    pub const fn needed_n(&self) -> f64 {
        self.needed_n
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SceneFile;

    /// A glass that is lifted from 1 s on and gripped with `grip_n` all along; its touch at the end of `for_s`.
    fn lifted(grip_n: f64, for_s: f64) -> (Grasp, Touch) {
        let (_, text) = crate::builtin()[0];
        let scene = SceneFile::parse(text, "glass").unwrap();
        let mut hand = Hand::new(
            &SceneFile::parse(&text.replace("at_s = 5.0", "at_s = 1.0"), "glass").unwrap().moves[..1],
            &[],
        );
        let surface = Surface::new(&scene.contact, &[]);
        let mut grasp = Grasp::new(scene.object.as_ref().unwrap().get_ref(), &[], &scene.table, surface, 18.0);
        let mut touch = Touch::default();
        for step in 0..(for_s / STEP_S) as u32 {
            let t_s = f64::from(step) * STEP_S;
            hand.step(t_s, grasp.table_part());
            touch = grasp.step(t_s, &hand, grip_n);
        }
        (grasp, touch)
    }

    #[test]
    fn a_held_glass_pulls_with_half_its_weight_on_each_finger_and_never_creeps() {
        let (grasp, touch) = lifted(6.0, 60.0);
        assert!((touch.shear_n - 0.25 * GRAVITY_M_S2 / 2.0).abs() < 1e-9, "{} N", touch.shear_n);
        assert_eq!((grasp.slid_m, touch.slide_m_s, grasp.is_held()), (0.0, 0.0, true));
    }

    #[test]
    fn what_is_needed_is_where_it_begins_to_slide() {
        // mu_s = 0.5: the weight alone needs m g / (2 mu_s); the lift's acceleration needs up to 1.6 % more.
        let needed_n = 0.25 * GRAVITY_M_S2 / (2.0 * 0.5);
        assert!(lifted(needed_n * 1.02, 5.0).1.sticks);
        let (grasp, _) = lifted(needed_n * 0.98, 30.0);
        assert!(grasp.slid_m < 0.0 || grasp.is_dropped());
    }
}
