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
