//! An object between two fingers, over a table.

use super::friction::{Friction, Surface};
use super::hand::Hand;
use super::level::{Level, Push};
use super::limit::Body;
use super::pitch::{Load, Pitch, Turn};
use super::pull::Pulls;
use super::{GRAVITY_M_S2, TOUCH_N, Touch};
use crate::file::SceneFile;
use crate::file::sections::Object;
use crate::schedule::{STEP_S, Span};

const PADS: f64 = 2.0;

/// The object, what is poured into it, the table under it, and the two pads at its sides.
///
/// Vertical motion, and pitch where the scene asks for it: `m(t) v' = Q_1 + Q_2 - m(t) g + N` stepped in the hand's
/// frame, where the arm's acceleration is an inertial force and sticking is rest. The two fingers press alike and share
/// the shear; one of them is sensed. The table wears a mat, a spring and damper, so that the weight passes from the
/// table to the hand over a millimetre and not between two scans.
#[derive(Clone, Debug)]
pub struct Grasp {
    empty_kg: f64,
    fills: Vec<(Span, f64)>,
    pulls: Pulls,
    shared: bool,
    pub(crate) taken: bool,
    surface: Surface,
    pub(crate) body: Body,
    pitch: Option<Pitch>,
    pad_m: f64,
    mat_n_per_m: f64,
    mat_ns_per_m: f64,
    rest_m: f64,
    contact: Level,
    mu_per_decade: f64,
    sticks: bool,
    shear_part: f64,
    in_hand: bool,
    lifted: bool,
    slid_m: f64,
    speed_m_s: f64,
    pub(crate) mass_kg: f64,
    table_n: f64,
    /// The least grip force of each finger that would hold the object at this instant, N.
    pub(crate) needed_n: f64,
    needs_n: [f64; 2],
    shear_n: f64,
    holds: f64,
    slides: f64,
}

const STOPS_S: f64 = 0.030;

impl Grasp {
    pub(crate) fn new(scene: &SceneFile, object: &Object) -> Self {
        let empty_kg = object.mass_kg.get();
        let mat_n_per_m = scene.table.mat_n_per_mm.get() * 1e3;
        let mat_ns_per_m = 2.0 * scene.table.damping.get() * (mat_n_per_m * empty_kg).sqrt();
        let fills = scene
            .fill
            .iter()
            .map(|fill| (Span::of(fill.at_s, fill.for_s), fill.add_kg.get_ref().get()))
            .collect();
        Self {
            empty_kg,
            fills,
            pulls: Pulls::new(&scene.pull),
            shared: false,
            taken: false,
            surface: Surface::new(&scene.contact, &scene.wet),
            body: Body::new(object),
            pitch: scene
                .pitch
                .as_ref()
                .map(|pitch| Pitch::new(pitch.get_ref(), scene.contact.patch_radius_mm.get())),
            pad_m: scene.contact.pad_length_mm.get() / 1e3,
            mat_n_per_m,
            mat_ns_per_m,
            rest_m: -empty_kg * GRAVITY_M_S2 / mat_n_per_m,
            contact: Level::new(&scene.contact),
            mu_per_decade: scene.contact.mu_per_decade.get(),
            sticks: true,
            shear_part: 0.0,
            in_hand: true,
            lifted: false,
            slid_m: 0.0,
            speed_m_s: 0.0,
            mass_kg: empty_kg,
            table_n: empty_kg * GRAVITY_M_S2,
            needed_n: 0.0,
            needs_n: [0.0; 2],
            shear_n: 0.0,
            holds: 0.0,
            slides: 0.0,
        }
    }

    pub(crate) const fn load(&mut self, more_kg: f64) {
        self.empty_kg += more_kg;
    }

    pub(crate) fn pull(&mut self, at_s: f64, force_n: f64) {
        self.pulls.push(at_s, 1.0, -force_n, 0.1);
    }

    pub(crate) fn wet(&mut self, at_s: f64) {
        self.surface.wet(at_s);
    }

