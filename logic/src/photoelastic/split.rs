//! Splits the head's signal: ac, by two high-passes, shows slip; dc, the mean of a slow frame, normal force
//! (section 3). Samples around mid-scale in Q14; every state stays below 2^29.

use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;

use crate::low_pass::LowPass;

pub const BAND_LOW_HZ: u32 = 20;
pub const BAND_HIGH_HZ: u32 = 250;
pub const ENVELOPE_HZ: u32 = 12;
pub const Q: u32 = 14;
const MIDDLE: i32 = 1 << 13;
const NOISE: i32 = 2 << Q;
const PERIOD_MAX: u16 = 250;
static HIGH_PASS: LowPass = LowPass::of(BAND_LOW_HZ as f64);
static LOW_PASS: LowPass = LowPass::of(BAND_HIGH_HZ as f64);
static ENVELOPE: LowPass = LowPass::of(ENVELOPE_HZ as f64);

#[derive(Clone, Debug, Default)]
pub struct Split {
    primed: bool,
    high: [i32; 2],
    low: i32,
    envelope_state: i32,
    ac: i32,
    /// Mean size of the ac part, Q14 samples.
    pub envelope: i32,
    sum: u32,
    count: u32,
    is_above: bool,
    since: u16,
    period_q4: u16,
    pub swings: u16,
}

impl Split {
    #[inline]
    pub fn process(&mut self, sample: u16) {
        let x = (i32::from(sample) - MIDDLE) << Q;
        if !self.primed {
            self.primed = true;
            self.high[0] = x;
        }
        let [first, second] = &mut self.high;
        let once = x - HIGH_PASS.process(first, x);
        let twice = once - HIGH_PASS.process(second, once);
        self.ac = LOW_PASS.process(&mut self.low, twice);
        self.envelope = ENVELOPE.process(&mut self.envelope_state, self.ac.abs());
        self.swing();
        self.sum += u32::from(sample);
        self.count += 1;
    }

    #[inline]
    fn swing(&mut self) {
        self.since = self.since.saturating_add(1);
        let far = (self.envelope / 2).max(NOISE);
        if self.is_above {
            self.is_above = self.ac > -far;
        } else if self.ac > far {
            self.is_above = true;
            self.upwards();
        }
        if self.since > PERIOD_MAX {
            self.swings = 0;
        }
    }

    fn upwards(&mut self) {
        let period_q4 = self.since.min(PERIOD_MAX) << 4;
        self.since = 0;
        self.period_q4 = match self.swings {
            0 => 0,
            1 => period_q4,
            _ => ((3 * u32::from(self.period_q4) + u32::from(period_q4) + 2) / 4) as u16,
        };
        self.swings = self.swings.wrapping_add(1).max(1);
    }

    /// A mean over the gap would be of another time, and swings cannot be counted over it.
    pub const fn miss(&mut self) {
        (self.sum, self.count, self.swings) = (0, 0, 0);
    }

    /// 1/16 of a sample; None without samples or after more than a cycle of them.
    pub fn take_mean_q4(&mut self) -> Option<i32> {
        let (sum, count) = (core::mem::take(&mut self.sum), core::mem::take(&mut self.count));
        let whole = (1..=u32::from(FRAMES_PER_SLOW_FRAME)).contains(&count);
        whole.then(|| ((sum << 4) / count) as i32)
    }

