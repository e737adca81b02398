//! Steps of bring-up on the host's board, served: each passes on a good board, and fails with the fault that it looks for.

#[path = "common/served.rs"]
mod served;

use std::thread;
use std::time::Duration;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use served::{asked, failing, serve};
use tenax_bench::session::Board;
use tenax_hal_shim::channel::{COUNT, MOTOR_CURRENT, SCAN_HZ, STRAIN, by_name};
use tenax_hal_shim::motor::MotorDrive;
use tenax_scene::plant::{Pins, Plant};
use tenax_serial::guide::bringup::Asked;

/// Pins that a closure sets in every scan: its time, s, and how the motor is driven.
struct Bench<F> {
    pins: Pins,
    set: F,
    scans: u32,
    /// Drawn once: a draw of each pin in each scan is too slow for a board at real time.
    noise_v: Vec<f64>,
}

/// Numbers of noise, which pins and scans come round in at different places.
const DRAWN: usize = 9_973;

impl<F> Bench<F> {
    fn new(noise_v: f64, set: F) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        // The sum of four even ones is nearly normal.
        let mut draw = || (0..4).map(|_| random.random_range(-1.0..1.0)).sum::<f64>() * 0.75_f64.sqrt();
        let noise_v = (0..DRAWN).map(|_| noise_v * draw()).collect();
        Self { pins: Pins::default(), set, scans: 0, noise_v }
    }
}

impl<F: FnMut(f64, MotorDrive, &mut [f64; COUNT]) + Send> Plant for Bench<F> {
    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.scans += 1;
        let rest = Pins::default();
        self.pins = rest;
        (self.set)(f64::from(self.scans) / f64::from(SCAN_HZ), drive, &mut self.pins.0);
        let first = self.scans as usize * COUNT;
        for (n, volts) in self.pins.0.iter_mut().enumerate() {
            *volts += self.noise_v[(first + n) % DRAWN];
        }
        &self.pins
    }

    fn trusts_line(&self) -> bool {
        true
    }

    fn duration_s(&self) -> f64 {
        20.0
    }
}

/// One code, V.
const CODE_V: f64 = 3.3 / 4_096.0;

/// What of a step fails on such a board.
fn fails(
    step: &str,
    asked: Asked,
    set: impl FnMut(f64, MotorDrive, &mut [f64; COUNT]) + Send + 'static,
) -> Vec<String> {
    let bench = Bench::new(CODE_V, set);
    serve(Board::Host, bench, |measure| {
        failing(&measure(step, asked)).iter().map(|name| (*name).to_owned()).collect()
    })
}

fn held(pins: &mut [f64; COUNT]) {
    pins.fill(1.65);
}

#[test]
fn noise_and_offset_are_told_of_the_input_that_has_them() {
    assert!(fails("noise", asked(), |_, _, pins| held(pins)).is_empty());
    let worse = fails("noise", asked(), |t_s, _, pins| {
        held(pins);
        // A frame's four scans alike, or they would cancel.
        let sign = if ((t_s * 2_000.0) as u32).is_multiple_of(2) { 1.0 } else { -1.0 };
        pins[3] += 0.002 * sign;
        pins[STRAIN + 2] -= 0.03;
    });
    assert_eq!(worse, ["worst noise, pvdf_4", "farthest from 1650 mV, strain_3"]);
}

/// From the third second on, every second the next of these is off and on again.
fn off(order: &[usize], t_s: f64) -> Option<(usize, f64)> {
    let n = (t_s - 3.0).max(-1.0);
    (n >= 0.0)
        .then(|| order.get(n as usize).map(|&wire| (wire, n.fract())))
        .flatten()
        .filter(|own| own.1 < 0.8)
}

#[test]
fn wires_that_are_taken_off_are_noticed_and_those_that_say_nothing_are_named() {
    let order = ["strain_3", "fsr_b", "array_9", "myo_flexor"].map(|name| by_name(name).unwrap());
    let some =
        |lasts_s| Asked { channels: order.to_vec(), lasts: Some(Duration::from_secs(lasts_s)), ..asked() };
    // 105 kohm and 1 uF, as docs/hardware.md has it.
    let good = move |t_s: f64, _: MotorDrive, pins: &mut [f64; COUNT]| {
        if let Some((wire, since_s)) = off(&order, t_s) {
            pins[wire] *= (-since_s / 0.105_f64).exp();
        }
    };
    assert!(fails("wires", some(15), good).is_empty());
    let bad = move |t_s: f64, _: MotorDrive, pins: &mut [f64; COUNT]| match off(&order, t_s) {
        // A switch's open input keeps its neighbour's charge.
        Some((wire, _)) if wire == order[1] => pins[wire] = pins[wire - 1],
        Some((wire, since_s)) => {
            pins[wire] *= (-since_s / 0.105_f64).exp();
            if wire == order[2] {
                pins[wire - 1] -= 0.012;
            }
        }
        None => {}
    };
    let worse = fails("wires", some(12), bad);
    assert_eq!(worse, ["wires whose cut was noticed", "array_8 moves when array_9 is off"]);
}

fn drawn_v(drive: MotorDrive, a: f64) -> f64 {
    match drive {
        MotorDrive::Coast => 0.0,
        MotorDrive::Close(duty) | MotorDrive::Open(duty) => 2.4 * a * f64::from(duty.as_per_mille()) / 1e3,
    }
}

#[test]
fn a_side_of_the_bridge_that_does_not_drive_is_told() {
    let without = Asked { times: Some(0), ..asked() };
    let good = |_, drive, pins: &mut [f64; COUNT]| pins[MOTOR_CURRENT] += drawn_v(drive, 0.1);
    assert!(fails("outputs", without.clone(), good).is_empty());
    let bad = |_, drive: MotorDrive, pins: &mut [f64; COUNT]| {
        pins[MOTOR_CURRENT] += if drive.opens() { 0.0 } else { drawn_v(drive, 0.1) };
    };
    assert_eq!(fails("outputs", without, bad), ["opening draws", "they differ by"]);
}

#[test]
fn films_that_hear_the_motor_are_told() {
    let hears = |mv: f64| {
        move |t_s: f64, drive: MotorDrive, pins: &mut [f64; COUNT]| {
            // The bridge's supply hums at 300 Hz while it drives.
            if drive != MotorDrive::Coast {
                pins[7] += mv / 1e3 * (std::f64::consts::TAU * 300.0 * t_s).sin();
            }
        }
    };
    assert!(fails("interference", asked(), hears(10.0)).is_empty());
    let worse = fails("interference", asked(), hears(300.0));
    assert_eq!(worse.len(), 4, "{worse:?}");
    assert!(worse.iter().all(|name| name.ends_with("films' envelope, of S1")), "{worse:?}");
}

#[test]
fn a_clock_that_is_a_third_slow_is_told() {
    let slow = |_, _, _: &mut [f64; COUNT]| thread::sleep(Duration::from_micros(200));
    let long = Asked { lasts: Some(Duration::from_secs(4)), ..asked() };
    // The control is in `time.rs`, whose clocks no busy machine slows down.
    assert_eq!(fails("clock", long, slow), ["board's clock beside this computer's"]);
}
