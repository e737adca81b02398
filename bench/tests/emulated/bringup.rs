//! Steps of bring-up on the emulated board, served: what is put in fails the step that looks for it, and no other. An answer is waited
//! for by this computer's time, so each runs by hand, on an idle machine.

use std::time::Duration;

use tenax_bench::board::emulated::{Mishap, Options};
use tenax_bench::hil::{Fitted, measure};
use tenax_bench::session::Board;
use tenax_hal_shim::channel::{COUNT, FSR, FSR_COUNT, MOTOR_CURRENT, STRAIN};
use tenax_hal_shim::motor::MotorDrive;
use tenax_scene::plant::{Pins, Plant};
use tenax_serial::guide::bringup::Asked;

use crate::served::{asked, failing, serve, serve_wire};
use crate::{Rest, Swing, image};

fn board(mishaps: &[(f64, Mishap)]) -> Board {
    let options = Options { mishaps: mishaps.to_vec(), ..Options::default() };
    Board::Emulated { image: image().to_owned(), options }
}

fn rest(lasts_s: f64) -> Rest {
    Rest::new(Swing::new(lasts_s))
}

fn lasting(seconds: u64) -> Asked {
    Asked { lasts: Some(Duration::from_secs(seconds)), ..asked() }
}

#[test]
#[ignore = "the emulated board at real time: needs an idle machine"]
fn a_start_after_a_reset_passes_and_one_after_the_watchdog_does_not() {
    let mishaps = [(3.0, Mishap::ResetByPin), (9.0, Mishap::CoreHangs)];
    serve(board(&mishaps), rest(16.0), |measure| {
        assert!(failing(&measure("power", lasting(3))).is_empty());
        assert_eq!(failing(&measure("power", lasting(3))), ["starts after a fault"]);
    });
}

#[test]
#[ignore = "the emulated board at real time: needs an idle machine"]
fn a_supply_that_sags_is_told_from_a_hang() {
    let mishaps = [(3.0, Mishap::BrownsOut), (5.0, Mishap::CoreHangs), (7.0, Mishap::ResetByPin)];
    serve(board(&mishaps), rest(10.0), |measure| {
        assert!(failing(&measure("sweep", asked())).is_empty());
        let worse = measure("sweep", Asked { times: Some(2), ..asked() });
        let all = [
            "starts after a sagging supply",
            "starts that forgot why: lowered too far, or too fast",
            "starts after another fault",
        ];
        assert_eq!(failing(&worse), all);
    });
}

#[test]
#[ignore = "the emulated board at real time: needs an idle machine"]
fn an_overrun_fails_timing_and_garbage_fails_the_line() {
    // From when the good ones have been measured, and then again and again.
    let garbage = || Mishap::Garbage(vec![7, 7, 7, 0, 9, 9, 0]);
    let mishaps: Vec<_> = (0..10)
        .map(|n| 30.0 + 3.0 * f64::from(n))
        .flat_map(|at_s| [(at_s, Mishap::DmaStalls), (at_s, garbage())])
        .collect();
    serve(board(&mishaps), rest(60.0), |measure| {
        for (step, lasts_s) in [("timing", 2), ("line", 2), ("clock", 8)] {
            assert!(failing(&measure(step, lasting(lasts_s))).is_empty(), "{step}");
        }
        let worse = measure("line", lasting(20));
        assert_eq!(failing(&worse), ["bad frames down the line", "frames lost", "overruns"]);
        assert_eq!(failing(&measure("timing", lasting(4))), ["frames lost", "overruns"]);
    });
}

/// A converter's noise, a code from frame to frame: an input that never moves is taken for stuck, and the line may not close a hand whose
/// force is unknown.
fn noise_v(scans: u32, input: usize) -> f64 {
    0.000_8 * f64::from((scans / 4 * 7 + input as u32) % 3)
}

/// A resistor in the place of the motor. After the first reset a bridge that is broken stays on.
struct Resistor {
    plant: Rest,
    pins: Pins,
    is_stuck: bool,
    scans: u32,
    reset_at_s: f64,
}

impl Plant for Resistor {
    fn within(&self) -> Option<&dyn Plant> {
        Some(&self.plant)
    }

