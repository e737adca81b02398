//! Parts that films add to an output, in one multiplication each: weight over maximum, Q26, within 2^-24 of
//! [`Network::parts`](super::Network::parts).

use super::arithmetic::Reciprocal;
use super::network::Weight;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gain {
    largest: u32,
    shift: u32,
    /// Weight over the maximum's mantissa, Q26, within +-16.
    factor: i32,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Gains<const N: usize>(pub [Gain; N]);

impl<const N: usize> Default for Gains<N> {
    fn default() -> Self {
        Self([Gain { largest: 1, shift: 0, factor: 0 }; N])
    }
}

impl<const N: usize> Gains<N> {
    pub fn of(weights: &[Weight], maxima: &[u32]) -> Self {
        let mut gains = Self::default();
        for ((gain, weight), &largest) in gains.0.iter_mut().zip(weights).zip(maxima) {
            // A maximum is at most the ceiling of the normaliser, far below 2^31.
            let reciprocal = Reciprocal::of(largest);
            // Q27 times Q30, of which 31 bits go: Q26. A weight of 8 and a mantissa of 2 are 2^30.
            let factor = (i64::from(weight.into_bits()) * i64::from(reciprocal.mantissa)) >> 31;
            *gain = Gain { largest, shift: reciprocal.shift.saturating_sub(1), factor: factor as i32 };
        }
        gains
    }
}

impl Gain {
    /// Part of an output, Q26. `reading` must not be negative.
    #[inline]
    pub fn part(self, reading: i32) -> i32 {
        let reading = ((reading as u32).min(self.largest) << self.shift) as i32;
        // Q31 of the mantissa's reading, times Q26: the upper word is Q25.
        (((i64::from(reading) * i64::from(self.factor)) >> 32) as i32) << 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hebbian::{Activations, Network, Normaliser, NormaliserConfig, Sense};

    #[test]
    fn a_part_is_that_of_the_network() {
        static CONFIG: NormaliserConfig<4> = NormaliserConfig {
            senses: [Sense::Vibration; 4],
            floors: [1; 4],
            ceiling: 1 << 17,
            average_shift: 0,
        };
        let mut random = 1u32;
        let mut next = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            random
        };
        for _ in 0..20_000 {
            let maxima = core::array::from_fn(|_| (next() >> 15 >> (next() >> 28)).max(1));
            let weights =
                [core::array::from_fn(|_| Weight::from_bits((next() as i32) >> 1 >> (next() >> 28)))];
            let readings: [i32; 4] = core::array::from_fn(|_| (next() >> 14 >> (next() >> 28)) as i32);
            let normaliser = Normaliser::from_maxima(&CONFIG, &maxima);
            let mut activations = Activations::<4>::default();
            normaliser.renew(&CONFIG, 0, &readings, &mut activations);
            let network = Network::<4, 1>::from_weights(&weights);
            let gains = Gains::<4>::of(&network.weights()[0], &maxima);
            let parts = gains.0.iter().zip(readings).map(|(gain, reading)| gain.part(reading));
            for (part, exact) in parts.zip(network.parts(0, 0..4, &activations)) {
                assert!((part - exact).abs() <= 16, "{part} {exact} of {readings:?} {maxima:?} {weights:?}");
            }
        }
    }
}
