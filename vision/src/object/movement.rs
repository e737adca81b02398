//! What moves: pixels that are not as they were a moment ago.

use super::scene::levels;
use crate::frame::{PIXELS, Plane};

/// Grey levels from its mean beyond which a pixel moves: twice the noise of a cheap camera.
const APART: i16 = 14;
/// The mean follows by this power of two: it forgets a move after some four frames.
const RATE: u32 = 2;

/// A running mean of the grey level.
#[derive(Clone, Debug)]
pub struct Running {
    mean: Box<[i16; PIXELS]>,
    started: bool,
}

impl Running {
    pub fn new() -> Self {
        Self { mean: levels(), started: false }
    }

    /// Marks with 1 what moves.
    pub fn step(&mut self, grey: &Plane, into: &mut Plane) {
        let (rate, limit) = (if self.started { RATE } else { 0 }, APART << 7);
        let mean = &mut *self.mean;
        for at in 0..PIXELS {
            let off = (i16::from(grey[at]) << 7) - mean[at];
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

    fn step(running: &mut Running, grey: &Plane) -> Box<Plane> {
        let mut into = frame::plane();
        running.step(grey, &mut into);
        into
    }

    #[test]
    fn what_changes_moves_until_the_mean_has_followed() {
        let (mut running, mut grey) = (Running::new(), frame::plane());
        grey.fill(100);
        let mut marked = [0; 2];
        for number in 0..60 {
            grey[5] = if number < 10 { 100 } else { 140 };
            let into = step(&mut running, &grey);
            assert!(number > 0 || into.iter().all(|&moves| moves == 0), "nothing moves in the first frame");
            marked = [marked[0] + usize::from(into[5]), marked[1] + usize::from(into[7])];
        }
        assert!((3..6).contains(&marked[0]) && marked[1] == 0, "{marked:?}");
    }
}
