//! What the hand knows of itself: the fingers' opening and the motor's current.

use tenax_hal_shim::channel::{CHANNELS, MOTOR_CURRENT, OPENING};

use super::front_end_v;
use crate::physics::gripper::Gripper;

/// Potentiometer on the finger's axle: rest at closed, this much more when open, mV (assumed).
const OPENING_SPAN_MV: f64 = 2_400.0;
/// Shunt amplifier: this much for the stall current at the whole supply, mV (assumed).
const CURRENT_SPAN_MV: f64 = 2_400.0;

/// Voltages at the pins of opening and motor current.
pub(crate) fn pins_v(gripper: &Gripper) -> [f64; 2] {
    let at = |channel: usize, mv: f64| front_end_v(f64::from(CHANNELS[channel].rest_mv) + mv);
    [
        at(OPENING, OPENING_SPAN_MV * gripper.opening_part()),
        at(MOTOR_CURRENT, CURRENT_SPAN_MV * gripper.current_part()),
    ]
}