    fn within_mut(&mut self) -> Option<&mut dyn Plant> {
        Some(&mut self.plant)
    }

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.pins = self.plant.scan(drive).clone();
        self.scans += 1;
        self.pins.0.iter_mut().enumerate().for_each(|(n, volts)| *volts += noise_v(self.scans, n));
        let is_stuck = self.is_stuck && f64::from(self.scans) / 8_000.0 > self.reset_at_s;
        if drive != MotorDrive::Coast || is_stuck {
            // 30 mA: what a motor that is blocked draws at this duty is 90, and half of it would be a stall.
            self.pins.0[MOTOR_CURRENT] += 0.072;
        }
        &self.pins
    }
}

#[test]
#[ignore = "the emulated board at real time: needs an idle machine"]
fn a_bridge_that_drives_after_a_reset_is_told() {
    for is_stuck in [false, true] {
        let reset_at_s = 8.0;
        let plant = Resistor { plant: rest(14.0), pins: Pins::default(), is_stuck, scans: 0, reset_at_s };
        serve(board(&[(reset_at_s, Mishap::ResetByPin)]), plant, |measure| {
            let figures = measure("outputs", asked());
            let expected: &[&str] = if is_stuck { &["1 of 1: current after a start"] } else { &[] };
            assert_eq!(failing(&figures), expected, "{figures:?}");
        });
    }
}

#[test]
#[ignore = "the emulated board at real time: needs an idle machine"]
fn power_cuts_while_a_setting_is_saved_forget_nothing_that_was_told() {
    // Each goes in the middle of the next record: in its first word, and in one after it.
    let mishaps = [0, 1, 2, 3, 1].map(|words| (0.0, Mishap::PowerFails { words }));
    serve(board(&mishaps), rest(60.0), |measure| {
        let figures = measure("cuts", Asked { times: Some(5), ..asked() });
        assert!(failing(&figures).is_empty(), "{figures:?}");
    });
}

/// The harness of `bringup/harness.rs`: each side of the bridge through 10 kohm and 1 uF to a film, and no sensor: else the reflex would
/// answer what the films then hear.
struct LoopBack {
    plant: Rest,
    pins: Pins,
    scans: u32,
    volts: [f64; 2],
    /// Of the second loop: what its resistor's divider leaves.
    part: f64,
}

impl Plant for LoopBack {
    fn within(&self) -> Option<&dyn Plant> {
        Some(&self.plant)
    }

    fn within_mut(&mut self) -> Option<&mut dyn Plant> {
        Some(&mut self.plant)
    }

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.plant.scan(drive);
        let permille = match drive {
            MotorDrive::Coast => [0, 0],
            MotorDrive::Close(duty) => [duty.as_per_mille(), 0],
            MotorDrive::Open(duty) => [0, duty.as_per_mille()],
        };
        for (n, volts) in self.volts.iter_mut().enumerate() {
            let driven_v = 3.3 * f64::from(permille[n]) / 1e3 * if n == 1 { self.part } else { 1.0 };
            // 125 us of 10 ms.
            *volts += (driven_v - *volts) * (1.0 - (-0.0125_f64).exp());
            self.pins.0[10 + n] = *volts;
        }
        self.scans += 1;
        (STRAIN..FSR + FSR_COUNT).for_each(|n| self.pins.0[n] = 0.206 + noise_v(self.scans, n));
        &self.pins
    }
}

#[test]
#[ignore = "the emulated board at real time: needs an idle machine"]
fn a_board_in_the_loop_is_measured_and_decides_as_the_host_does() {
    // The second loop has a resistor too many.
    let plant =
        LoopBack { plant: rest(60.0), pins: Pins([0.0; COUNT]), scans: 0, volts: [0.0; 2], part: 0.9 };
    // Long after the harness is done with.
    let resets = std::iter::once(30.0).chain((36..58).map(f64::from));
    let mishaps: Vec<_> = resets.map(|at_s| (at_s, Mishap::ResetByPin)).collect();
    let fitted = Fitted { lasts: Duration::from_secs(1), reset: Some("true".to_owned()), harness: true };
    let report = serve_wire(board(&mishaps), plant, |wire| {
        let say = &mut |text: &str| {
            println!("{text}");
            Ok(())
        };
        measure(wire, &fitted, say).unwrap()
    });
    let of = |name| report.part.iter().find(|part| part.name == name).map(|part| &part.figure[..]).unwrap();
    for name in ["timing", "line", "decisions", "resets"] {
        assert!(failing(of(name)).is_empty(), "{:?}", of(name));
    }
    assert_eq!(failing(of("harness")), ["opening: worst mean is off by"], "{:?}", of("harness"));
}
