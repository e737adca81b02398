//! Sensors: from the world to volts at the pins.

pub(crate) mod array;
pub mod camera;
pub(crate) mod converter;
pub(crate) mod fault;
pub(crate) mod fsr;
pub(crate) mod myo;
pub mod photoelastic;
mod place;
pub(crate) mod pvdf;
pub(crate) mod skin;
pub(crate) mod strain;

use tenax_hal_shim::channel::{CHANNELS, MOTOR_CURRENT, OPENING};
use tenax_hal_shim::front_end::MOTOR_MV_PER_A;

use crate::physics::gripper::Gripper;

const CLIP_V: std::ops::RangeInclusive<f64> = 0.05..=3.2;

pub(crate) fn front_end_v(mv: f64) -> f64 {
    (mv / 1e3).clamp(*CLIP_V.start(), *CLIP_V.end())
}

/// Potentiometer on the finger's axle: rest at closed, this much more when open, mV (assumed).
const OPENING_SPAN_MV: f64 = 2_400.0;
/// Stall current at the whole supply, A (assumed: `motor-stall-ma`).
const STALL_A: f64 = 1.0;

/// The hand's own sensors: the fingers' opening and the motor's current.
pub(crate) fn hand_v(gripper: &Gripper) -> [f64; 2] {
    let at = |channel: usize, mv: f64| front_end_v(f64::from(CHANNELS[channel].rest_mv) + mv);
    [
        at(OPENING, OPENING_SPAN_MV * gripper.opening_part()),
        at(MOTOR_CURRENT, f64::from(MOTOR_MV_PER_A) * STALL_A * gripper.current_part),
    ]
}