    pub fn step(&mut self, t_s: f64, hand: &Hand, grip_n: f64) -> Touch {
        let poured_kg = self.fills.iter().map(|(span, kg)| kg * span.progress(t_s)).sum::<f64>();
        self.mass_kg = self.empty_kg + poured_kg;
        let dry = self.surface.at(t_s);
        let grip_n = if self.in_hand { self.body.bears(grip_n) } else { 0.0 };

        let depth_m = -self.height_m(hand);
        let sinking_m_s = -(self.speed_m_s + hand.speed_m_s);
        self.table_n = if depth_m > 0.0 {
            (self.mat_n_per_m * depth_m + self.mat_ns_per_m * sinking_m_s).max(0.0)
        } else {
            0.0
        };
        self.shared = self.pulls.takes(t_s);
        let free_n =
            self.table_n + self.pulls.force_n(t_s) - self.mass_kg * (GRAVITY_M_S2 + hand.acceleration_m_s2);
        let drag_ns_per_m = self.drag_ns_per_m(dry, grip_n);
        // Backward Euler: no drag turns the motion round.
        let free_m_s =
            (self.speed_m_s + free_n / self.mass_kg * STEP_S) / (1.0 + drag_ns_per_m / self.mass_kg * STEP_S);
        // Torsion lets go where shear alone would: of a patch, that is below mu_s.
        let holds = self.contact.holds(dry);
        let slides = dry.mu_d.min(holds);
        (self.holds, self.slides) = (holds, slides);
        let turn = self.turn(Friction { mu_s: holds, mu_d: slides }, grip_n, drag_ns_per_m, hand);
        let friction = self.pitch.as_ref().map_or(dry, |pitch| pitch.leaves(dry));
        let push = Push { normal_n: grip_n, pads: PADS, friction, mass_kg: self.mass_kg, free_m_s };
        let outcome = self.contact.step(push, STEP_S);
        self.speed_m_s = outcome.speed_m_s;
        self.slid_m += self.speed_m_s * STEP_S;
        self.sticks = outcome.sticks;
        let shear_n = (outcome.force_n - drag_ns_per_m * free_m_s) / PADS;
        self.shear_part = if grip_n > 0.0 { (shear_n.abs() / (holds * grip_n)).min(1.0) } else { 0.0 };

        let along_n = free_n.abs() / PADS / holds;
        self.needed_n = libm::hypot(along_n, turn.needed_n);
        self.needs_n = [along_n, turn.needed_n];
        self.shear_n = shear_n;
        self.lifted |= grip_n > TOUCH_N && self.table_n == 0.0;
        self.taken |= self.in_hand && self.shared && self.lifted && grip_n == 0.0;
        self.in_hand &= self.slid_m.abs() <= self.pad_m && !self.body.broken && !self.taken;
        // Pulled out of the fingers: they had it in their hand.
        self.taken |= !self.in_hand && self.shared && self.lifted;
        let drop_n = (friction.mu_s - friction.mu_d) * grip_n;
        let twisted_n = if turn.onset { drop_n } else { 0.0 };
        Touch {
            normal_n: grip_n,
            shear_n,
            slide_m_s: -self.speed_m_s,
            turn_m_s: turn.rub_m_s,
            torque_nm: turn.torque_nm,
            sticks: outcome.sticks && !self.turns(),
            stuck_part: outcome.stuck_part,
            let_go: outcome.let_go + usize::from(turn.onset),
            released_n: outcome.released_n + twisted_n,
            drop_n,
        }
    }

    fn turn(&mut self, friction: Friction, grip_n: f64, drag_ns_per_m: f64, hand: &Hand) -> Turn {
        let Some(pitch) = self.pitch.as_mut().filter(|_| self.in_hand) else { return Turn::default() };
        let hangs = self.table_n == 0.0;
        let weight_n = if hangs { self.mass_kg * (GRAVITY_M_S2 + hand.acceleration_m_s2) } else { 0.0 };
        let slide_m_s = if self.sticks { 0.0 } else { self.speed_m_s };
        let load = Load {
            mass_kg: self.mass_kg,
            weight_n,
            normal_n: grip_n,
            shear_part: self.shear_part,
            slide_m_s,
            drag_ns_per_m,
        };
        pitch.step(load, friction)
    }

    fn rubs_m_s(&self) -> f64 {
        let turns_m_s = self.pitch.as_ref().map_or(0.0, Pitch::turns_m_s);
        (self.speed_m_s * self.speed_m_s + turns_m_s * turns_m_s).sqrt()
    }

    fn drag_ns_per_m(&self, friction: Friction, grip_n: f64) -> f64 {
        if self.sticks && !self.turns() {
            return 0.0;
        }
        PADS * grip_n * friction.rise_s_per_m(self.mu_per_decade, self.rubs_m_s())
    }

    fn turns(&self) -> bool {
        self.pitch.as_ref().is_some_and(Pitch::turns)
    }

    /// Width, mm, and stiffness of pad and object together, N/mm a finger. None once the object has left the pads.
    pub fn between_the_fingers(&self) -> Option<(f64, f64)> {
        self.in_hand.then(|| (self.body.width_mm(), self.body.stiffness_n_per_mm))
    }

    pub fn height_m(&self, hand: &Hand) -> f64 {
        self.rest_m + hand.height_m + self.slid_m
    }

    pub(crate) fn mu_s(&self, t_s: f64) -> f64 {
        self.surface.at(t_s).mu_s
    }

    pub fn table_part(&self) -> f64 {
        self.table_n / (self.mass_kg * GRAVITY_M_S2)
    }

    pub fn is_held(&self) -> bool {
        self.in_hand && self.lifted && self.table_n == 0.0
    }

    pub const fn is_dropped(&self) -> bool {
        self.lifted && !self.in_hand && !self.taken
    }

    pub const fn is_shared(&self) -> bool {
        self.shared || self.taken
    }

    pub fn pitch_rad(&self) -> f64 {
        self.pitch.as_ref().map_or(0.0, |pitch| pitch.angle_rad)
    }

    /// Grip force of each finger that carries a sliding or turning object and stops it within [`STOPS_S`], N. None while it sticks.
    pub fn stops_n(&self) -> Option<f64> {
        let carries_n = self.needed_n * self.holds / self.slides;
        let brakes_n = self.mass_kg * self.rubs_m_s() / STOPS_S / PADS / self.slides;
        (!self.sticks || self.turns()).then_some(carries_n + brakes_n)
    }

    /// The least grip force of each finger under which all that sticks would stick, the swing of the skin's spring included, N.
    pub fn carries_n(&self) -> f64 {
        let [along_n, turning_n] = self.needs_n;
        libm::hypot(along_n.max(self.shear_n.abs() / self.holds), turning_n)
    }

    pub fn margin_n(&self, grip_n: f64) -> f64 {
        self.holds * (grip_n - self.needed_n)
    }
}
