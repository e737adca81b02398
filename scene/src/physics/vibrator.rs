//! The motor that tells the wearer by vibrating: an eccentric mass on the socket, which the films hear through the hand.

use std::f64::consts::TAU;

use tenax_hal_shim::motor::Duty;

use crate::file::sections;
use crate::schedule::STEP_S;

/// The mass turns as fast as the duty says, one time constant later, and pulls outward with the square of its speed.
#[derive(Clone, Debug)]
pub(crate) struct Vibrator {
    parameters: sections::Vibrator,
    duty: f64,
    speed: f64,
    phase: f64,
}

impl Vibrator {
    pub(crate) fn new(parameters: &sections::Vibrator) -> Self {
        Self { parameters: parameters.clone(), duty: 0.0, speed: 0.0, phase: 0.0 }
    }

    pub(crate) fn drive(&mut self, duty: Duty) {
        self.duty = f64::from(duty.as_per_mille()) / 1e3;
    }

    pub(crate) fn step(&mut self) -> f64 {
        let p = &self.parameters;
        let spin_s = p.spin_ms.get() / 1e3;
        self.speed += (self.duty - self.speed) * (1.0 - libm::exp(-STEP_S / spin_s));
        self.phase = (self.phase + p.full_hz.get() * self.speed * STEP_S).fract();
        p.film_mv.get() * self.speed * self.speed * libm::sin(TAU * self.phase)
    }
}
