//! Holding: close a little whenever the object slips (FingerVision 2017, section II-B).
//!
//! The reflex answers the detectors already. This adds slip that only a camera sees, of an object too light for
//! vibration and force sensors; and without a camera, slip at a load below which the reflex rests.
//!
//! A camera is wrong in some pictures, several in a row. Waiting for more of them is no way out: an object is lost meanwhile, since slip may
//! show in one picture only. But friction is at least the highest ratio of shear to normal force at which the object has stuck, so
//! at less it breaks loose only while the ratio rises. As the fingers close on what sticks, the ratio falls, and wrong pictures close no
//! further; what slides keeps its ratio. No object slides on skin that is hardly sheared. Motion that continues however far the fingers
//! close is a fault of the camera.

use super::felt::skin_mn;
use super::{BehaviourConfig, Course, Felt, Movement, Wish};
use crate::grip::Grip;
use tenax_hal_shim::channel::frames;
use tenax_hal_shim::motor::Duty;

/// Longest closing for one slip, frames.
const ANSWER_FRAMES_MAX: u32 = frames(500);
/// Frames of closing after which the fingers close faster by their first speed, up to [`FASTEST`] times, while the object
/// surely slides.
const FASTER_FRAMES: u32 = frames(60);
const FASTEST: u32 = 3;
/// A slip is over when nothing has slipped for this long, in frames.
const STILL_FRAMES: u32 = frames(200);

/// Below this ratio of the markers' shear to their normal force the object sticks, per mille: over the last pictures, and in a single
/// one, whose markers are less sure. Rubber has several times that friction.
const STICKS_PERMILLE: [i32; 2] = [100, 333];
/// Above this it surely slides, if it moves.
const SLIDES_PERMILLE: i32 = 500;
/// An object breaks loose at no less than this part of the ratio that this grasp has shown, and slides on at no less than this one, per
/// mille: the noise of a light object's ratio, and the friction of what slides.
const KEPT_PERMILLE: [i32; 2] = [850, 700];
/// The ratio rises if it is above its mean by this part, per mille; in a single picture by this much, half of a light object's noise.
const RISES_PERMILLE: [i32; 2] = [1_200, 70];
/// Lighter than this, the finger lets go, and the friction of the grasp is forgotten, mN.
const LETS_GO_MN: i32 = 200;
/// The markers' sums follow their pictures by these powers of two: the last pictures, and the mean of a quarter of a second.
const SUMS_RATES: [u32; 2] = [2, 4];

/// Small movements, one after the other while the object slips.
#[derive(Clone, Debug, Default)]
pub struct Hold {
    movement: Movement,
    /// Sums over all markers of normal force and shear, 1/16 mN, at each of the rates.
    sums_q4: [[i32; 2]; 2],
    /// The highest mean ratio of this grasp, per mille: a lower bound of its friction.
    shown_permille: i32,
    /// Whether the shear is enough for sliding, and whether the object surely slides.
    may_slide: bool,
    slides: bool,
    /// Frames of closing since nothing slipped last, times how much faster than usual.
    answered: u32,
    still: u32,
}

impl Hold {
    pub fn step(&mut self, config: &BehaviourConfig, felt: &Felt<'_>) -> Course {
        let slips = match felt.view {
            Some(view) => {
                if felt.view_is_new {
                    self.look(skin_mn(view).map(|mn| mn << 4));
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

    /// Takes the normal force and the shear of a new picture, 1/16 mN.
    fn look(&mut self, now_q4: [i32; 2]) {
        for (sums, rate) in self.sums_q4.iter_mut().zip(SUMS_RATES) {
            sums.iter_mut().zip(now_q4).for_each(|(sum, now)| *sum += (now - *sum) >> rate);
        }
        let [last, mean] = self.sums_q4.map(ratio_permille);
        let now = ratio_permille(now_q4);
        let holds = self.sums_q4[1][0] >= LETS_GO_MN << 4;
        self.shown_permille = if holds { self.shown_permille.max(mean) } else { 0 };
        let kept = KEPT_PERMILLE[usize::from(self.answered > 0)];
        let is_sheared = last >= STICKS_PERMILLE[0] || now >= STICKS_PERMILLE[1];
        let rises = last * 1_000 >= mean * RISES_PERMILLE[0] || now >= mean + RISES_PERMILLE[1];
        self.may_slide = is_sheared && (rises || last * 1_000 >= self.shown_permille * kept);
        self.slides = last >= SLIDES_PERMILLE;
    }
}

/// Shear over normal force, per mille, at most 1000 times as much as any friction.
fn ratio_permille([normal, shear]: [i32; 2]) -> i32 {
    // The sum of all markers' shears is below 2^20 in these units, the product below 2^30.
    (shear.abs() * 1_000 / normal.max(1)).min(1_000_000)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether motion counts as slip, after each of these pictures of normal force and shear, mN.
    fn may_slide(hold: &mut Hold, pictures: usize, mn: [i32; 2]) -> bool {
        (0..pictures).for_each(|_| hold.look(mn.map(|mn| mn << 4)));
        hold.may_slide
    }

    #[test]
    fn what_stuck_at_more_shear_sticks_at_less_until_its_shear_rises_or_the_finger_lets_go() {
        let mut hold = Hold::default();
        assert!(!may_slide(&mut hold, 100, [1_000, 90]), "rubber has more friction");
        assert!(may_slide(&mut hold, 100, [1_000, 300]));
        assert!(may_slide(&mut hold, 100, [1_000, 270]), "the noise of its ratio");
        assert!(!may_slide(&mut hold, 100, [1_000, 240]));
        assert!(may_slide(&mut hold, 1, [1_000, 320]), "a pull begins");
        assert!(!may_slide(&mut hold, 100, [1_500, 320]), "it is held more firmly");
        may_slide(&mut hold, 100, [100, 10]);
        assert!(may_slide(&mut hold, 100, [1_500, 320]), "another grasp");
    }

    #[test]
    fn closing_on_what_sticks_is_over_when_the_ratio_has_fallen_and_on_what_slides_it_goes_on() {
        for (sticks, goes_on) in [(true, false), (false, true)] {
            let mut hold = Hold::default();
            may_slide(&mut hold, 100, [1_000, 400]);
            hold.answered = 1;
            let slides_on = |normal: i32| [normal, if sticks { 400 } else { normal * 3 / 10 }];
            let ends = (1_000..2_000).step_by(20).map(|normal| may_slide(&mut hold, 1, slides_on(normal))).last();
            assert_eq!(ends, Some(goes_on));
        }
    }

    #[test]
    fn no_picture_is_too_great_for_a_ratio() {
        let mut hold = Hold::default();
        for mn in [[0, 0], [0, -62_000], [61_000, 62_000], [0, 62_000]] {
            may_slide(&mut hold, 40, mn);
            assert!((0..=1_000_000).contains(&hold.shown_permille));
        }
    }
}
