//! The ac part is slip if it is large for long enough and swings: an impact dies away, a force swings once.

use super::split::{Q, Split};
use tenax_hal_shim::channel::frames;

const LASTS: u32 = frames(45);
const SWINGS: u16 = 3;

#[derive(Clone, Copy, Debug, Default)]
pub struct Presence {
    large: u32,
    before: u16,
    pub slip: bool,
}

impl Presence {
    /// `on`: threshold of the ac envelope, samples (14 bits); half of it keeps slip on.
    #[inline]
    pub fn process(&mut self, on: u16, split: &Split) {
        let on = (i32::from(on) << Q) >> u32::from(self.slip);
        let is_large = split.envelope > on;
        if !is_large {
            (self.large, self.before, self.slip) = (0, split.swings, false);
            return;
        }
        self.large = self.large.saturating_add(1);
        self.before = self.before.min(split.swings);
        self.slip |= self.large >= LASTS && split.swings - self.before >= SWINGS;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn said(hz: f64, size: f64, decay: f64) -> Option<u32> {
        let (mut split, mut presence) = (Split::default(), Presence::default());
        (0..2_000).find(|&n| {
            let t = f64::from(n);
            let tone = size * (-t / decay).exp() * (TAU * hz * t / 2e3).sin();
            split.process((6_000.0 + tone).round() as u16);
            presence.process(10, &split);
            presence.slip
        })
    }

    #[test]
    fn what_lasts_is_slip_and_what_rings_is_not() {
        for hz in [20.0, 48.0, 150.0] {
            let at = said(hz, 60.0, f64::INFINITY).unwrap();
            assert!((LASTS..400).contains(&at), "{hz} Hz: {at}");
            assert_eq!(said(hz, 60.0, 30.0), None, "an impact of {hz} Hz that dies in 15 ms");
            assert_eq!(said(hz, 5.0, f64::INFINITY), None, "too small");
        }
        assert_eq!(said(2.0, 4_000.0, f64::INFINITY), None, "an arm that swings");
    }

    #[test]
    fn a_force_that_comes_fast_is_not_slip() {
        for frames in [60.0, 160.0, 600.0] {
            let (mut split, mut presence) = (Split::default(), Presence::default());
            for n in 0..4_000_u32 {
                let noise = f64::from(n.wrapping_mul(0x9E37_79B9) >> 29) - 3.5;
                let ramp = ((f64::from(n) - 1_000.0) / frames).clamp(0.0, 1.0);
                split.process((2_000.0 + 8_000.0 * ramp + noise) as u16);
                presence.process(10, &split);
                assert!(!presence.slip, "{frames}: {n}");
            }
        }
    }
}
