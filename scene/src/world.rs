//! A whole world: everything that moves, everything that senses, and the line over which somebody types.

use tenax_hal_shim::channel::{
    ARRAY, COUNT, FSR, HEAD, MYO_EXTENSOR, MYO_FLEXOR, OPENING, PVDF, PVDF_COUNT, SCAN_HZ, SCANS_PER_FRAME,
    STRAIN,
};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::Down;

use crate::act::{Act, REACTS_S, Touches};
use crate::bound::Plan;
use crate::causal::{Causal, Known};
use crate::commands::Script;
use crate::file::SceneFile;
use crate::file::sections::{Arm, Intent};
use crate::physics::grasp::Grasp;
use crate::physics::gripper::Gripper;
use crate::physics::hand::Hand;
use crate::physics::stroke::Stroke;
use crate::physics::vibrator::Vibrator;
use crate::physics::wearer::{Effort, Wearer};
use crate::physics::{TOUCH_N, Touch};
use crate::plant::{Calibrated, Pins, Plant};
use crate::random::Seeds;
use crate::schedule::{STEP_S, Span};
use crate::sensor::array::{Elements, Shakes};
use crate::sensor::camera::{Eye, Seen};
use crate::sensor::converter::Converter;
use crate::sensor::fault::Faults;
use crate::sensor::fsr::Quadrants;
use crate::sensor::hand_v;
use crate::sensor::myo::Envelopes;
use crate::sensor::photoelastic::Head;
use crate::sensor::pvdf::Films;
use crate::sensor::skin::SkinCamera;
use crate::sensor::strain::Gauges;
use crate::truth::{self, Row, State, TRACE_HZ, Truth};

/// What a person adds to the object at once at the bench (assumed).
const LOAD_KG: f64 = 0.1;
const TRACE_EVERY: u64 = (SCAN_HZ / TRACE_HZ) as u64;

#[derive(Debug)]
pub struct World {
    scans: u64,
    duration_s: f64,
    floor_mm_s: f64,
    wearer: Wearer,
    gripper: Gripper,
    vibrator: Option<Vibrator>,
    jams: Vec<Span>,
    task: Task,
    touch: Touch,
    films: Films,
    head: Option<Head>,
    quadrants: Quadrants,
    envelopes: Envelopes,
    gauges: Gauges,
    elements: Elements,
    eye: Eye,
    skin: Option<SkinCamera>,
    released_n: f64,
    slow_v: [f64; COUNT],
    faults: Faults,
    touches: Touches,
    converter: Converter,
    script: Script,
    trusts_line: bool,
    plan: Option<Plan>,
    causal: Option<Causal>,
    pins: Pins,
    truth: Truth,
}

/// Where everything stands, for a drawing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Distance between the fingers.
    pub opening_mm: f64,
    /// Heights over where the hand grasps.
    pub hand_mm: f64,
    pub object_mm: f64,
    pub pitch_rad: f64,
    /// As it is now, dents included; 0: a probe strokes a surface.
    pub width_mm: f64,
    pub mass_kg: f64,
    /// Friction coefficient of the surface as it is now. None: a probe strokes it.
    pub mu_s: Option<f64>,
}

#[derive(Clone, Debug)]
enum Task {
    Grasp { grasp: Box<Grasp>, hand: Hand, arm: Arm },
    Stroke(Box<Stroke>),
}

impl World {
    /// The scene at its beginning. The seed decides all noise and how the films came out in the making.
    pub fn new(scene: &SceneFile, seed: u64) -> Self {
        Self::seeded(scene, seed.into())
    }

