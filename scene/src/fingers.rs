//! Several fingertips around one object: each has its own motor, skin and sensors; they share what they hold.
//!
//! The object moves along the fingers as one mass, held by the patch of skin under each (L1), so that what one lets go of the others
//! bear. In the plane of the grip it is where the forces balance: pad and object are a spring behind each finger. It does not turn.

use tenax_hal_shim::channel::{
    ARRAY, COUNT, FSR, MYO_FLEXOR, OPENING, PVDF, PVDF_COUNT, SCANS_PER_FRAME, STRAIN,
};
use tenax_hal_shim::motor::MotorDrive;

use crate::file::SceneFile;
use crate::file::sections::{self, Drag, Tilt};
use crate::physics::brush::{BrushPatch, ELEMENTS, Pad};
use crate::physics::friction::{Friction, Surface};
use crate::physics::gripper::Gripper;
use crate::physics::pull::Pulls;
use crate::physics::wearer::Wearer;
use crate::physics::{GRAVITY_M_S2, Touch};
use crate::plant::{Calibrated, Pins};
use crate::random::Seeds;
use crate::schedule::{STEP_S, Span, smooth};
use crate::sensor::array::{Elements, Shakes};
use crate::sensor::converter::Converter;
use crate::sensor::fsr::Quadrants;
use crate::sensor::hand;
use crate::sensor::myo::Envelopes;
use crate::sensor::pvdf::Films;
use crate::sensor::strain::Gauges;

/// How long the table takes to go, s.
const LIFTS_S: f64 = 0.5;
/// What holds an object that the fingers leave free in one direction, as a part of a finger's stiffness: skin, sideways.
const SIDEWAYS: f64 = 0.02;
/// Rounds in which those that press are found.
const ROUNDS: usize = 8;

#[derive(Debug)]
pub struct Finger {
    /// From the object towards it.
    towards: [f64; 2],
    gripper: Gripper,
    patch: BrushPatch,
    surface: Surface,
    friction: Friction,
    touch: Touch,
    skin: Skin,
    pins: Pins,
}

/// The sensors of a finger.
#[derive(Debug)]
struct Skin {
    films: Films,
    quadrants: Quadrants,
    gauges: Gauges,
    elements: Elements,
    converter: Converter,
    slow_v: [f64; COUNT],
    released_n: f64,
}

/// A hand of several fingertips that runs.
#[derive(Debug)]
pub struct Fingers {
    scans: u64,
    fingers: Vec<Finger>,
    wearer: Wearer,
    envelopes: Envelopes,
    pulls: Pulls,
    hand: sections::Fingers,
    empty_kg: f64,
    mass_kg: f64,
    fills: Vec<(Span, f64)>,
    half_mm: f64,
    stiffness_n_per_mm: f64,
    skin_ns_per_m: f64,
    pad_m: f64,
    /// Where it is in the plane of the grip, mm, and how far it went along the fingers, m.
    place_mm: [f64; 2],
    slid_m: f64,
    speed_m_s: f64,
    pulls_n: f64,
    aside_n: [f64; 2],
    dropped: bool,
}

fn towards(at_deg: f64) -> [f64; 2] {
    let rad = at_deg.to_radians();
    [libm::cos(rad), libm::sin(rad)]
}

