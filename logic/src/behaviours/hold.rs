//! Holding: close a little whenever the object slips (FingerVision 2017, section II-B).
//!
//! What the detectors report the reflex answers already. This adds what only a camera sees, an object so light that its slip
//! makes no sound and its weight no force; and without a camera, slip at a force below which the reflex rests.
//!
//! What goes on to slip however far the fingers come is no slip, but a camera that sees motion for ever.

use super::{BehaviourConfig, Course, Felt, Movement};
use crate::grip::Grip;
use tenax_hal_shim::channel::frames;

/// How far the fingers come for one slip, in frames of closing.
const ANSWER_FRAMES_MAX: u32 = frames(500);
/// A slip is over when nothing has slipped for this long, in frames.
const STILL_FRAMES: u32 = frames(200);

/// Small movements, one after the other while the object slips.
#[derive(Clone, Debug, Default)]
pub struct Hold {
    movement: Movement,
    /// Frames of closing since nothing slipped last.
    answered: u32,
    still: u32,
}

impl Hold {
    pub fn step(&mut self, config: &BehaviourConfig, felt: &Felt<'_>) -> Course {
        let slips = match felt.view {
            Some(_) => felt.is_moving(config.moving_e4, false),
            None => felt.slips && !matches!(felt.grip, Grip::Holds(_)),
        };
        self.still = if slips { 0 } else { self.still.saturating_add(1) };
        if self.still >= STILL_FRAMES {
            self.answered = 0;
        }
        if slips && !self.movement.drives() && self.answered < ANSWER_FRAMES_MAX {
            self.movement = Movement::tighten(config);
        }
        self.answered += u32::from(self.movement.drives());
        Course::On(self.movement.step())
    }
}