    /// The scene at its beginning, with one seed for the fingertip's making and one for the noise.
    pub fn seeded(scene: &SceneFile, seeds: Seeds) -> Self {
        let seed = seeds.noise;
        let task = if let Some(robot) = &scene.robot {
            Task::Stroke(Box::new(Stroke::new(scene, robot.get_ref())))
        } else {
            let object = scene.object.as_ref().expect("a scene has [object] or [robot]");
            Task::Grasp {
                grasp: Box::new(Grasp::new(scene, object.get_ref())),
                hand: Hand::new(&scene.moves, &scene.swing),
                arm: scene.arm,
            }
        };
        Self {
            scans: 0,
            duration_s: scene.duration_s(),
            floor_mm_s: scene.slip_floor_mm_s(),
            wearer: Wearer::new(&scene.muscle),
            gripper: Gripper::new(&scene.gripper),
            vibrator: scene.vibrator.as_ref().map(Vibrator::new),
            jams: scene.jam.iter().map(|jam| Span::of(jam.at_s, jam.for_s)).collect(),
            task,
            touch: Touch::default(),
            films: Films::new(&scene.pvdf, (&scene.knock, &scene.hum), scene.contact.pitch_mm.get(), seeds),
            head: scene.photoelastic.as_ref().map(|head| Head::new(head, &scene.knock, seeds)),
            quadrants: Quadrants::new(&scene.fsr, seed),
            envelopes: Envelopes::new(&scene.myo, &scene.electrode_lift, scene.pvdf.mains_hz.get(), seed),
            gauges: Gauges::new(&scene.strain, seeds),
            elements: Elements::new(scene, seed),
            eye: Eye::new(&scene.camera, seed),
            skin: scene
                .skin
                .as_ref()
                .map(|skin| SkinCamera::new(skin, scene.contact.patch_radius_mm.get(), seed)),
            released_n: 0.0,
            slow_v: Pins::default().0,
            faults: Faults::new(&scene.fault),
            touches: Touches::default(),
            converter: Converter::new(seed),
            script: Script::new(&scene.command, scene.trusts_line()),
            trusts_line: scene.trusts_line(),
            plan: None,
            causal: None,
            pins: Pins::default(),
            truth: Truth::default(),
        }
    }

    pub fn planning(mut self, plan: Option<Plan>) -> Self {
        self.plan = plan;
        self
    }

    /// With a causal oracle in the place of a plan.
    pub fn with_oracle(mut self) -> Self {
        self.causal = Some(Causal::default());
        self
    }

    pub const fn truth(&self) -> &Truth {
        &self.truth
    }

