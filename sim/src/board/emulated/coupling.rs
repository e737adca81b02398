//! The bridge's edges in the films' codes: ground and reference jump for an instant, and an edge shortly before a film's sampling ends
//! is converted with it.

use tenax_hal_shim::channel::{CODE_MAX, PVDF_COUNT};
use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::motor::{Duty, MotorDrive};

/// From one film's sampling to the next, 56 and 12 cycles at 25 MHz, and how long it lasts, us.
const RANK_US: f64 = 2.72;
const SAMPLED_US: f64 = 2.24;
/// The bridge's period, us.
const PERIOD_US: f64 = 50.0;

#[derive(Clone, Copy, Debug)]
pub struct Coupling {
    /// What an edge is worth at once, codes; a falling one as much the other way.
    pub codes: f64,
    /// How soon that is gone, us.
    pub gone_us: f64,
    /// How much later than the image places them periods begin, us.
    pub late_us: f64,
}

impl Coupling {
    pub fn add(&self, scan: &mut Scan, drive: MotorDrive, begins_us: f64) {
        let (MotorDrive::Close(duty) | MotorDrive::Open(duty)) = drive else { return };
        // Driven all the time, it has no edges.
        if duty == Duty::FULL {
            return;
        }
        // The side that is not driven is high for the rest of the duty, and comes first.
        let begins_us = begins_us + self.late_us;
        let falls_us = begins_us + PERIOD_US * (1.0 - f64::from(duty.as_per_mille()) / 1e3);
        for (rank, code) in scan.iter_mut().take(PVDF_COUNT).enumerate() {
            let ends_us = RANK_US * rank as f64 + SAMPLED_US;
            let left = |edge_us: f64| (-(ends_us - edge_us).rem_euclid(PERIOD_US) / self.gone_us).exp();
            let more = self.codes * (left(begins_us) - left(falls_us));
            *code = (f64::from(*code) + more).round().clamp(0.0, f64::from(CODE_MAX)) as u16;
        }
    }
}
