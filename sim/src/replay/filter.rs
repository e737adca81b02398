//! The stages of an analogue front end, in `f64`, settled before the first sample.

use biquad::{Biquad, Coefficients, DirectForm2Transposed, Q_BUTTERWORTH_F64, ToHertz, Type};

#[derive(Clone, Debug)]
pub struct Filter(DirectForm2Transposed<f64>);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    Low,
    High,
}

impl Filter {
    /// A filter with this corner. None if the corner is not below half the rate: then there is nothing to filter.
    pub fn new(pass: Pass, corner_hz: f64, rate_hz: f64) -> Option<Self> {
        let kind = match pass {
            Pass::Low => Type::LowPass,
            Pass::High => Type::HighPass,
        };
        let valid = corner_hz > 0.0 && corner_hz < rate_hz / 2.0;
        let coefficients = valid.then(|| {
            Coefficients::<f64>::from_params(kind, rate_hz.hz(), corner_hz.hz(), Q_BUTTERWORTH_F64)
        })?;
        Some(Self(DirectForm2Transposed::new(coefficients.ok()?)))
    }

    pub fn apply(mut self, corner_hz: f64, rate_hz: f64, values: &mut [f64]) {
        let Some(&first) = values.first() else { return };
        // A Butterworth pair has forgotten all but e^-40 of its past after ten periods of its corner.
        let settle = (10.0 * rate_hz / corner_hz) as usize;
        for _ in 0..settle {
            self.0.run(first);
        }
        for value in values {
            *value = self.0.run(*value);
        }
    }
}

pub fn pass(pass: Pass, corner_hz: f64, rate_hz: f64, values: &mut [f64]) {
    if let Some(filter) = Filter::new(pass, corner_hz, rate_hz) {
        filter.apply(corner_hz, rate_hz, values);
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