    pub const fn period_q4(&self) -> u16 {
        if self.swings < 2 { 0 } else { self.period_q4 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};
    use std::vec::Vec;
    use tenax_hal_shim::channel::{FRAME_HZ, SAMPLE_MAX};

    #[derive(Default)]
    struct Float {
        states: [f64; 4],
        primed: bool,
    }

    impl Float {
        fn pass(&mut self, n: usize, hz: u32, x: f64) -> f64 {
            let y = self.states[n] + PI * f64::from(hz) / f64::from(FRAME_HZ) * (x - self.states[n]);
            self.states[n] = 2.0 * y - self.states[n];
            y
        }

        fn process(&mut self, sample: u16) -> (f64, f64) {
            let x = f64::from(sample) - f64::from(MIDDLE);
            if !self.primed {
                self.primed = true;
                self.states[0] = x;
            }
            let once = x - self.pass(0, BAND_LOW_HZ, x);
            let twice = once - self.pass(1, BAND_LOW_HZ, once);
            let ac = self.pass(2, BAND_HIGH_HZ, twice);
            (ac, self.pass(3, ENVELOPE_HZ, ac.abs()))
        }
    }

    fn signals() -> Vec<(&'static str, Vec<u16>)> {
        let max = f64::from(SAMPLE_MAX);
        let tone = |hz: f64, size: f64| {
            (0..20_000)
                .map(move |n| (8_190.0 + size * (TAU * hz * f64::from(n) / 2e3).sin()).round() as u16)
                .collect()
        };
        let noise = |n: u32| (n.wrapping_mul(0x9E37_79B9) >> 18) as u16;
        std::vec![
            ("quiet", std::vec![3_000; 20_000]),
            ("slow slip", tone(48.0, 40.0)),
            ("fast slip", tone(145.0, 8_000.0)),
            ("ends", (0..20_000).map(|n| if n / 7 % 2 == 0 { 0 } else { SAMPLE_MAX }).collect()),
            ("ramps", (0..20_000).map(|n| ((f64::from(n % 500) / 499.0) * max) as u16).collect()),
            ("noise", (0..20_000).map(noise).map(|n| n.min(SAMPLE_MAX)).collect()),
        ]
    }

    #[test]
    fn both_parts_are_those_of_f64_within_2_lsb() {
        for (name, samples) in signals() {
            let (mut split, mut float) = (Split::default(), Float::default());
            for (n, cycle) in samples.chunks_exact(25).enumerate() {
                for &sample in cycle {
                    split.process(sample);
                    let (ac, envelope) = float.process(sample);
                    let lsb = |fixed: i32| f64::from(fixed) / f64::from(1 << Q);
                    let error = (lsb(split.ac) - ac).abs().max((lsb(split.envelope) - envelope).abs());
                    assert!(error < 2.0, "{name}, cycle {n}: {error}");
                }
                let mean = cycle.iter().map(|&sample| f64::from(sample)).sum::<f64>() / 25.0;
                let error = (f64::from(split.take_mean_q4().unwrap()) / 16.0 - mean).abs();
                assert!(error < 2.0, "{name}, cycle {n}: dc {error}");
            }
        }
    }

    #[test]
    fn a_tone_has_its_period_and_an_even_ramp_has_no_ac_part() {
        for hz in [12.0, 48.0, 145.0, 200.0] {
            let mut split = Split::default();
            for n in 0..4_000 {
                split.process((8_190.0 + 300.0 * (TAU * hz * f64::from(n) / 2e3).sin()) as u16);
            }
            let measured = 16.0 * 2e3 / f64::from(split.period_q4());
            assert!((measured / hz - 1.0).abs() < 0.05 && split.swings > 10, "{measured} Hz for {hz} Hz");
        }
        let mut split = Split::default();
        for n in 0..2_000 {
            split.process(1_000 + 4 * n);
        }
        assert!(split.envelope < 2 << Q, "{}", split.envelope >> Q);
        assert_eq!(split.period_q4(), 0);
    }

    #[test]
    fn a_mean_of_other_than_a_cycle_at_most_is_none() {
        let mut split = Split::default();
        assert_eq!(split.take_mean_q4(), None);
        (0..26).for_each(|_| split.process(100));
        assert_eq!(split.take_mean_q4(), None);
        (0..25).for_each(|_| split.process(SAMPLE_MAX));
        assert_eq!(split.take_mean_q4(), Some(i32::from(SAMPLE_MAX) * 16));
    }
}
