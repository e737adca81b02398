//! What the bridge's edges leave in the films' codes: as the motor's current is switched, ground and reference jump for an instant, and
//! an edge shortly before a film's sampling ends is converted with it.

use tenax_hal_shim::channel::{CODE_MAX, PVDF_COUNT, SCAN_HZ};
use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::motor::{Duty, MotorDrive};

/// From one film's sampling to the next, 56 and 12 cycles at 25 MHz, and how long it lasts, us.
const RANK_US: f64 = 2.72;
const SAMPLED_US: f64 = 2.24;
/// From one scan to the next, and the bridge's period, us.
const SCAN_US: f64 = 1e6 / SCAN_HZ as f64;
const PERIOD_US: f64 = 50.0;
/// Ticks of the bridge's timer in a us.
const TICKS: f64 = 100.0;

/// An edge's effect, and when edges come.
#[derive(Clone, Copy, Debug)]
pub struct Coupling {
    /// What an edge is worth at once, codes; a falling one as much the other way.
    pub codes: f64,
    /// How soon that is gone, us.
    pub gone_us: f64,
    /// When a period begins after the first scan's trigger, us. None: as the image has set the counter of the bridge's timer.
    pub begins_us: Option<f64>,
}

impl Coupling {
    /// When a period begins after trigger number `nth`, from 1 on, us, if the bridge's timer stood at `count` when the scans' started.
    pub fn begins_us(&self, count: u32, nth: u64) -> f64 {
        let by_count_us = -SCAN_US - f64::from(count) / TICKS;
        let first_us = self.begins_us.unwrap_or(by_count_us);
        (first_us - nth.saturating_sub(1) as f64 * SCAN_US).rem_euclid(PERIOD_US)
    }

    /// Adds what the edges leave to a scan's films.
    pub fn add(&self, scan: &mut Scan, drive: MotorDrive, begins_us: f64) {
        let (MotorDrive::Close(duty) | MotorDrive::Open(duty)) = drive else { return };
        // Driven all the time, it has no edges.
        if duty == Duty::FULL {
            return;
        }
        let falls_us = begins_us + PERIOD_US * f64::from(duty.as_per_mille()) / 1e3;
        for (rank, code) in scan.iter_mut().take(PVDF_COUNT).enumerate() {
            let ends_us = RANK_US * rank as f64 + SAMPLED_US;
            let left = |edge_us: f64| (-(ends_us - edge_us).rem_euclid(PERIOD_US) / self.gone_us).exp();
            let more = self.codes * (left(begins_us) - left(falls_us));
            *code = (f64::from(*code) + more).round().clamp(0.0, f64::from(CODE_MAX)) as u16;
        }
    }
}
