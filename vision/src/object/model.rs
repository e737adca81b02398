//! What colours the object has (FingerVision 2017, equation 1).

use super::colour::BINS;

/// A count of pixels for each bin: one colour covers less than 65 536 of them.
pub type Histogram = [u16; BINS];

/// Frames that the model is made of: the last ones in which something moved.
pub const FRAMES: usize = 200;
/// Part of the background that is taken away, in halves (f_bg = 1.5).
const BACKGROUND_HALVES: u32 = 3;
/// Gain of the rest, in halves (f_gain = 0.5).
const GAIN_HALVES: u32 = 1;
const FULL: u32 = 255;

#[derive(Clone, Debug)]
pub struct ObjectModel {
    added: Box<[[u8; BINS]]>,
    sums: Box<Histogram>,
    next: usize,
}

impl Default for ObjectModel {
    fn default() -> Self {
        Self { added: vec![[0; BINS]; FRAMES].into_boxed_slice(), sums: Box::new([0; BINS]), next: 0 }
    }
}

impl ObjectModel {
    pub fn learn(&mut self, moving: &Histogram, background: &Histogram) {
        let bins =
            self.added[self.next].iter_mut().zip(self.sums.iter_mut()).zip(moving.iter().zip(background));
        for ((slot, sum), (&moving, &background)) in bins {
            let rest = (2 * u32::from(moving)).saturating_sub(BACKGROUND_HALVES * u32::from(background)) / 2;
            let new = (rest * GAIN_HALVES / 2).min(FULL) as u8;
            // At most 200 times 255.
            *sum = *sum - u16::from(*slot) + u16::from(new);
            *slot = new;
        }
        self.next = (self.next + 1) % FRAMES;
    }

    /// The model's value at a bin, 0 to 255: the back projection of a pixel of this colour.
    #[inline]
    pub fn value(&self, bin: usize) -> u8 {
        self.sums[bin].min(FULL as u16) as u8
    }

    pub fn forget(&mut self) {
        self.added.iter_mut().for_each(|frame| frame.fill(0));
        self.sums.fill(0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_of_the_background_is_not_the_objects() {
        let (mut model, mut moving, mut background) = (ObjectModel::default(), [0; BINS], [0; BINS]);
        (moving[3], moving[4], moving[5]) = (100, 100, 40);
        (background[3], background[4]) = (20, 70);
        model.learn(&moving, &background);
        assert_eq!([3, 4, 5, 6].map(|bin| model.value(bin)), [35, 0, 20, 0]);
        (0..20).for_each(|_| model.learn(&moving, &background));
        assert_eq!([3, 4, 5, 6].map(|bin| model.value(bin)), [255, 0, 255, 0]);
        // It forgets after its frames.
        moving.fill(0);
        (1..FRAMES).for_each(|_| model.learn(&moving, &background));
        assert_eq!(model.value(3), 35);
        model.learn(&moving, &background);
        assert_eq!(model.value(3), 0);
    }
}
