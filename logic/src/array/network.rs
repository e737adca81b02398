//! Two quantised hidden layers and a logit (Bamshad 2023, section 5.3), of one slow frame. A layer gives
//! `relu(W x + b) >> shift`, rounded down: `i16` inputs, `i32` sums that [`Layer::new`] keeps from overflow.

use core::ops::Range;

use tenax_smlad::{ROWS, dot, dot_rows};

use super::{Aligned, FEATURES, HIDDEN};

pub const ACTIVATION_MAX: i16 = i16::MAX;
const INPUT_SIZE: u32 = 1 << 15;

/// Output whose sum could overflow `i32` with the largest inputs, or whose shift is above 31.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge {
    pub output: usize,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layer<const I: usize, const O: usize> {
    weights: [[i16; I]; O],
    bias: [i32; O],
    shift: u32,
}

impl<const I: usize, const O: usize> Layer<I, O> {
    /// Fails if `|bias| + 2^15 (sum of |weights|)` of a row is 2^31 or more, or `shift` is above 31.
    pub const fn new(weights: [[i16; I]; O], bias: [i32; O], shift: u32) -> Result<Self, TooLarge> {
        let mut output = 0;
        while output < O {
            let mut size = bias[output].unsigned_abs() as u64;
            let mut input = 0;
            while input < I {
                size += weights[output][input].unsigned_abs() as u64 * INPUT_SIZE as u64;
                input += 1;
            }
            if size > i32::MAX as u64 || shift > 31 {
                return Err(TooLarge { output });
            }
            output += 1;
        }
        Ok(Self { weights, bias, shift })
    }

    #[inline]
    pub fn sums(&self, inputs: &[i16; I]) -> [i32; O] {
        let mut sums = self.bias;
        for (sum, row) in sums.iter_mut().zip(&self.weights) {
            *sum = dot(row, inputs, *sum);
        }
        sums
    }

    /// Writes the activations of a range of outputs to their places. Not inlined: its unrolled products are long.
    #[inline(never)]
    pub fn activate(&self, inputs: &Aligned<[i16; I]>, outputs: Range<usize>, activations: &mut [i16; O]) {
        let (Some(rows), Some(bias), Some(activations)) =
            (self.weights.get(outputs.clone()), self.bias.get(outputs.clone()), activations.get_mut(outputs))
        else {
            return;
        };
        let (blocks, rest) = rows.as_chunks::<ROWS>();
        let (biases, rest_biases) = bias.as_chunks::<ROWS>();
        let (slots, rest_slots) = activations.as_chunks_mut::<ROWS>();
        for ((slots, rows), bias) in slots.iter_mut().zip(blocks).zip(biases) {
            *slots = dot_rows(rows, inputs, *bias).map(|sum| self.activation(sum));
        }
        for ((slot, row), &bias) in rest_slots.iter_mut().zip(rest).zip(rest_biases) {
            *slot = self.activation(dot(row, &inputs.0, bias));
        }
    }

    fn activation(&self, sum: i32) -> i16 {
        (sum >> self.shift).clamp(0, i32::from(ACTIVATION_MAX)) as i16
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mlp {
    pub first: Layer<FEATURES, { HIDDEN[0] }>,
    pub second: Layer<{ HIDDEN[0] }, { HIDDEN[1] }>,
    pub last: Layer<{ HIDDEN[1] }, 1>,
}

impl Mlp {
    pub fn judge(&self, seen: &Aligned<[i16; HIDDEN[0]]>) -> i32 {
        let mut hidden = [0; HIDDEN[1]];
        self.second.activate(seen, 0..HIDDEN[1], &mut hidden);
        let [logit] = self.last.sums(&hidden);
        logit
    }
}
