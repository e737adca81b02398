//! Outputs (Tada 2006, equations 3 and 4) and learning (equations 5 and 6).
//!
//! | quantity | format | range | rounding |
//! |---|---|---|---|
//! | activation t | `i32` Q26 | +-1 | by the normaliser, 2^-25 |
//! | weight w, as used | `i32` Q27 | +-8 | the upper word of the next line |
//! | weight w, as kept | `i64` Q59 | +-8 | none: the products below are exact |
//! | sum of t w | `i64` Q53 | 31 inputs: below 2^61 | none |
//! | output o | `i32` Q26 | +-1 | down |
//! | \|w\| + delta, for r | `u32` Q23 | 0..16 | down |
//! | (sum of \|w\|) + delta, the divisor | `u32` Q23 | 31 inputs: below 256, 2^31 | none |
//! | alpha v / divisor, its exponent apart | `i32` Q34 | +-2^-3 | to zero, 2^-27 of itself |
//! | alpha r v | `i32` Q33 | +-2^-4, since r <= 1 | down |
//! | alpha r v t, beta w | `i64` Q59 | 2^55, 2^58 | none |

use core::ops::Range;

use dsp_fixedpoint::Q32;

use super::activations::Activations;
use super::arithmetic::Reciprocal;
use super::rule::Rule;
use tenax_hal_shim::words::Code;

/// 2^27 is 1.
pub type Weight = Q32<27>;
/// 2^26 is 1.
pub type Output = Q32<26>;
const LIMIT: i32 = (1 << 30) - 1;
const MAGNITUDE_SHIFT: u32 = 27 - 23;
const INPUTS_MAX: usize = 31;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Network<const INPUTS: usize, const OUTPUTS: usize> {
    /// Q59.
    weights: [[i64; INPUTS]; OUTPUTS],
    /// Sum of each output's weight magnitudes, Q23: part of the next update's divisor.
    magnitudes: [u32; OUTPUTS],
}

impl<const INPUTS: usize, const OUTPUTS: usize> Default for Network<INPUTS, OUTPUTS> {
    /// All weights are 0, so the outputs equal the teacher's codes.
    fn default() -> Self {
        const { assert!(INPUTS >= 1 && INPUTS <= INPUTS_MAX, "a network has 1 to 31 inputs") }
        Self { weights: [[0; INPUTS]; OUTPUTS], magnitudes: [0; OUTPUTS] }
    }
}

impl<const INPUTS: usize, const OUTPUTS: usize> Network<INPUTS, OUTPUTS> {
    /// Part of each receptor before clipping, units of [`Output`], rounded down; empty out of range.
    #[inline]
    pub fn parts(
        &self,
        output: usize,
        receptors: Range<usize>,
        activations: &Activations<INPUTS>,
    ) -> impl Iterator<Item = i32> {
        let weights = self.weights.get(output).and_then(|weights| weights.get(receptors.clone()));
        let activations = activations.as_bits().get(receptors);
        weights
            .unwrap_or_default()
            .iter()
            .zip(activations.unwrap_or_default())
            .map(|(&weight, &t)| part(weight, t))
    }

    #[inline]
    pub fn parts_of(&self, receptor: usize, activations: &Activations<INPUTS>) -> [i32; OUTPUTS] {
        let Some(&t) = activations.as_bits().get(receptor) else { return [0; OUTPUTS] };
        core::array::from_fn(|output| part(self.weights[output][receptor], t))
    }

    #[inline]
    pub fn sum_of_parts(
        &self,
        output: usize,
        receptors: Range<usize>,
        activations: &Activations<INPUTS>,
    ) -> i64 {
        self.parts(output, receptors, activations).map(i64::from).sum()
    }

    /// Equations 5 and 6. [`Code::Zero`] only forgets; an output without a code keeps its weights.
    pub fn learn(&mut self, rule: &Rule, activations: &Activations<INPUTS>, codes: &[Option<Code>; OUTPUTS]) {
        for ((weights, magnitudes), code) in self.weights.iter_mut().zip(&mut self.magnitudes).zip(codes) {
            let Some(code) = code else { continue };
            let reciprocal = Reciprocal::of(rule.delta + *magnitudes);
            // alpha <= 0.06 in Q35 and the mantissa <= 2 in Q30: at most 0.12 in Q34, below 2^31.
            let scaled_alpha = ((u64::from(rule.alpha) * u64::from(reciprocal.mantissa)) >> 31) as i32;
            let scaled_alpha_v = code.sign() * scaled_alpha;
            // The divisor is below 2^31, so it has a leading zero to spare: a share of it stays a positive i32.
            let shift = reciprocal.shift - 1;
            *magnitudes = 0;
            for (weight, &t) in weights.iter_mut().zip(activations.as_bits()) {
                let share = ((magnitude(*weight) + rule.delta) << shift) as i32;
                let alpha_r_v = (i64::from(share) * i64::from(scaled_alpha_v)) >> 32;
                // Two multiply-accumulates on the kept weight. Neither can leave 64 bits: 2^62 + 2^55 + 2^58.
                *weight = limited(
                    *weight
                        + i64::from(alpha_r_v as i32) * i64::from(t)
                        + i64::from(rule.minus_beta) * i64::from(in_use(*weight)),
                );
                *magnitudes += magnitude(*weight);
            }
        }
    }

    pub fn weights(&self) -> [[Weight; INPUTS]; OUTPUTS] {
        self.weights.map(|row| row.map(|weight| Weight::from_bits(in_use(weight))))
    }

    pub fn from_weights(weights: &[[Weight; INPUTS]; OUTPUTS]) -> Self {
        let mut network = Self::default();
        let rows = network.weights.iter_mut().zip(&mut network.magnitudes);
        for ((row, magnitudes), from) in rows.zip(weights) {
            for (weight, from) in row.iter_mut().zip(from) {
                *weight = limited(i64::from(from.into_bits()) << 32);
                *magnitudes += magnitude(*weight);
            }
        }
        network
    }
}

/// Q27, rounded down.
const fn in_use(weight: i64) -> i32 {
    (weight >> 32) as i32
}

/// Product, units of [`Output`], rounded down: the upper word of `(2 w) (16 t)`, one instruction.
const fn part(weight: i64, t: i32) -> i32 {
    (((in_use(weight) << 1) as i64 * (t << 4) as i64) >> 32) as i32
}

/// |w|, Q23, below 2^26. A negative number's complement is its magnitude less 2^-27.
const fn magnitude(weight: i64) -> u32 {
    let weight = in_use(weight);
    ((weight ^ (weight >> 31)) as u32) >> MAGNITUDE_SHIFT
}

/// Limits a Q59 weight to +-[`LIMIT`] by its upper word, one SSAT instruction.
fn limited(weight: i64) -> i64 {
    let upper = in_use(weight).clamp(-LIMIT - 1, LIMIT);
    (i64::from(upper) << 32) | (weight & 0xFFFF_FFFF)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_the_products_floor_at_every_end() {
        let weights = [0, 1, -1, 5 << 20, LIMIT, -LIMIT - 1, LIMIT - 1];
        let ts = [0, 1, -1, 12_345_678, -12_345_678, 1 << 26, -(1 << 26)];
        for weight in weights {
            for t in ts {
                assert_eq!(
                    i64::from(part(i64::from(weight) << 32, t)),
                    (i64::from(weight) * i64::from(t)) >> 27
                );
            }
        }
    }
}
