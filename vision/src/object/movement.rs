//! What moves: pixels that are not as they were a moment ago.


use super::scene::levels;
use crate::frame::{PIXELS, Plane};

#[derive(Clone, Debug)]
pub struct Running {
    mean: Box<[i16; PIXELS]>,
    started: bool,
    apart: i16,
    rate: u32,
}

impl Running {
    pub fn new(apart: u8, rate: u32) -> Self {
        Self { mean: levels(), started: false, apart: i16::from(apart), rate }
    }
}

impl Default for Running {
    fn default() -> Self {
        Self::new(14, 2)
    }
}

impl Running {
    pub fn step(&mut self, grey: &Plane, into: &mut Plane) {
        let (rate, limit) = (if self.started { self.rate } else { 0 }, self.apart << 7);
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
        let (mut running, mut grey) = (Running::new(14, 3), frame::plane());
        grey.fill(100);
        let mut marked = [0; 2];
        for number in 0..60 {
            grey[5] = if number < 10 { 100 } else { 140 };
            let into = step(&mut running, &grey);
            marked = [marked[0] + usize::from(into[5]), marked[1] + usize::from(into[7])];
        }
        assert!((5..20).contains(&marked[0]) && marked[1] == 0, "{marked:?}");
    }

    #[test]
    fn the_first_frame_moves_nowhere() {
        let mut grey = frame::plane();
        grey.fill(100);
        assert!(step(&mut Running::default(), &grey).iter().all(|&moves| moves == 0));
    }
}
