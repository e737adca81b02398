//! The stages of an analogue front end, in `f64`, settled before the first sample.

use biquad::{Biquad, Coefficients, DirectForm2Transposed, Q_BUTTERWORTH_F64, ToHertz, Type};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    Low,
    High,
}

/// Filters a series by a second-order Butterworth. A corner that is not below half the rate leaves it as it is.
pub fn pass(pass: Pass, corner_hz: f64, rate_hz: f64, values: &mut [f64]) {
    let kind = match pass {
        Pass::Low => Type::LowPass,
        Pass::High => Type::HighPass,
    };
    let Some(&first) = values.first().filter(|_| corner_hz > 0.0 && corner_hz < rate_hz / 2.0) else {
        return;
    };
    let coefficients =
        Coefficients::<f64>::from_params(kind, rate_hz.hz(), corner_hz.hz(), Q_BUTTERWORTH_F64);
    let Ok(coefficients) = coefficients else { return };
    let mut filter = DirectForm2Transposed::<f64>::new(coefficients);
    // A Butterworth pair has forgotten all but e^-40 of its past after ten periods of its corner.
    for _ in 0..(10.0 * rate_hz / corner_hz) as usize {
        filter.run(first);
    }
    for value in values {
        *value = filter.run(*value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn tone(hz: f64, rate_hz: f64) -> Vec<f64> {
        (0..rate_hz as usize).map(|n| (TAU * hz * n as f64 / rate_hz).sin()).collect()
    }

    fn rms_of_second_half(values: &[f64]) -> f64 {
        let half = &values[values.len() / 2..];
        (half.iter().map(|v| v * v).sum::<f64>() / half.len() as f64).sqrt()
    }

    #[test]
    fn the_corner_is_three_decibels_down() {
        for kind in [Pass::Low, Pass::High] {
            let mut values = tone(100.0, 16_000.0);
            pass(kind, 100.0, 16_000.0, &mut values);
            let gain = rms_of_second_half(&values) * 2f64.sqrt();
            assert!((gain - 0.5f64.sqrt()).abs() < 1e-3, "{kind:?}: {gain}");
        }
    }
}
