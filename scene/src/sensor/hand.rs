//! The hand's own sensors: the fingers' opening and the motor's current.

use tenax_hal_shim::channel::{CHANNELS, MOTOR_CURRENT, OPENING};
use tenax_hal_shim::front_end::MOTOR_MV_PER_A;

use super::front_end_v;
use crate::physics::gripper::Gripper;

/// Potentiometer on the finger's axle: rest at closed, this much more when open, mV (assumed).
const OPENING_SPAN_MV: f64 = 2_400.0;
/// Stall current at the whole supply, A (assumed: `motor-stall-ma`).
const STALL_A: f64 = 1.0;

pub(crate) fn pins_v(gripper: &Gripper) -> [f64; 2] {
    let at = |channel: usize, mv: f64| front_end_v(f64::from(CHANNELS[channel].rest_mv) + mv);
    [
        at(OPENING, OPENING_SPAN_MV * gripper.opening_part()),
        at(MOTOR_CURRENT, f64::from(MOTOR_MV_PER_A) * STALL_A * gripper.current_part),
    ]
}
