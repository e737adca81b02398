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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::quantity::{Hertz, Milliseconds, Millivolts};

    #[test]
    fn it_spins_up_to_its_amplitude_and_frequency_and_rings_down() {
        let mut motor = Vibrator::new(&sections::Vibrator {
            film_mv: Millivolts::of(8.0),
            full_hz: Hertz::of(200.0),
            spin_ms: Milliseconds::of(40.0),
        });
        let heard = |motor: &mut Vibrator, ms| -> Vec<f64> { (0..8 * ms).map(|_| motor.step()).collect() };
        assert!(heard(&mut motor, 100).iter().all(|mv| *mv == 0.0));
        motor.drive(Duty::FULL);
        heard(&mut motor, 400);
        let second = heard(&mut motor, 1_000);
        let peak = |mv: &[f64]| mv.iter().fold(0.0_f64, |peak, mv| peak.max(mv.abs()));
        let turns = second.windows(2).filter(|two| two[0] < 0.0 && two[1] >= 0.0).count();
        assert!((peak(&second) - 8.0).abs() < 0.1 && turns.abs_diff(200) <= 1, "{turns}");
        motor.drive(Duty::default());
        let rings = heard(&mut motor, 60);
        // After 40 ms the speed is 1/e, and the force its square.
        let ratio = peak(&rings[8 * 40..8 * 60]) / 8.0;
        assert!((0.04..=0.14).contains(&ratio), "{ratio}");
    }
}