    pub fn take_trace(&mut self) -> std::vec::Drain<'_, Row> {
        self.truth.trace.drain(..)
    }

    pub fn slipping(&self) -> bool {
        self.truth.slipping(&self.touch, self.floor_mm_s)
    }

    pub const fn touch(&self) -> &Touch {
        &self.touch
    }

    pub const fn head(&self) -> Option<&Head> {
        self.head.as_ref()
    }

    pub const fn said(&self) -> Option<Seen> {
        self.eye.said()
    }

    fn strokes(&self) -> bool {
        matches!(self.task, Task::Stroke(_))
    }

    pub fn pose(&self) -> Pose {
        let opening_mm = self.gripper.opening_mm;
        match &self.task {
            Task::Grasp { grasp, hand, .. } => Pose {
                opening_mm,
                hand_mm: hand.height_m * 1e3,
                object_mm: grasp.height_m(hand) * 1e3,
                pitch_rad: grasp.pitch_rad(),
                width_mm: grasp.body.width_mm(),
                mass_kg: grasp.mass_kg,
                mu_s: Some(grasp.mu_s(self.now_s())),
            },
            Task::Stroke(stroke) => Pose { opening_mm, object_mm: stroke.probe_m * 1e3, ..Pose::default() },
        }
    }

    pub fn now_s(&self) -> f64 {
        self.scans as f64 * STEP_S
    }

    fn slow(&mut self, t_s: f64, effort: &Effort) {
        let released_n = std::mem::take(&mut self.released_n);
        let pins_v = &mut self.slow_v;
        pins_v[STRAIN..FSR].copy_from_slice(&self.gauges.step(&self.touch));
        let (mut pressed_n, touched_n) = (self.faults.pressed_n(t_s), self.touches.pressed_n(t_s));
        pressed_n.iter_mut().zip(touched_n).for_each(|(pressed_n, touched_n)| *pressed_n += touched_n);
        pins_v[FSR..ARRAY].copy_from_slice(&self.quadrants.step(&self.touch, pressed_n));
        let shakes = Shakes { t_s, released_n, motor_speed: self.gripper.speed_part() };
        pins_v[ARRAY..MYO_FLEXOR].copy_from_slice(&self.elements.step(&self.touch, shakes));
        pins_v[MYO_FLEXOR..OPENING].copy_from_slice(&self.envelopes.step(t_s, effort));
        pins_v[OPENING..COUNT].copy_from_slice(&hand_v(&self.gripper));
    }

    fn handle(&mut self, at_s: f64, act: Act) {
        let Task::Grasp { grasp, hand, .. } = &mut self.task else { return };
        match act {
            Act::Grip => {
                self.wearer.contract(at_s, 4.0, Intent::Close, 1.0);
                hand.reach(at_s + 1.5, 1.5, 0.1);
            }
            Act::PutDown => {
                hand.reach(at_s, 1.5, 0.0);
                self.wearer.contract(at_s + 2.0, 1.0, Intent::Open, f64::INFINITY);
            }
            Act::Pull => grasp.pull(at_s, 1.5),
            Act::Load => grasp.load(LOAD_KG),
            _ => grasp.wet(at_s),
        }
    }

    fn moves(&mut self, t_s: f64, drive: MotorDrive) -> State {
        self.gripper.is_jammed = self.jams.iter().any(|jam| jam.contains(t_s));
        self.gripper.step(drive, self.touch.normal_n);
        match &mut self.task {
            Task::Grasp { grasp, hand, arm } => {
                let grip_n = grasp
                    .between_the_fingers()
                    .map_or(0.0, |(width_mm, stiffness)| self.gripper.grip_n(width_mm, stiffness));
                hand.step(t_s, arm.felt(grasp.table_part()));
                self.touch = grasp.step(t_s, hand, grip_n);
                let carried = grasp.is_held();
                State {
                    carried: carried || *arm == Arm::Robot,
                    dropped: grasp.is_dropped(),
                    needed_n: if carried { grasp.needed_n } else { 0.0 },
                    margin_n: if carried { grasp.margin_n(self.touch.normal_n) } else { 0.0 },
                    mass_kg: grasp.mass_kg,
                    position_mm: grasp.height_m(hand) * 1e3,
                    hand_mm: hand.height_m * 1e3,
                    pitch_rad: grasp.pitch_rad(),
                    dent_mm: grasp.body.dent_mm,
                    broken: grasp.body.broken,
                    shared: grasp.is_shared(),
                    taken: grasp.taken,
                }
            }
            Task::Stroke(stroke) => {
                self.touch = stroke.step(t_s);
                let probe_mm = stroke.probe_m * 1e3;
                State { carried: true, position_mm: probe_mm, hand_mm: probe_mm, ..State::default() }
            }
        }
    }
}

impl Plant for World {
    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.scans += 1;
        let t_s = self.now_s();
        let effort = self.wearer.step(t_s, self.touch.normal_n);
        let state = self.moves(t_s, drive);
        let hand_mm = state.hand_mm;
        let object_mm = if self.strokes() { 0.0 } else { state.position_mm };
        self.truth.camera.extend(self.eye.step(t_s, hand_mm, object_mm));
        if let Some(skin) = &mut self.skin {
            skin.step(t_s, &self.touch, state.pitch_rad);
        }
        self.truth.step(&truth::Step {
            t_s,
            touch: &self.touch,
            state,
            floor_mm_s: self.floor_mm_s,
            opens: self.gripper.speed_mm_s > 0.0,
            trace: self.scans.is_multiple_of(TRACE_EVERY),
        });

