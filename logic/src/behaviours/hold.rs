//! Holding: closes a little whenever the object slips (FingerVision 2017, section II-B). Motion without shear
//! is a fault of the camera.

use super::felt::skin_mn;
use super::{BehaviourConfig, Course, Felt, Movement, Wish};
use crate::grip::Grip;
use tenax_hal_shim::channel::frames;
use tenax_hal_shim::motor::Duty;

const ANSWER_FRAMES_MAX: u32 = frames(500);
const FASTER_FRAMES: u32 = frames(60);
const FASTEST: u32 = 3;
const STILL_FRAMES: u32 = frames(200);
const STICKS: [[i32; 2]; 2] = [[1, 10], [1, 3]];
const SLIDES: [i32; 2] = [1, 2];
const SUMS_RATE: u32 = 2;

#[derive(Clone, Debug, Default)]
pub struct Hold {
    movement: Movement,
    /// Normal force and shear, 1/16 mN.
    sums_q4: [i32; 2],
    may_slide: bool,
    slides: bool,
    answered: u32,
    still: u32,
}

impl Hold {
    pub fn step(&mut self, config: &BehaviourConfig, felt: &Felt<'_>) -> Course {
        let slips = match felt.view {
            Some(view) => {
                if felt.view_is_new {
                    let now = skin_mn(view).map(|mn| mn << 4);
                    self.sums_q4.iter_mut().zip(now).for_each(|(sum, now)| *sum += (now - *sum) >> SUMS_RATE);
                    let sheared = |[normal, shear]: [i32; 2], parts: [i32; 2]| {
                        parts[1] * shear.abs() >= parts[0] * normal
                    };
                    self.may_slide = sheared(self.sums_q4, STICKS[0]) || sheared(now, STICKS[1]);
                    self.slides = sheared(self.sums_q4, SLIDES);
                }
                self.may_slide && felt.is_moving(config.moving_e4, false)
            }
            None => felt.slips && !matches!(felt.grip, Grip::Holds(_)),
        };
        self.still = if slips { 0 } else { self.still.saturating_add(1) };
        if self.still >= STILL_FRAMES {
            self.answered = 0;
        }
        let times = if self.slides { (1 + self.answered / FASTER_FRAMES).min(FASTEST) } else { 1 };
        if slips && !self.movement.drives() && self.answered < ANSWER_FRAMES_MAX {
            let duty = Duty::per_mille(config.duty_permille.saturating_mul(times as u16));
            self.movement = Movement::lasting(config, Wish::Tighten(duty), config.movement_frames);
            self.answered += times * config.movement_frames;
        }
        Course::On(self.movement.step())
    }
}
