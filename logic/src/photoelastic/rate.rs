//! Rate of slip from amplitude and frequency of the ac part: a fit of logarithms to one material. On another
//! material it is off by a factor.

use crate::emg::level::{self, LEVEL_Q};

/// `log2 rate = a + b log2 amplitude + c log2 frequency + d log2 force` (no published law), factors Q10:
/// part of the span (Q20), mHz, mN, um/s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RateFit {
    pub constant: i32,
    pub amplitude: i32,
    pub frequency: i32,
    pub force: i32,
}

const RATE_MAX_UM_S: i32 = 20_000;

/// Q10, of 1 to 2^17.
fn log2(number: i32) -> i32 {
    level::log2(number.clamp(1, 1 << 17) as u32)
}

/// `2^x`, x in Q10, rounded down; a parabola between powers, within 0.3 %.
fn exp2(x: i32) -> i32 {
    let (whole, part) = (x >> LEVEL_Q, i64::from(x & ((1 << LEVEL_Q) - 1)));
    // 2^p = 1 + p - 0.3437 p (1 - p), Q20.
    let bent = (1 << 20) + (part << 10) - 352 * part * ((1 << LEVEL_Q) - part) / 1_024;
    match whole {
        ..0 => 0,
        0..20 => (bent >> (20 - whole)) as i32,
        _ => RATE_MAX_UM_S,
    }
}

impl RateFit {
    /// log2, Q10, of amplitude (part of the span, Q20), period (1/16 frames, as mHz) and force (mN).
    pub fn features(amplitude_q20: i32, period_q4: u16, force_mn: i32) -> [i32; 3] {
        // 2000 frames a second in 1/16: 32 000 000 mHz over the period. A quarter of it has room.
        let quarter_mhz = 8_000_000 / i32::from(period_q4.max(1));
        [log2(amplitude_q20), log2(quarter_mhz) + (2 << LEVEL_Q), log2(force_mn)]
    }

    pub fn rate_um_s(&self, amplitude_q20: i32, period_q4: u16, force_mn: i32) -> i32 {
        let [amplitude, frequency, force] = Self::features(amplitude_q20, period_q4, force_mn).map(i64::from);
        let sum = amplitude * i64::from(self.amplitude)
            + frequency * i64::from(self.frequency)
            + force * i64::from(self.force);
        let log2_rate = i64::from(self.constant) + (sum >> LEVEL_Q);
        exp2(log2_rate.clamp(-(1 << 20), 1 << 20) as i32).min(RATE_MAX_UM_S)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithm_and_power_are_f64s_within_a_percent() {
        for number in (1..1 << 17).step_by(13) {
            let exact = f64::from(number).log2();
            assert!((f64::from(log2(number)) / 1_024.0 - exact).abs() < 0.011, "{number}");
        }
        for x in 4 << LEVEL_Q..14 << LEVEL_Q {
            let exact = (f64::from(x) / 1_024.0).exp2();
            assert!((f64::from(exp2(x)) - exact).abs() < 0.005 * exact + 1.0, "{x}: {} {exact}", exp2(x));
        }
        assert_eq!((exp2(-1), exp2(i32::MAX), log2(i32::MIN)), (0, RATE_MAX_UM_S, 0));
    }
}