        self.released_n += self.touch.released_n;
        if (self.scans - 1).is_multiple_of(SCANS_PER_FRAME as u64) {
            self.slow(t_s, &effort);
            if let (Some(causal), Task::Grasp { grasp, .. }) = (&mut self.causal, &self.task) {
                causal.see(Known {
                    needed_n: grasp.needed_n,
                    stops_n: grasp.stops_n(),
                    wearer_active: effort.intent.is_some(),
                });
            }
        }
        let Pins(pins_v) = &mut self.pins;
        *pins_v = self.slow_v;
        pins_v[PVDF..PVDF + PVDF_COUNT].copy_from_slice(&self.films.step(
            t_s,
            &self.touch,
            self.gripper.speed_part(),
            self.vibrator.as_mut().map_or(0.0, Vibrator::step),
        ));
        if let Some(head) = &mut self.head {
            pins_v[HEAD] = head.step(t_s, &self.touch);
        }
        self.touches.apply(t_s, pins_v);
        self.faults.cut_films(t_s, pins_v);
        self.converter.step(pins_v);
        self.faults.apply(t_s, pins_v);
        &self.pins
    }

    fn calibrated(&self) -> Option<Calibrated> {
        self.wearer.calibrated()
    }

    fn commands(&mut self) -> Vec<Down> {
        let t_s = self.now_s();
        let mut commands = self.script.take(t_s);
        commands.extend(self.eye.teach(t_s));
        commands.extend(self.skin.as_mut().and_then(|skin| skin.take(t_s)).map(Down::View));
        commands
    }

    fn vibrate(&mut self, duty: Duty) {
        if let Some(vibrator) = &mut self.vibrator {
            vibrator.drive(duty);
        }
    }

    fn act(&mut self, act: Act) {
        let at_s = self.now_s() + REACTS_S;
        match act {
            Act::Touch(MYO_FLEXOR) => self.wearer.contract(at_s, 0.4, Intent::Close, f64::INFINITY),
            // Long enough to let go of what the other muscle has gripped.
            Act::Touch(MYO_EXTENSOR) => self.wearer.contract(at_s, 1.2, Intent::Open, f64::INFINITY),
            Act::Touch(channel) => self.touches.touch(at_s, channel),
            Act::Weight(newtons) => self.touches.weigh(at_s, newtons),
            Act::Close => self.wearer.contract(at_s, 5.0, Intent::Close, f64::INFINITY),
            Act::Open => self.wearer.contract(at_s, 5.0, Intent::Open, f64::INFINITY),
            Act::CutFilm => self.faults.cut_film(at_s),
            Act::LiftElectrode => self.envelopes.lift(0, at_s),
            Act::Grip | Act::PutDown | Act::Pull | Act::Wet | Act::Load => self.handle(at_s, act),
        }
    }

    fn trusts_line(&self) -> bool {
        self.trusts_line
    }

    fn button(&self) -> bool {
        self.script.button(self.now_s())
    }

    fn planned(&self) -> Option<MotorDrive> {
        if let Some(causal) = &self.causal {
            return self.closing_to(causal.target_n());
        }
        let (Some(plan), Task::Grasp { grasp, .. }) = (&self.plan, &self.task) else { return None };
        self.closing_to(plan.target_n(self.now_s(), grasp.stops_n()))
    }

    fn closing_to(&self, target_n: f64) -> Option<MotorDrive> {
        let Task::Grasp { grasp, .. } = &self.task else { return None };
        let touched = self.touch.normal_n > TOUCH_N;
        let spring = grasp.between_the_fingers().filter(|_| touched)?;
        self.gripper.closing_to(target_n, self.touch.normal_n, spring)
    }

    fn duration_s(&self) -> f64 {
        self.duration_s
    }
}
