//! A whole world: everything that moves, everything that senses, and the line over which somebody types.

use tenax_hal_shim::channel::{COUNT, FSR, FSR_COUNT, MYO_FLEXOR, OPENING, PVDF, PVDF_COUNT, SCAN_HZ};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::Down;

use crate::commands::Script;
use crate::file::SceneFile;
use crate::physics::Touch;
use crate::physics::friction::Surface;
use crate::physics::grasp::Grasp;
use crate::physics::gripper::Gripper;
use crate::physics::hand::Hand;
use crate::physics::stroke::Stroke;
use crate::physics::wearer::Wearer;
use crate::plant::{Pins, Plant};
use crate::schedule::STEP_S;
use crate::sensor::converter::Converter;
use crate::sensor::fault::Faults;
use crate::sensor::fsr::Quadrants;
use crate::sensor::hand;
use crate::sensor::myo::{Envelopes, SIDES};
use crate::sensor::pvdf::Films;
use crate::truth::{self, State, TRACE_HZ, Truth};

/// Scans between two rows of the trace.
const TRACE_EVERY: u64 = (SCAN_HZ / TRACE_HZ) as u64;

/// A scene that runs.
#[derive(Debug)]
pub struct World {
    scans: u64,
    duration_s: f64,
    floor_mm_s: f64,
    wearer: Wearer,
    gripper: Gripper,
    task: Task,
    touch: Touch,
    films: Films,
    quadrants: Quadrants,
    envelopes: Envelopes,
    faults: Faults,
    converter: Converter,
    script: Script,
    pins: Pins,
    truth: Truth,
}

/// What the fingertip is busy with.
#[derive(Clone, Debug)]
enum Task {
    /// An object between the fingers, carried by the wearer's arm.
    Grasp { grasp: Grasp, hand: Hand },
    /// A surface, stroked by a robot.
    Stroke(Stroke),
}

impl World {
    /// The scene at its beginning. The seed decides all noise and how the films came out in the making.
    #[must_use]
    pub fn new(scene: &SceneFile, seed: u64) -> Self {
        let surface = Surface::new(&scene.contact, &scene.wet);
        let task = match &scene.object {
            Some(object) => Task::Grasp {
                grasp: Grasp::new(
                    object.get_ref(),
                    &scene.fill,
                    &scene.table,
                    surface,
                    scene.contact.pad_length_mm.get(),
                ),
                hand: Hand::new(&scene.moves, &scene.swing),
            },
            None => {
                let robot = scene.robot.as_ref().map(|robot| robot.get_ref().clone()).unwrap_or_default();
                Task::Stroke(Stroke::new(&robot, &scene.press, &scene.sweep, surface))
            }
        };
        Self {
            scans: 0,
            duration_s: scene.duration_s(),
            floor_mm_s: scene.slip_floor_mm_s(),
            wearer: Wearer::new(&scene.muscle),
            gripper: Gripper::new(&scene.gripper),
            task,
            touch: Touch::default(),
            films: Films::new(&scene.pvdf, &scene.knock, scene.contact.pitch_mm.get(), seed),
            quadrants: Quadrants::new(&scene.fsr),
            envelopes: Envelopes::new(&scene.myo, &scene.electrode_lift, scene.pvdf.mains_hz.get(), seed),
            faults: Faults::new(&scene.fault),
            converter: Converter::new(seed),
            script: Script::new(&scene.command),
            pins: Pins::default(),
            truth: Truth::default(),
        }
    }

    /// What really happened so far.
    #[must_use]
    pub const fn truth(&self) -> &Truth {
        &self.truth
    }

    /// How much of it is over, s.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        self.scans as f64 * STEP_S
    }

    /// Moves everything that moves.
    fn moves(&mut self, t_s: f64, drive: MotorDrive) -> State {
        self.gripper.step(drive, self.touch.normal_n);
        match &mut self.task {
            Task::Grasp { grasp, hand } => {
                let grip_n = grasp
                    .between_the_fingers()
                    .map_or(0.0, |(width_mm, stiffness)| self.gripper.grip_n(width_mm, stiffness));
                hand.step(t_s, grasp.table_part());
                self.touch = grasp.step(t_s, hand, grip_n);
                let carried = grasp.is_held();
                State {
                    carried,
                    dropped: grasp.is_dropped(),
                    needed_n: if carried { grasp.needed_n() } else { 0.0 },
                    mass_kg: grasp.mass_kg(),
                    position_mm: grasp.height_m(hand) * 1e3,
                }
            }
            Task::Stroke(stroke) => {
                self.touch = stroke.step(t_s);
                State {
                    carried: true,
                    dropped: false,
                    needed_n: 0.0,
                    mass_kg: 0.0,
                    position_mm: stroke.probe_m() * 1e3,
                }
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
        self.truth.step(&truth::Step {
            t_s,
            touch: &self.touch,
            state,
            floor_mm_s: self.floor_mm_s,
            opens: self.gripper.speed_mm_s() > 0.0,
            trace: self.scans.is_multiple_of(TRACE_EVERY),
        });

        let mut pins_v = Pins::default().0;
        pins_v[PVDF..PVDF + PVDF_COUNT].copy_from_slice(&self.films.step(
            t_s,
            &self.touch,
            self.gripper.speed_part(),
        ));
        pins_v[FSR..FSR + FSR_COUNT]
            .copy_from_slice(&self.quadrants.step(&self.touch, self.faults.pressed_n(t_s)));
        pins_v[MYO_FLEXOR..MYO_FLEXOR + SIDES].copy_from_slice(&self.envelopes.step(t_s, &effort));
        pins_v[OPENING..COUNT].copy_from_slice(&hand::pins_v(&self.gripper));
        self.truth.wearer(t_s, effort.intent, &pins_v);
        self.converter.step(&mut pins_v);
        self.faults.apply(t_s, &mut pins_v);
        self.pins = Pins(pins_v);
        &self.pins
    }

    fn commands(&mut self) -> Vec<Down> {
        self.script.take(self.now_s())
    }

    fn slipping(&self) -> bool {
        self.truth.slipping(&self.touch, self.floor_mm_s)
    }

    fn duration_s(&self) -> f64 {
        self.duration_s
    }
}
