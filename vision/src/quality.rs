//! Whether a camera's pictures can be believed: late, frozen and covered cameras say nothing about the object.

use crate::frame::{PIXELS, Plane, WIDTH};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blind {
    Late(u32),
    Frozen(u32),
    Covered,
}

pub const LATE_MS: u32 = 150;
pub const FROZEN_MS: u32 = 150;
/// A picture whose grey levels differ less than this (standard deviation) shows nothing.
const CONTRAST_MIN: f32 = 5.0;
/// A picture darker than this shows nothing, grey levels.
const LEVEL_MIN: f32 = 10.0;
/// The least share of the markers that must be found, per cent.
const MARKERS_MIN_PERCENT: usize = 34;
/// One of so many rows is looked at.
const ROWS: usize = 5;

#[derive(Clone, Debug, Default)]
pub struct Watch {
    same_since_ms: Option<u32>,
    sum: Option<u64>,
}

impl Watch {
    pub fn picture(
        &mut self,
        grey: &Plane,
        (found, markers): (usize, usize),
        taken_ms: u32,
        now_ms: u32,
    ) -> Option<Blind> {
        let (mut sum, mut squares, mut checksum) = (0, 0, 0u64);
        for row in grey.chunks_exact(WIDTH).step_by(ROWS) {
            sum += row.iter().map(|&level| u32::from(level)).sum::<u32>();
            squares += row.iter().map(|&level| u32::from(level) * u32::from(level)).sum::<u32>();
            for eight in row.as_chunks().0 {
                let eight = u64::from_le_bytes(*eight);
                checksum = (checksum.rotate_left(5) ^ eight).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            }
        }
        let n = (PIXELS / ROWS) as f32;
        let level = sum as f32 / n;
        let contrast = libm::sqrtf((squares as f32 / n - level * level).max(0.0));
        let same = self.sum.replace(checksum) == Some(checksum);
        self.same_since_ms = if same { self.same_since_ms.or(Some(now_ms)) } else { None };
        let age = now_ms.wrapping_sub(taken_ms);
        let frozen = self.same_since_ms.map_or(0, |since| now_ms.wrapping_sub(since));
        let is_covered =
            level < LEVEL_MIN || contrast < CONTRAST_MIN || 100 * found < MARKERS_MIN_PERCENT * markers;
        match () {
            () if age >= LATE_MS => Some(Blind::Late(age)),
            () if frozen >= FROZEN_MS => Some(Blind::Frozen(frozen)),
            () if is_covered => Some(Blind::Covered),
            () => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::plane;

    fn picture(seed: u32) -> Box<Plane> {
        let mut grey: Box<Plane> = plane();
        let levels = (0..).map(|at: u32| (at % 200 + (at ^ seed) % 3) as u8);
        grey.iter_mut().zip(levels).for_each(|(level, drawn)| *level = drawn);
        grey
    }

    #[test]
    fn late_frozen_and_covered_are_told_apart_from_a_camera_that_works() {
        let mut watch = Watch::default();
        for frame in 0..100 {
            let now = 33 * frame;
            assert_eq!(watch.picture(&picture(frame), (20, 23), now.saturating_sub(40), now), None);
        }
        let mut watch = Watch::default();
        assert_eq!(watch.picture(&picture(1), (20, 23), 0, 200), Some(Blind::Late(200)));
        let told: Vec<_> =
            (0..9).map(|at| watch.picture(&picture(2), (20, 23), 233 + 33 * at, 233 + 33 * at)).collect();
        assert_eq!(told[..5], [None; 5]);
        assert_eq!(told[6..], [165, 198, 231].map(|same| Some(Blind::Frozen(same))));
        assert_eq!(watch.picture(&picture(3), (20, 23), 600, 600), None);
        assert_eq!(watch.picture(&picture(4), (5, 23), 633, 633), Some(Blind::Covered));
        let mut dark = picture(5);
        dark.iter_mut().for_each(|level| *level /= 32);
        assert_eq!(watch.picture(&dark, (20, 23), 666, 666), Some(Blind::Covered));
    }
}
