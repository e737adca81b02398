//! The scene behind the skin, and what moves in it. The scene follows slowly and stands still where an object is, so that an object that is
//! held still does not become background.

use crate::frame::{Frame, PIXELS, Plane, WIDTH, plane};
use crate::mask::Mask;

/// Fraction bits of a remembered level.
const FRACTION: u32 = 7;
/// A pixel differs from the scene if a colour is this far off, grey levels, and four times its usual variation.
const APART_MIN: i16 = 12;
/// One of so many pixels stands for all.
const SAMPLE: usize = 61;
const SAMPLES_MIN: u16 = 100;
const LIGHT: (i32, i32) = (30, 235);
/// A change of the light below this is none, 1/256.
const LIGHT_MIN: i32 = 2;
/// Grey levels from its mean beyond which a pixel moves: twice the noise of a cheap camera.
const MOVES: i16 = 14;
/// Usual rate of the running mean: it forgets a move after some four frames.
const RUNNING_RATE: u32 = 2;

type Levels = Box<[i16; PIXELS]>;

#[derive(Clone, Debug)]
pub struct Scene {
    colours: [Levels; 3],
    varies: Levels,
    frames: u32,
}

impl Default for Scene {
    fn default() -> Self {
        Self { colours: [plane(), plane(), plane()], varies: plane(), frames: 0 }
    }
}

impl Scene {
    pub fn differs(&self, frame: &Frame, into: &mut [u8; PIXELS]) {
        let (new, varies) = ([frame.red, frame.green, frame.blue], &*self.varies);
        let [red, green, blue] = self.colours.each_ref().map(|levels| &**levels);
        for at in 0..PIXELS {
            let off =
                apart(new[0][at], red[at]).max(apart(new[1][at], green[at])).max(apart(new[2][at], blue[at]));
            // A colour is never farther off than 255, so four times the variation is below 2^15.
            into[at] = u8::from(off >> 2 > (varies[at]).max((APART_MIN << FRACTION) >> 2));
        }
    }

    /// Takes a change of the light, or of the camera's exposure, for what it is: the whole scene becomes brighter or darker by
    /// what most of the pixels did that are not `hidden`.
    pub fn follow_light(&mut self, grey_is: &Plane, hidden: &Mask) {
        // Ratios in steps of 1/256, from 0.5 to 1.5.
        let (mut counts, mut count) = ([0u16; 256], 0);
        for at in (0..PIXELS).step_by(SAMPLE) {
            let [red, green, blue] = self.colours.each_ref().map(|levels| i32::from(levels[at]));
            let was = (red + 2 * green + blue) >> 2;
            let is = i32::from(grey_is[at]) << FRACTION;
            // The dark says little, and the bright is cut off.
            if (LIGHT.0..LIGHT.1).contains(&(was >> FRACTION)) && !hidden.contains(at % WIDTH, at / WIDTH) {
                let step = 256 * is / was - 128;
                if let Some(slot) = usize::try_from(step).ok().and_then(|step| counts.get_mut(step)) {
                    (*slot, count) = (*slot + 1, count + 1);
                }
            }
        }
        if count < SAMPLES_MIN {
            return;
        }
        let mut sum = 0;
        let median = counts.iter().position(|&of| {
            sum += of;
            2 * sum > count
        });
        let change = median.map_or(0, |step| step as i32 - 128);
        if change.abs() < LIGHT_MIN {
            return;
        }
        for level in self.colours.iter_mut().flat_map(|levels| levels.iter_mut()) {
            // The upper half of a product of 16 bits each, which is one instruction for eight levels.
            let more = ((i32::from(*level) * (change << 8)) >> 16) as i16;
            *level = level.saturating_add(more).min(255 << FRACTION);
        }
    }

    /// Follows the frame where it is not `hidden`; `rate` is the power of two by which it does, the higher the slower.
    pub fn follow(&mut self, frame: &Frame, hidden: &Mask, rate: u32) {
        let mut held = plane();
        hidden.unpack(&mut held);
        // The first frames count alike.
        self.frames = (self.frames + 1).min(1 << 16);
        let rate = rate.min(self.frames.ilog2());
        for (plane, levels) in [frame.red, frame.green, frame.blue].into_iter().zip(&mut self.colours) {
            for at in 0..PIXELS {
                let free = i16::from(held[at]) - 1;
                levels[at] += (((i16::from(plane[at]) << FRACTION) - levels[at]) >> rate) & free;
            }
        }
        let (green, old, varies) = (frame.green, &*self.colours[1], &mut *self.varies);
        for at in 0..PIXELS {
            let free = i16::from(held[at]) - 1;
            let off = apart(green[at], old[at]);
            varies[at] += ((off - varies[at]) >> 6) & free;
        }
    }

    pub fn mean_colour(&self) -> [u8; 3] {
        self.colours.each_ref().map(|plane| {
            let sum: u32 = plane.iter().step_by(SAMPLE).map(|&level| level as u32).sum();
            ((sum / PIXELS.div_ceil(SAMPLE) as u32) >> FRACTION) as u8
        })
    }

    #[inline]
    pub fn colour(&self, at: usize) -> [u8; 3] {
        self.colours.each_ref().map(|plane| (plane[at] >> FRACTION) as u8)
    }
}

#[inline]
fn apart(level: u8, old: i16) -> i16 {
    (((i16::from(level)) << FRACTION) - old).abs()
}

#[derive(Clone, Debug)]
pub struct Running {
    mean: Levels,
    started: bool,
    /// It follows by this power of two.
    pub rate: u32,
}

impl Default for Running {
    fn default() -> Self {
        Self { mean: plane(), started: false, rate: RUNNING_RATE }
    }
}

impl Running {
    /// Marks with 1 what moves.
    pub fn step(&mut self, grey: &Plane, into: &mut Plane) {
        let (rate, limit) = (if self.started { self.rate } else { 0 }, MOVES << FRACTION);
        let mean = &mut *self.mean;
        for at in 0..PIXELS {
            let off = (i16::from(grey[at]) << FRACTION) - mean[at];
            into[at] = u8::from(off.abs() > limit);
            mean[at] += off >> rate;
        }
        if !self.started {
            (self.started, _) = (true, into.fill(0));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_changes_moves_until_the_mean_has_followed() {
        let (mut running, mut grey, mut into) = (Running::default(), plane(), plane());
        grey.fill(100);
        let mut marked = [0; 2];
        for number in 0..60 {
            grey[5] = if number < 10 { 100 } else { 140 };
            running.step(&grey, &mut into);
            assert!(number > 0 || into.iter().all(|&moves| moves == 0), "nothing moves in the first frame");
            marked = [marked[0] + usize::from(into[5]), marked[1] + usize::from(into[7])];
        }
        assert!((3..6).contains(&marked[0]) && marked[1] == 0, "{marked:?}");
    }
}