fn along(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl Fingers {
    /// The scene at its beginning; None if it is none of several fingertips.
    pub fn new(scene: &SceneFile, seed: u64) -> Option<Self> {
        let hand = scene.fingers.clone()?;
        let object = scene.object.as_ref()?.get_ref();
        let contact = &scene.contact;
        let radius_m = contact.patch_radius_mm.get() / 1e3;
        let skin_n_per_m = contact.skin_n_per_mm().get() * 1e3;
        let pad =
            Pad { radius_m, stiffness_n_per_m3: skin_n_per_m / (std::f64::consts::PI * radius_m * radius_m) };
        let fingers = hand.finger.iter().zip(0..).map(|(finger, n)| {
            let seeds = Seeds { making: seed + 1_000 * n, noise: seed + 1_000 * n };
            let wets = if finger.wet { scene.wet.as_slice() } else { &[] };
            Finger {
                towards: towards(finger.at_deg.get()),
                gripper: Gripper::new(&scene.gripper),
                patch: BrushPatch::new(pad, ELEMENTS),
                surface: Surface::new(contact, wets),
                friction: Friction { mu_s: contact.mu_s.get(), mu_d: contact.mu_d.get_ref().get() },
                touch: Touch::default(),
                skin: Skin {
                    films: Films::new(&scene.pvdf, (&scene.knock, &scene.hum), contact.pitch_mm.get(), seeds),
                    quadrants: Quadrants::new(&scene.fsr),
                    gauges: Gauges::new(&scene.strain, seeds),
                    elements: Elements::new(scene, seeds.noise),
                    converter: Converter::new(seeds.noise),
                    slow_v: Pins::default().0,
                    released_n: 0.0,
                },
                pins: Pins::default(),
            }
        });
        let fills = scene.fill.iter();
        Some(Self {
            scans: 0,
            fingers: fingers.collect(),
            wearer: Wearer::new(&scene.muscle),
            envelopes: Envelopes::new(&scene.myo, &scene.electrode_lift, scene.pvdf.mains_hz.get(), seed),
            pulls: Pulls::new(&scene.pull),
            empty_kg: object.mass_kg.get(),
            mass_kg: object.mass_kg.get(),
            fills: fills
                .map(|fill| {
                    (Span::new(fill.at_s.get_ref().get(), fill.for_s.get()), fill.add_kg.get_ref().get())
                })
                .collect(),
            half_mm: object.width_mm.get() / 2.0,
            stiffness_n_per_mm: object.stiffness_n_per_mm.get(),
            skin_ns_per_m: skin_n_per_m * contact.skin_ms().get() / 1e3,
            pad_m: contact.pad_length_mm.get() / 1e3,
            hand,
            place_mm: [0.0; 2],
            slid_m: 0.0,
            speed_m_s: 0.0,
            pulls_n: 0.0,
            aside_n: [0.0; 2],
            dropped: false,
        })
    }

    /// Goes on by one scan period under a drive for each finger.
    pub fn scan(&mut self, drives: &[MotorDrive]) {
        self.scans += 1;
        let t_s = self.scans as f64 * STEP_S;
        let grip_n = self.fingers.iter().map(|finger| finger.touch.normal_n).fold(0.0, f64::max);
        let effort = self.wearer.step(t_s, grip_n);
        self.loads(t_s);
        for (finger, &drive) in self.fingers.iter_mut().zip(drives) {
            finger.gripper.step(drive, finger.touch.normal_n);
        }
        self.balance();
        self.slide(t_s);
        let is_slow = (self.scans - 1).is_multiple_of(SCANS_PER_FRAME as u64);
        // The electrodes are on the arm, and every finger is wired to them.
        let muscles_v = is_slow.then(|| self.envelopes.step(t_s, &effort));
        for finger in &mut self.fingers {
            finger.sense(t_s, muscles_v);
        }
    }

    /// What pulls the object along the fingers, and aside.
    fn loads(&mut self, t_s: f64) {
        let Self { hand, fills, .. } = self;
        self.mass_kg = self.empty_kg + fills.iter().map(|(span, kg)| kg * span.progress(t_s)).sum::<f64>();
        let lifted = smooth(Span::new(hand.lift_s.get(), LIFTS_S).progress(t_s));
        let turned = |tilt: &Tilt| {
            tilt.by_deg.get() * smooth(Span::new(tilt.at_s.get(), tilt.for_s.get()).progress(t_s))
        };
        let tilt_rad = hand.tilt.iter().map(turned).sum::<f64>().to_radians();
        let weight_n = self.mass_kg * GRAVITY_M_S2 * lifted;
        // Up is positive in a scene's pulls.
        self.pulls_n = weight_n * libm::cos(tilt_rad) - self.pulls.force_n(t_s);
        self.aside_n = [weight_n * libm::sin(tilt_rad), 0.0];
        for drag in &hand.drag {
            let Drag { at_s, for_s, ramp_ms, force_n, to_deg } = *drag;
            let ramp_s = ramp_ms.get() / 1e3;
            let goes = Span::new(at_s.get() + for_s.get(), ramp_s).progress(t_s);
            let part = smooth(Span::new(at_s.get(), ramp_s).progress(t_s)) - smooth(goes);
            let to = towards(to_deg.get());
            self.aside_n = [0, 1].map(|n| self.aside_n[n] + to[n] * force_n.get() * part);
        }
    }

    /// Puts the object where the forces balance: Newton's step is exact while the same fingers press.
    fn balance(&mut self) {
        let k = self.stiffness_n_per_mm;
        for _ in 0..ROUNDS {
            let [x, y] = self.place_mm;
            let mut rest = [self.aside_n[0] - SIDEWAYS * k * x, self.aside_n[1] - SIDEWAYS * k * y];
            let mut slope = [SIDEWAYS * k, 0.0, SIDEWAYS * k];
            let mut same = true;
            for finger in &mut self.fingers {
                let deep_mm =
                    self.half_mm - finger.gripper.opening_mm() / 2.0 + along(finger.towards, self.place_mm);
                let normal_n = if self.dropped { 0.0 } else { (k * deep_mm).max(0.0) };
                same &= (normal_n - finger.touch.normal_n).abs() < 1e-9;
                finger.touch.normal_n = normal_n;
                let [a, b] = finger.towards;
                rest = [rest[0] - a * normal_n, rest[1] - b * normal_n];
                if normal_n > 0.0 {
                    slope = [slope[0] + k * a * a, slope[1] + k * a * b, slope[2] + k * b * b];
                }
            }
            if same {
                return;
            }
            let whole = slope[0] * slope[2] - slope[1] * slope[1];
            self.place_mm = [
                x + (rest[0] * slope[2] - rest[1] * slope[1]) / whole,
                y + (rest[1] * slope[0] - rest[0] * slope[1]) / whole,
            ];
        }
    }

    /// Moves the object along the fingers.
    fn slide(&mut self, t_s: f64) {
        let by_m = self.speed_m_s * STEP_S;
        let mut held_n = 0.0;
        for finger in &mut self.fingers {
            finger.friction = finger.surface.at(t_s);
            let before_m_s = self.speed_m_s;
            let normal_n = finger.touch.normal_n;
            let outcome = finger.patch.step(normal_n, finger.friction, by_m);
            // Rubber that sticks takes the swing out of what hangs on it.
            let damped_n = self.skin_ns_per_m * outcome.stuck_part * before_m_s;
            held_n += if normal_n > 0.0 { outcome.shear_n + damped_n } else { 0.0 };
            let sticks = outcome.stuck_part > 0.0;
            finger.touch = Touch {
                normal_n,
                shear_n: outcome.shear_n,
                slide_m_s: if sticks { 0.0 } else { self.speed_m_s },
                sticks,
                stuck_part: outcome.stuck_part,
                let_go: outcome.let_go,
                released_n: outcome.released_n,
                drop_n: (finger.friction.mu_s - finger.friction.mu_d) * normal_n,
                ..Touch::default()
            };
        }
        self.speed_m_s += (self.pulls_n - held_n) / self.mass_kg * STEP_S;
        let is_lifted = t_s > self.hand.lift_s.get();
        if !is_lifted {
            // It stands.
            self.speed_m_s = 0.0;
        }
        self.slid_m += self.speed_m_s * STEP_S;
        self.dropped |= is_lifted && self.slid_m.abs() > self.pad_m;
    }

    /// The fingers, in the scene's order.
    pub fn fingers(&self) -> &[Finger] {
        &self.fingers
    }

    /// Whether it has left the pads.
    pub const fn is_dropped(&self) -> bool {
        self.dropped
    }

    /// How far it went along the fingers, mm, the skin's stretch included.
    pub const fn slid_mm(&self) -> f64 {
        self.slid_m * 1e3
    }

    /// What pulls it aside, N.
    pub const fn aside_n(&self) -> [f64; 2] {
        self.aside_n
    }

    /// The wearer to whom every finger was calibrated before.
    pub fn calibrated(&self) -> Option<Calibrated> {
        self.wearer.calibrated()
    }
}

impl Finger {
    fn sense(&mut self, t_s: f64, muscles_v: Option<[f64; 2]>) {
        let Self { skin, touch, gripper, .. } = self;
        skin.released_n += touch.released_n;
        if let Some(muscles_v) = muscles_v {
            let shakes = Shakes {
                t_s,
                released_n: std::mem::take(&mut skin.released_n),
                motor_speed: gripper.speed_part(),
            };
            skin.slow_v[STRAIN..FSR].copy_from_slice(&skin.gauges.step(touch));
            skin.slow_v[FSR..ARRAY].copy_from_slice(&skin.quadrants.step(touch, [0.0; ARRAY - FSR]));
            skin.slow_v[ARRAY..MYO_FLEXOR].copy_from_slice(&skin.elements.step(touch, shakes));
            skin.slow_v[MYO_FLEXOR..OPENING].copy_from_slice(&muscles_v);
            skin.slow_v[OPENING..COUNT].copy_from_slice(&hand::pins_v(gripper));
        }
        let Pins(pins_v) = &mut self.pins;
        *pins_v = skin.slow_v;
        let films_v = skin.films.step(t_s, touch, gripper.speed_part(), 0.0);
        pins_v[PVDF..PVDF + PVDF_COUNT].copy_from_slice(&films_v);
        skin.converter.step(pins_v);
    }

    pub const fn pins(&self) -> &Pins {
        &self.pins
    }

    pub const fn touch(&self) -> &Touch {
        &self.touch
    }

    pub const fn friction(&self) -> Friction {
        self.friction
    }

    /// Where its force on the object points.
    pub fn pushes(&self) -> [f64; 2] {
        self.towards.map(|part| -part)
    }
}
