//! Gentle grasp: close until the object is felt, and no further (FingerVision 2017, section II-A).

use tenax_hal_shim::behaviour::Ending;
use tenax_hal_shim::motor::Duty;

use super::{BehaviourConfig, Course, Felt, Movement, Skin, Wish};
use crate::grip::Grip;

/// Closes until half of the needed score, then by small movements with a wait after each, since a fragile
/// object gives way before a camera's next picture.
#[derive(Clone, Debug)]
pub struct GentleGrasp {
    skin: Option<Skin>,
    score: u16,
    touched: bool,
    movement: Movement,
}

impl GentleGrasp {
    pub fn begin(felt: &Felt<'_>) -> Option<Self> {
        let skin = Skin::now(felt);
        (skin.is_some() || felt.grip != Grip::Unknown).then_some(Self {
            skin,
            score: 0,
            touched: false,
            movement: Movement::default(),
        })
    }

    pub fn step(&mut self, config: &BehaviourConfig, felt: &Felt<'_>) -> Course {
        let score = match &self.skin {
            Some(_) if !felt.skin_is_new() => self.score,
            Some(skin) => match skin.score(felt) {
                Some(score) => score,
                None => return Course::Ends(Ending::SensorLost),
            },
            None => match felt.grip {
                Grip::Unknown => return Course::Ends(Ending::SensorLost),
                Grip::Unloaded => 0,
                Grip::Holds(_) => u16::MAX,
            },
        };
        if score > config.gentle_score || matches!(felt.grip, Grip::Holds(_)) {
            return Course::Ends(Ending::Done);
        }
        self.score = score;
        self.touched |= score > config.gentle_score / 2;
        if !self.touched {
            return Course::On(Wish::Tighten(Duty::per_mille(config.duty_permille)));
        }
        if self.movement.is_over() {
            self.movement = Movement::tighten(config);
        }
        Course::On(self.movement.step())
    }
}
