//! The least that can close the loop around a scene, so that scenes are tested without the firmware's logic.
#![allow(dead_code, reason = "every test file takes what it needs")]

use std::f64::consts::TAU;

use tenax_hal_shim::channel::{
    CHANNELS, FSR, MYO_EXTENSOR, MYO_FLEXOR, PVDF_COUNT, SCAN_HZ, SCANS_PER_FRAME,
};
use tenax_hal_shim::front_end::{FSR_EXPONENT, FSR_MV_AT_1N, FSR_REST_MV};
use tenax_hal_shim::motor::{Duty, MotorDrive};
use tenax_scene::plant::{Pins, Plant};
use tenax_scene::{SceneFile, World, builtin};

/// The built-in scene of this name.
pub fn scene(name: &str) -> SceneFile {
    let (_, text) = builtin().iter().find(|(builtin, _)| *builtin == name).expect("a built-in scene");
    SceneFile::parse(text, name).unwrap_or_else(|error| panic!("{error}"))
}

/// S1's envelope, written down once more in floating point: 20 to 150 Hz, mean absolute, 8 ms, the loudest film, mV.
#[derive(Clone, Debug, Default)]
pub struct Envelope {
    sums: [f64; PVDF_COUNT],
    low: [f64; PVDF_COUNT],
    base: [f64; PVDF_COUNT],
    mean: [f64; PVDF_COUNT],
    scans: usize,
    warm: bool,
    pub mv: f64,
}

impl Envelope {
    /// Takes one scan; true when it ends a frame and `mv` is new.
    pub fn take(&mut self, pins: &Pins) -> bool {
        for (sum, pin) in self.sums.iter_mut().zip(pins.0) {
            *sum += pin * 1e3 / SCANS_PER_FRAME as f64;
        }
        self.scans += 1;
        if !self.scans.is_multiple_of(SCANS_PER_FRAME) {
            return false;
        }
        let frame_hz = f64::from(SCAN_HZ) / SCANS_PER_FRAME as f64;
        let part = |hz: f64| 1.0 - (-TAU * hz / frame_hz).exp();
        for film in 0..PVDF_COUNT {
            let mv = std::mem::take(&mut self.sums[film]);
            if !self.warm {
                (self.low[film], self.base[film]) = (mv, mv);
            }
            self.low[film] += part(150.0) * (mv - self.low[film]);
            self.base[film] += part(20.0) * (self.low[film] - self.base[film]);
            let band = (self.low[film] - self.base[film]).abs();
            self.mean[film] += part(1.0 / (TAU * 0.008)) * (band - self.mean[film]);
        }
        self.warm = true;
        self.mv = self.mean.iter().copied().fold(0.0, f64::max);
        true
    }
}

/// What answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reflex {
    /// Nobody: only the wearer's muscles drive.
    None,
    /// A short gentle close whenever Ft/Fn passes 0.3.
    Ratio,
    /// That, and a full close for 60 ms whenever the envelope passes 100 mV.
    RatioAndVibration,
}

/// A controller of a dozen lines.
#[derive(Clone, Debug)]
pub struct Controller {
    reflex: Reflex,
    pub envelope: Envelope,
    closes: MotorDrive,
    closes_until_s: f64,
    rests_until_s: f64,
}

impl Controller {
    pub fn new(reflex: Reflex) -> Self {
        Self {
            reflex,
            envelope: Envelope::default(),
            closes: MotorDrive::Coast,
            closes_until_s: 0.0,
            rests_until_s: 0.5,
        }
    }

    pub fn step(&mut self, t_s: f64, pins: &Pins) -> MotorDrive {
        self.envelope.take(pins);
        let above_mv = |channel: usize| pins.0[channel] * 1e3 - f64::from(CHANNELS[channel].rest_mv);
        let active = |channel: usize| above_mv(channel) > 160.0;
        match (active(MYO_FLEXOR), active(MYO_EXTENSOR)) {
            (false, false) => {}
            (flexor, extensor) => {
                self.rests_until_s = t_s + 0.3;
                return match (flexor, extensor) {
                    (true, false) => MotorDrive::Close(Duty::per_mille(400)),
                    (false, true) => MotorDrive::Open(Duty::per_mille(800)),
                    _ => MotorDrive::Coast,
                };
            }
        }
        if t_s < self.closes_until_s {
            return self.closes;
        }
        if t_s > self.rests_until_s {
            let ratio = self.reflex != Reflex::None && ratio(pins) > 0.3;
            if self.reflex == Reflex::RatioAndVibration && self.envelope.mv > 100.0 {
                self.closes = MotorDrive::Close(Duty::FULL);
                self.closes_until_s = t_s + 0.06;
            } else if ratio {
                self.closes = MotorDrive::Close(Duty::per_mille(400));
                self.closes_until_s = t_s + 0.015;
            } else {
                return MotorDrive::Coast;
            }
            self.rests_until_s = self.closes_until_s + 0.1;
        }
        MotorDrive::Coast
    }
}

/// Ft/Fn of the force sensor; 0 while it is not loaded.
fn ratio(pins: &Pins) -> f64 {
    let newtons = |n: usize| {
        let mv = pins.0[FSR + n] * 1e3 - f64::from(FSR_REST_MV);
        (mv.max(0.0) / FSR_MV_AT_1N).powf(1.0 / FSR_EXPONENT)
    };
    let [a, b, c, d] = [newtons(0), newtons(1), newtons(2), newtons(3)];
    let fn_n = a + b + c + d;
    if fn_n > 0.6 { ((a + b) - (c + d)).abs() / fn_n } else { 0.0 }
}

/// Runs a scene to its end; `see` is told every scan.
pub fn run(scene: &SceneFile, seed: u64, reflex: Reflex, mut see: impl FnMut(&World, &Pins, f64)) -> World {
    let mut world = World::new(scene, seed);
    let mut controller = Controller::new(reflex);
    let mut drive = MotorDrive::Coast;
    for _ in 0..(scene.duration_s() * f64::from(SCAN_HZ)) as u64 {
        let pins = world.scan(drive).clone();
        drive = controller.step(world.now_s(), &pins);
        see(&world, &pins, controller.envelope.mv);
    }
    world
}
