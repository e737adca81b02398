//! Holding: close a little whenever the object slips (FingerVision 2017, section II-B).
//!
//! What the detectors report the reflex answers already. This adds what only a camera sees, an object so light that its slip
//! makes no sound and its weight no force; and without a camera, slip at a force below which the reflex rests.

use super::{BehaviourConfig, Course, Felt, Movement};
use crate::grip::Grip;

/// Small movements, one after the other while the object slips.
#[derive(Clone, Debug, Default)]
pub struct Hold {
    movement: Movement,
}

impl Hold {
    pub fn step(&mut self, config: &BehaviourConfig, felt: &Felt<'_>) -> Course {
        let slips = match felt.view {
            Some(_) => felt.is_moving(config.moving_e4, false),
            None => felt.slips && !matches!(felt.grip, Grip::Holds(_)),
        };
        if slips && !self.movement.drives() {
            self.movement = Movement::tighten(config);
        }
        Course::On(self.movement.step())
    }
}
