//! The scene behind the skin, remembered while an object hides it; and what moves in it.
//!
//! For each pixel: its colour and how much that varies. It follows slowly where nothing is held in front of it and stands
//! still where the object is, so that an object that is held still does not become background.

use crate::frame::{Frame, PIXELS, Plane, WIDTH};
use crate::mask::Mask;

/// Fraction bits of a remembered level.
const FRACTION: u32 = 7;
/// A pixel differs from the scene if a colour is this far off, grey levels, and four times its usual variation.
const APART_MIN: i16 = 12;

/// Every so many pixels tell how the light is.
const SAMPLE: usize = 61;
/// Pixels that must tell so.
const SAMPLES_MIN: u16 = 100;
/// Levels that tell.
const LIGHT: (i32, i32) = (30, 235);
/// A change of the light below this is none, 1/256.
const LIGHT_MIN: i32 = 2;

/// Grey levels from its mean beyond which a pixel moves: twice the noise of a cheap camera.
const MOVES: i16 = 14;
/// The running mean follows by this power of two: it forgets a move after some four frames.
const RUNNING_RATE: u32 = 2;

type Levels = Box<[i16; PIXELS]>;

#[derive(Clone, Debug)]
pub struct Scene {
    red: Levels,
    green: Levels,
    blue: Levels,
    varies: Levels,
    frames: u32,
}

fn levels() -> Levels {
    match vec![0; PIXELS].into_boxed_slice().try_into() {
        Ok(plane) => plane,
        Err(_) => unreachable!("its length is that of a plane"),
    }
}

impl Scene {
    pub fn new() -> Self {
        Self { red: levels(), green: levels(), blue: levels(), varies: levels(), frames: 0 }
    }

    pub fn differs(&self, frame: &Frame, into: &mut [u8; PIXELS]) {
        let (red, green, blue) = (frame.red, frame.green, frame.blue);
        let (old_red, old_green, old_blue, varies) = (&*self.red, &*self.green, &*self.blue, &*self.varies);
        for at in 0..PIXELS {
            let off = apart(red[at], old_red[at])
                .max(apart(green[at], old_green[at]))
                .max(apart(blue[at], old_blue[at]));
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
            let was =
                (i32::from(self.red[at]) + 2 * i32::from(self.green[at]) + i32::from(self.blue[at])) >> 2;
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
        for levels in [&mut self.red, &mut self.green, &mut self.blue] {
            for level in levels.iter_mut() {
                // The upper half of a product of 16 bits each, which is one instruction for eight levels.
                let more = ((i32::from(*level) * (change << 8)) >> 16) as i16;
                *level = level.saturating_add(more).min(255 << FRACTION);
            }
        }
    }

    /// Follows the frame where `held` is 0; `rate` is the power of two by which it does, the higher the slower.
    pub fn follow(&mut self, frame: &Frame, held: &[u8; PIXELS], rate: u32) {
        // The first frames count alike.
        self.frames = (self.frames + 1).min(1 << 16);
        let rate = rate.min(self.frames.ilog2());
        for (plane, levels) in
            [(frame.red, &mut self.red), (frame.green, &mut self.green), (frame.blue, &mut self.blue)]
        {
            follow(plane, levels, held, rate);
        }
        let (green, old, varies) = (frame.green, &*self.green, &mut *self.varies);
        for at in 0..PIXELS {
            let free = i16::from(held[at]) - 1;
            let off = apart(green[at], old[at]);
            varies[at] += ((off - varies[at]) >> 6) & free;
        }
    }

    pub fn mean_colour(&self) -> [u8; 3] {
        // Every 61st pixel stands for all.
        [&self.red, &self.green, &self.blue].map(|plane| {
            let sum: u32 = plane.iter().step_by(61).map(|&level| level as u32).sum();
            ((sum / PIXELS.div_ceil(61) as u32) >> FRACTION) as u8
        })
    }

    #[inline]
    pub fn colour(&self, at: usize) -> (u8, u8, u8) {
        let level = |plane: &Levels| (plane[at] >> FRACTION) as u8;
        (level(&self.red), level(&self.green), level(&self.blue))
    }
}

#[inline]
fn apart(level: u8, old: i16) -> i16 {
    (((i16::from(level)) << FRACTION) - old).abs()
}

fn follow(plane: &Plane, levels: &mut [i16; PIXELS], held: &[u8; PIXELS], rate: u32) {
    for at in 0..PIXELS {
        let free = i16::from(held[at]) - 1;
        levels[at] += ((((i16::from(plane[at])) << FRACTION) - levels[at]) >> rate) & free;
    }
}

/// A running mean of the grey level.
#[derive(Clone, Debug)]
pub struct Running {
    mean: Levels,
    started: bool,
}

impl Running {
    pub fn new() -> Self {
        Self { mean: levels(), started: false }
    }

    /// Marks with 1 what moves.
    pub fn step(&mut self, grey: &Plane, into: &mut Plane) {
        let (rate, limit) = (if self.started { RUNNING_RATE } else { 0 }, MOVES << FRACTION);
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
    use crate::frame;

    #[test]
    fn what_changes_moves_until_the_mean_has_followed() {
        let (mut running, mut grey, mut into) = (Running::new(), frame::plane(), frame::plane());
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
