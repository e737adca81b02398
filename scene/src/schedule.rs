//! Time, and things that happen for a while.

use tenax_hal_shim::channel::{FRAME_HZ, SCAN_HZ};

use crate::file::quantity::{Duration, Instant};

pub(crate) const STEP_S: f64 = 1.0 / SCAN_HZ as f64;

pub(crate) const FRAME_S: f64 = 1.0 / FRAME_HZ as f64;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    pub(crate) begin_s: f64,
    pub(crate) end_s: f64,
}

impl Span {
    pub(crate) fn of(at_s: Instant, for_s: Duration) -> Self {
        Self::new(at_s.get(), for_s.get())
    }

    pub(crate) const fn new(begin_s: f64, for_s: f64) -> Self {
        Self { begin_s, end_s: begin_s + for_s }
    }

    pub(crate) fn contains(&self, t_s: f64) -> bool {
        (self.begin_s..self.end_s).contains(&t_s)
    }

    pub(crate) fn progress(&self, t_s: f64) -> f64 {
        if t_s >= self.end_s {
            return 1.0;
        }
        ((t_s - self.begin_s) / (self.end_s - self.begin_s)).clamp(0.0, 1.0)
    }
}

/// From 0 to 1 without a jerk at either end: 3 p^2 - 2 p^3.
pub(crate) fn smooth(progress: f64) -> f64 {
    progress * progress * (3.0 - 2.0 * progress)
}

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
