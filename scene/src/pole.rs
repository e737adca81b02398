//! One resistor and one capacitor.

use crate::schedule::{FRAME_S, STEP_S};

/// First-order low-pass, stepped exactly for an input that is constant during a step. What it takes away from its input
/// is the high-pass of the same corner.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LowPass {
    part: f64,
    state: f64,
}

impl LowPass {
    pub(crate) fn with_tau_s(tau_s: f64) -> Self {
        Self::new(tau_s, STEP_S)
    }

    pub(crate) fn with_corner_hz(corner_hz: f64) -> Self {
        Self::with_tau_s(1.0 / (std::f64::consts::TAU * corner_hz))
    }

    pub(crate) fn of_frames(tau_s: f64) -> Self {
        Self::new(tau_s, FRAME_S)
    }

    fn new(tau_s: f64, step_s: f64) -> Self {
        Self { part: -libm::expm1(-step_s / tau_s), state: 0.0 }
    }

    pub(crate) fn step(&mut self, input: f64) -> f64 {
        self.state += self.part * (input - self.state);
        self.state
    }

    pub(crate) fn noise_gain(&self) -> f64 {
        (self.part / (2.0 - self.part)).sqrt()
    }
}
