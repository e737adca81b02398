//! Whether contractions still fit the calibration, over twelve of them; it only reports. A *turn* is far below
//! zero with electrodes in place, far above with exchanged plugs, and about zero if both are driven alike.

use tenax_hal_shim::words::Fit;

use super::Verdict;
use super::decide::Wish;
use super::model::{EmgModel, Point};

const OVER_FRAMES: u8 = 8;
const LEAST_FRAMES: u32 = 40;
const MOST_FRAMES: u16 = 4_800;
const ANSWERED: [u32; 2] = [2, 5];
pub const CONTRACTIONS: u8 = 12;
/// Unanswered contractions, or turns less than an eighth of the calibrated ones', that show moved electrodes.
const UNANSWERED: u8 = 3;
const MOVED: [i32; 2] = [1, 8];
/// Turns the other way of more than a third of the calibrated ones' show exchanged electrodes.
const EXCHANGED: [i32; 2] = [1, 3];
/// Limit of one contraction's turn, and least mean of calibrated turns that tells anything, Q10 octaves.
const MOST: i32 = 2_048;
const LEAST: i32 = 512;

#[derive(Clone, Debug, Default)]
pub struct Watch {
    sums: Point,
    frames: u16,
    wished: u16,
    rest: u8,
    count: u8,
    unanswered: u8,
    fit: Fit,
    turns: i32,
}

impl Watch {
    /// One slow frame, levels in Q10 octaves. True if it completes twelve contractions and a decision.
    #[inline(never)]
    pub fn take(&mut self, model: &EmgModel, levels: Point, verdict: Verdict) -> bool {
        if !verdict.known || self.frames >= MOST_FRAMES {
            // A fault teaches nothing.
            self.frames = 0;
            return false;
        }
        if verdict.active {
            if self.frames == 0 {
                (self.wished, self.sums) = (0, [0; 2]);
            }
            self.frames += 1;
            self.wished += u16::from(verdict.wish != Wish::Rest);
            self.sums = [self.sums[0] + levels[0], self.sums[1] + levels[1]];
            self.rest = 0;
            return false;
        }
        self.rest = self.rest.saturating_add(1);
        if self.rest < OVER_FRAMES {
            return false;
        }
        let frames = u32::from(core::mem::take(&mut self.frames));
        if frames < LEAST_FRAMES {
            return false;
        }
        self.unanswered += u8::from(u32::from(self.wished) * ANSWERED[1] < frames * ANSWERED[0]);
        self.turns += turn(model, self.sums.map(|sum| (sum.unsigned_abs() / frames) as i32));
        self.count += 1;
        if self.count < CONTRACTIONS {
            return false;
        }
        let (turns, unanswered) = (self.turns, self.unanswered);
        (self.count, self.turns, self.unanswered) = (0, 0, 0);
        let calibrated = turn(model, model.close()) + turn(model, model.open());
        let beyond = |[part, of]: [i32; 2]| calibrated * (i32::from(CONTRACTIONS) / 2) * part / of;
        let tells = calibrated <= -2 * LEAST;
        self.fit = if tells && turns > -beyond(EXCHANGED) {
            Fit::Exchanged
        } else if tells && turns > beyond(MOVED) || unanswered >= UNANSWERED {
            Fit::Moved
        } else {
            Fit::Fits
        };
        true
    }

    pub const fn fit(&self) -> Fit {
        self.fit
    }
}

