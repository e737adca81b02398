//! The least that can close the loop around a scene, so that scenes are tested without the firmware's logic.

use tenax_hal_shim::channel::{CHANNELS, FSR, MYO_EXTENSOR, MYO_FLEXOR, SCAN_HZ};
use tenax_hal_shim::front_end::{FSR_EXPONENT, FSR_MV_AT_1N, FSR_REST_MV};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_hal_shim::wire::Down;
use tenax_scene::plant::{Pins, Plant};
use tenax_scene::{SceneFile, Truth, World, builtin};

/// A hand that grasps something, without name and title.
macro_rules! grasp {
    () => {
        r#"from = "assumed"
duration_s = 10
slip_floor_mm_s = 1
[contact]
mu_s = 0.5
mu_d = 0.4
pad_length_mm = 18
pitch_mm = 1
[object]
mass_kg = 0.2
width_mm = 60
stiffness_n_per_mm = 3
"#
    };
}
pub(crate) use grasp;

pub fn parsed(text: &str) -> SceneFile {
    SceneFile::parse(text, "scene").unwrap_or_else(|error| panic!("{error}"))
}

pub fn scene(name: &str) -> SceneFile {
    changed(name, &[])
}

/// A built-in scene in which each first text is replaced by the second.
pub fn changed(name: &str, changes: &[(&str, &str)]) -> SceneFile {
    let (_, text) = builtin().iter().find(|(builtin, _)| *builtin == name).expect("a built-in scene");
    let text = changes.iter().fold((*text).to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from} stands in {name}");
        text.replace(from, to)
    });
    parsed(&text)
}

/// Answers to Ft/Fn above 0.3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reflex {
    /// Only the wearer's muscles and the scene's commands drive.
    None,
    Ratio,
}

/// Drives as muscles, reflex and commands say.
struct Controller {
    reflex: Reflex,
    drive: MotorDrive,
    drive_until_s: f64,
    rests_until_s: f64,
}

impl Controller {
    fn close(&mut self, t_s: f64, drive: MotorDrive, for_s: f64) {
        (self.drive, self.drive_until_s) = (drive, t_s + for_s);
        self.rests_until_s = self.drive_until_s + 0.1;
    }

    fn step(&mut self, t_s: f64, pins: &Pins) -> MotorDrive {
        let active = |channel: usize| pins.0[channel] * 1e3 - f64::from(CHANNELS[channel].rest_mv) > 160.0;
        let muscles = match (active(MYO_FLEXOR), active(MYO_EXTENSOR)) {
            (false, false) => None,
            (true, false) => Some(MotorDrive::Close(Duty::per_mille(400))),
            (false, true) => Some(MotorDrive::Open(Duty::per_mille(800))),
            (true, true) => Some(MotorDrive::Coast),
        };
        if let Some(drive) = muscles {
            self.rests_until_s = t_s + 0.3;
            return drive;
        }
        if t_s < self.drive_until_s {
            return self.drive;
        }
        if self.reflex == Reflex::Ratio && t_s > self.rests_until_s && ratio(pins) > 0.3 {
            self.close(t_s, MotorDrive::Close(Duty::per_mille(400)), 0.015);
        }
        MotorDrive::Coast
    }
}

/// Ft/Fn of the force sensor; 0 while it is not loaded.
fn ratio(pins: &Pins) -> f64 {
    let [a, b, c, d] = [0, 1, 2, 3].map(|n| {
        let mv = pins.0[FSR + n] * 1e3 - f64::from(FSR_REST_MV);
        (mv.max(0.0) / FSR_MV_AT_1N).powf(1.0 / FSR_EXPONENT)
    });
    let fn_n = a + b + c + d;
    if fn_n > 0.6 { ((a + b) - (c + d)).abs() / fn_n } else { 0.0 }
}

/// Runs a scene to its end; `see` is told every scan.
pub fn run(scene: &SceneFile, reflex: Reflex, mut see: impl FnMut(&World, &Pins)) -> World {
    let mut world = World::new(scene, 1);
    let mut controller =
        Controller { reflex, drive: MotorDrive::Coast, drive_until_s: 0.0, rests_until_s: 0.5 };
    let mut drive = MotorDrive::Coast;
    for _ in 0..(scene.duration_s() * f64::from(SCAN_HZ)) as u64 {
        let pins = world.scan(drive).clone();
        drive = controller.step(world.now_s(), &pins);
        for command in world.commands() {
            if let Down::Drive { drive, hold_ms } = command {
                controller.close(world.now_s(), drive, f64::from(hold_ms) / 1e3);
            }
        }
        see(&world, &pins);
    }
    world
}

pub fn truth(scene: &SceneFile, reflex: Reflex) -> Truth {
    run(scene, reflex, |_, _| {}).truth().clone()
}
