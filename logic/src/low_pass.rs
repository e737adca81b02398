//! First-order low-pass in 32 bits: the bilinear transform of a single pole with its zero at Nyquist.
//!
//! ```text
//! d = k (x - s)      y = s + d      s' = y + d        k = pi f / fs
//! ```
//!
//! A step is rounded down, so an output settles within `1 / k` units below its input: 32 units at 20 Hz.

use tenax_hal_shim::channel::FRAME_HZ;

/// The state is an `i32` in the signal's unit, beginning at the signal's rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LowPass {
    /// Q32, below 2^31.
    k: i32,
}

impl LowPass {
    /// Corner frequency, above 0 and below 300 Hz, at one sample a frame (2 kHz).
    pub const fn of(hz: f64) -> Self {
        assert!(hz > 0.0 && hz < 300.0, "k is below 1/2, or a step response would overshoot");
        Self { k: (core::f64::consts::PI * 4_294_967_296.0 * hz / FRAME_HZ as f64) as i32 }
    }

    /// Signal and state within +-2^30 stay there, as long as no difference of two samples leaves an `i32`.
    #[inline]
    pub fn process(self, state: &mut i32, x: i32) -> i32 {
        let difference = i64::from(x.wrapping_sub(*state));
        let y = state.wrapping_add(((difference * i64::from(self.k)) >> 32) as i32);
        *state = (y << 1).wrapping_sub(*state);
        y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_followed_without_overshoot_and_settles_just_below() {
        for hz in [1.0, 20.0, 150.0, 299.0] {
            let low_pass = LowPass::of(hz);
            for step in [1, 1_000, (1 << 30) - 1, -(1 << 30)] {
                let mut state = 0;
                let mut last = 0;
                for _ in 0..20_000 {
                    let y = low_pass.process(&mut state, step);
                    assert!(
                        if step < 0 { (step..=last).contains(&y) } else { (last..=step).contains(&y) },
                        "{hz} {y}"
                    );
                    last = y;
                }
                let settled_within = (f64::from(FRAME_HZ) / (core::f64::consts::PI * hz)).ceil() as i32;
                assert!((step - last).abs() <= settled_within, "{hz} Hz, {step}: {last}");
            }
        }
    }
}