/// Distance from the nearest calibrated contraction less that with the electrodes exchanged, Q10 octaves.
fn turn(model: &EmgModel, [flexor, extensor]: Point) -> i32 {
    let nearest = |flexor: i32, extensor: i32| {
        let far = |[f, e]: Point| (f - flexor).abs() + (e - extensor).abs();
        far(model.close()).min(far(model.open()))
    };
    (nearest(flexor, extensor) - nearest(extensor, flexor)).clamp(-MOST, MOST)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emg::Emg;
    use std::f64::consts::TAU;
    use std::vec::Vec;

    const CLOSE: [f64; 2] = [450.0, 165.0];
    const OPEN: [f64; 2] = [150.0, 1_400.0];

    fn told_to(calibrated: [[f64; 2]; 2], contractions: &[[f64; 2]], count: usize) -> Vec<(usize, Fit)> {
        let uv = |mv: [f64; 2]| mv.map(|mv| (mv * 1e3) as i32);
        let [close, open] = calibrated.map(uv);
        let model = EmgModel::of_uv([60_000, 50_000], close, open).unwrap();
        let mut emg = Emg::new(Some(&model));
        let (mut watch, mut told) = (Watch::default(), Vec::new());
        for (number, mv) in contractions.iter().cycle().take(count).enumerate() {
            for n in 0..960 {
                let t = f64::from(n) / 240.0;
                let lively = 1.0 + 0.12 * (TAU * 2.7 * t).sin();
                let pair = if t < 2.0 { [60.0, 50.0] } else { mv.map(|mv| mv * lively) };
                let pair = uv(pair).map(Some);
                let verdict = emg.take(pair);
                let before = watch.fit();
                if n % 3 == 2 && watch.take(&model, emg.levels(), verdict) && watch.fit() != before {
                    told.push((number, watch.fit()));
                }
            }
        }
        told
    }

    #[test]
    fn of_muscles_that_are_each_others_mirror_only_what_is_not_answered_is_told() {
        let (close, open) = ([600.0, 80.0], [80.0, 500.0]);
        assert_eq!(told_to([close, open], &[close, open], 40), []);
        assert_eq!(told_to([close, open], &[[80.0, 600.0], [500.0, 80.0]], 40), []);
        let moved = [(CONTRACTIONS as usize, Fit::Moved)];
        assert_eq!(told_to([close, open], &[close, [80.0, 200.0]], 40), moved);
    }

    #[test]
    fn a_contraction_of_more_than_a_minute_or_of_a_fault_does_not_count() {
        let model = EmgModel::of_uv([60_000, 50_000], [450_000, 165_000], [150_000, 1_400_000]).unwrap();
        let least = LEAST_FRAMES as u16;
        let counts = |last: u16, has_fault: bool| {
            let (mut watch, mut done) = (Watch::default(), false);
            let lengths = [least; CONTRACTIONS as usize - 1].into_iter().chain([last]);
            for (number, length) in lengths.enumerate() {
                let mut take = |active, known| {
                    let verdict = Verdict { active, known, ..Verdict::default() };
                    done |= watch.take(&model, model.close(), verdict);
                };
                let is_last = number + 1 == usize::from(CONTRACTIONS);
                (1..=length).for_each(|frame| take(true, !(has_fault && is_last && frame == length)));
                (0..OVER_FRAMES).for_each(|_| take(false, true));
            }
            done
        };
        assert!(
            counts(MOST_FRAMES - 1, false) && !counts(MOST_FRAMES, false) && !counts(MOST_FRAMES + 1, false)
        );
        assert!(counts(least, false) && !counts(least, true));
    }

    // Shows W9.
    #[test]
    fn moved_or_exchanged_electrodes_are_told_after_twelve_contractions_and_sound_ones_never() {
        let swap = |[flexor, extensor]: [f64; 2]| [extensor, flexor];
        let twelve = |fit| Vec::from([(CONTRACTIONS as usize, fit)]);
        // 24 that fit follow twelve that drive both electrodes alike.
        let fits_again = [[400.0; 2]; 12].into_iter().chain([CLOSE, OPEN].repeat(12));
        for (contractions, count, expected) in [
            (&[CLOSE, OPEN][..], 60, Vec::new()),
            (&[OPEN], 60, Vec::new()),
            (&[CLOSE], 60, Vec::new()),
            (&[CLOSE.map(|mv| 0.7 * mv), OPEN.map(|mv| 1.4 * mv)], 60, Vec::new()),
            (&[swap(CLOSE), swap(OPEN)], 40, twelve(Fit::Exchanged)),
            (&[swap(OPEN)], 40, twelve(Fit::Exchanged)),
            // Unanswered openings, and contractions that drive both electrodes alike.
            (&[CLOSE, [150.0, 300.0]], 40, twelve(Fit::Moved)),
            (&[[450.0, 400.0], [400.0, 450.0]], 40, twelve(Fit::Moved)),
            (&Vec::from_iter(fits_again), 37, Vec::from([(12, Fit::Moved), (24, Fit::Fits)])),
        ] {
            assert_eq!(told_to([CLOSE, OPEN], contractions, count), expected, "{contractions:?}");
        }
    }
}
