//! Hand-over: opens when the object is pulled (FingerVision 2017, section II-C). Slip counts only with a
//! changed force on the skin, so that a broken sensor lets go of nothing.

use tenax_hal_shim::behaviour::Ending;
use tenax_hal_shim::motor::Duty;

use super::{BehaviourConfig, Course, Felt, Skin, Wish};
use crate::grip::Grip;
use tenax_hal_shim::channel::frames;

const OPEN_FRAMES: u32 = frames(400);
/// Least duration of a pull: three pictures, or four readings of the taxels. An impact is shorter.
const STAYS_FRAMES: u32 = frames(50);
const BEGINS_FRAMES: u32 = frames(200);

#[derive(Clone, Debug)]
pub struct HandOver {
    skin: Skin,
    changed: u16,
    pulled: bool,
    waited: u32,
    changed_for: u32,
    slips_for: u32,
    opened: u32,
}

impl HandOver {
    pub fn begin(felt: &Felt<'_>) -> Option<Self> {
        if felt.grip == Grip::Unknown {
            return None;
        }
        Some(Self {
            skin: Skin::now(felt)?,
            changed: 0,
            pulled: false,
            waited: 0,
            changed_for: 0,
            slips_for: 0,
            opened: 0,
        })
    }

    pub fn step(&mut self, config: &BehaviourConfig, felt: &Felt<'_>) -> Course {
        if self.opened > 0 {
            self.opened += 1;
            return if self.opened > OPEN_FRAMES {
                Course::Ends(Ending::Done)
            } else {
                Course::On(Wish::Relax(Duty::FULL))
            };
        }
        if felt.grip == Grip::Unknown {
            return Course::Ends(Ending::SensorLost);
        }
        if felt.skin_is_new() {
            let Some(changed) = self.skin.changed(felt) else { return Course::Ends(Ending::SensorLost) };
            self.changed = changed;
            self.pulled = self.skin.is_pulled(felt);
        }
        let changed = self.changed;
        let slips = (felt.slips || felt.is_moving(config.moving_e4, false)) && (changed > 0 || self.pulled);
        self.waited = self.waited.saturating_add(1);
        self.changed_for = if changed > config.changed_cells { self.changed_for + 1 } else { 0 };
        self.slips_for = if slips { self.slips_for + 1 } else { 0 };
        if self.waited >= BEGINS_FRAMES
            && (self.changed_for >= STAYS_FRAMES || self.slips_for >= STAYS_FRAMES)
        {
            self.opened = 1;
        }
        Course::On(Wish::Rest)
    }
}
