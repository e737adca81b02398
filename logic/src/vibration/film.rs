//! Conditioning of one film: less [`hum`](super::hum), high-pass, low-pass, rectifier (a film's sign means
//! nothing: Tada 2006, section 2), low-pass; Q16 around mid-scale, off by at most 0.0006 of a sample.

use super::hum::{Turn, Weights};
use crate::low_pass::LowPass;

const BAND_LOW_HZ: u32 = 20;
const BAND_HIGH_HZ: u32 = 150;
const ENVELOPE_US: u32 = 8_000;
pub(crate) const Q: u32 = 16;
const MIDDLE: i32 = 1 << 13;
pub(super) static ENVELOPE: LowPass = LowPass::of(1e6 / (2.0 * core::f64::consts::PI * ENVELOPE_US as f64));

/// Kept in memory: of a constant the compiler makes a product of 64 bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Band {
    low: LowPass,
    high: LowPass,
}

impl Default for Band {
    fn default() -> Self {
        Self { low: LowPass::of(BAND_LOW_HZ as f64), high: LowPass::of(BAND_HIGH_HZ as f64) }
    }
}

#[derive(Clone, Debug, Default)]
pub struct Film {
    offset: i32,
    pub(super) band: i32,
    pub(super) envelope: i32,
    pub(super) hum: Weights,
    primed: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Levels {
    pub envelope: i32,
    pub above: i32,
}

impl Film {
    /// The first sample is the offset, so that power-up is no vibration; later calls change nothing.
    pub fn prime(&mut self, sample: u16) {
        if !self.primed {
            self.offset = centred(sample);
            self.primed = true;
        }
    }

    #[inline]
    pub fn process(&mut self, band: &Band, sample: u16, mains: Turn) -> Levels {
        let x = centred(sample).wrapping_sub(self.hum.heard(mains));
        let ac = x - band.low.process(&mut self.offset, x);
        let low = band.high.process(&mut self.band, ac);
        Levels { envelope: ENVELOPE.process(&mut self.envelope, low.abs()), above: (ac - low).abs() }
    }
}

impl Levels {
    #[inline]
    pub fn raise(&mut self, other: Self) {
        self.envelope = self.envelope.max(other.envelope);
        self.above = self.above.max(other.above);
    }
}

#[inline]
const fn centred(sample: u16) -> i32 {
    (sample as i32 - MIDDLE) << Q
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vibration::hum::Mains;
    use core::f64::consts::PI;
    use tenax_hal_shim::channel::{FRAME_HZ, SAMPLE_MAX};

    #[derive(Default)]
    struct Reference([f64; 3], bool);

    impl Reference {
        fn low_pass(state: &mut f64, hz: f64, x: f64) -> f64 {
            let d = (x - *state) * PI * hz / f64::from(FRAME_HZ);
            let y = *state + d;
            *state = y + d;
            y
        }

        fn process(&mut self, sample: u16) -> (f64, f64) {
            let x = f64::from(sample) - f64::from(MIDDLE);
            if !self.1 {
                self.0[0] = x;
                self.1 = true;
            }
            let ac = x - Self::low_pass(&mut self.0[0], 20.0, x);
            let low = Self::low_pass(&mut self.0[1], 150.0, ac);
            let envelope_hz = 1e6 / (2.0 * PI * 8_000.0);
            (Self::low_pass(&mut self.0[2], envelope_hz, low.abs()), (ac - low).abs())
        }
    }

    fn worst_error(samples: impl Iterator<Item = u16>) -> f64 {
        let (mut film, mut reference) = (Film::default(), Reference::default());
        samples.fold(0.0f64, |worst, sample| {
            film.prime(sample);
            let fixed = film.process(&Band::default(), sample, Mains::default().turn());
            let (inside, above) = reference.process(sample);
            worst
                .max((f64::from(fixed.envelope) / 65_536.0 - inside).abs())
                .max((f64::from(fixed.above) / 65_536.0 - above).abs())
        })
    }

    #[test]
    fn conditioning_is_within_a_thousandth_of_a_sample_of_f64() {
        for hz in [1.0, 20.0, 60.0, 150.0, 400.0, 990.0] {
            let tone = (0..20_000).map(|n| {
                (8_192.0 + 8_000.0 * (2.0 * PI * hz * f64::from(n) / f64::from(FRAME_HZ)).sin()) as u16
            });
            assert!(worst_error(tone) < 0.001, "{hz} Hz");
        }
        let extremes = (0..20_000).map(|n| if n / 7 % 2 == 0 { 0 } else { SAMPLE_MAX });
        assert!(worst_error(extremes) < 0.001);
        assert!(worst_error((0..20_000).map(|n| if n < 9 { 0 } else { SAMPLE_MAX })) < 0.001);
    }
}
