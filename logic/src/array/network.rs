//! Two quantised hidden layers and a logit (Bamshad 2023, section 5.3). The queue holds the first layer's
//! outputs, where the paper's holds whole features.
//!
//! ```text
//! h1 = relu(W1 x + b1) >> shift             x: features of this slow frame
//! h2 = relu(W2 [h1, h1 of the L - 1 frames before] + b2) >> shift
//! logit = w3 h2 + b3                         slip is more likely than not above 0
//! ```
//!
//! Inputs and activations are `i16`, sums `i32`: [`Layer::new`] refuses a layer whose sums could overflow. A
//! shift rounds down.

use core::ops::Range;

pub const ACTIVATION_MAX: i16 = i16::MAX;
/// Bound of an input's magnitude.
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
    pub const ZERO: Self = Self { weights: [[0; I]; O], bias: [0; O], shift: 0 };

    /// Fails if `|bias| + 2^15 (sum of |weights|)` of a row is 2^31 or more, or `shift` is above 31. 100
    /// weights of 8 bits always fit.
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
        self.add_sums(inputs, self.bias)
    }

    #[inline]
    fn add_sums(&self, inputs: &[i16; I], mut sums: [i32; O]) -> [i32; O] {
        for (sum, row) in sums.iter_mut().zip(&self.weights) {
            *sum = dot(row, inputs, *sum);
        }
        sums
    }

    /// Writes the activations of a range of outputs to their places. Not inlined: its unrolled products are long.
    #[inline(never)]
    pub fn activate(&self, inputs: &[i16; I], outputs: Range<usize>, activations: &mut [i16; O]) {
        let (Some(rows), Some(bias), Some(activations)) =
            (self.weights.get(outputs.clone()), self.bias.get(outputs.clone()), activations.get_mut(outputs))
        else {
            return;
        };
        for ((slot, row), &bias) in activations.iter_mut().zip(rows).zip(bias) {
            *slot = self.activation(dot(row, inputs, bias));
        }
    }

    fn activation(&self, sum: i32) -> i16 {
        (sum >> self.shift).clamp(0, i32::from(ACTIVATION_MAX)) as i16
    }
}

/// `sum + sum over n of row[n] inputs[n]`: [`Layer::new`] rules an overflow out.
#[inline]
fn dot<const I: usize>(row: &[i16; I], inputs: &[i16; I], sum: i32) -> i32 {
    row.iter().zip(inputs).fold(sum, |sum, (&w, &x)| sum + i32::from(w) * i32::from(x))
}

/// `I` inputs, `H1` units in the first hidden layer, `H2` in the second, which sees the last `L` slow frames
/// (1: the newest only).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mlp<const I: usize, const H1: usize, const L: usize, const H2: usize> {
    first: Layer<I, H1>,
    /// Newest frame first. Their sums add up; the first one's shift is used.
    second: [Layer<H1, H2>; L],
    last: Layer<H2, 1>,
}

impl<const I: usize, const H1: usize, const L: usize, const H2: usize> Mlp<I, H1, L, H2> {
    /// Fails if the sum over the layers of `second` could overflow `i32`.
    pub const fn new(
        first: Layer<I, H1>,
        second: [Layer<H1, H2>; L],
        last: Layer<H2, 1>,
    ) -> Result<Self, TooLarge> {
        const { assert!(L >= 1, "a network sees at least the present") }
        let mut output = 0;
        while output < H2 {
            let (mut size, mut frame) = (0, 0);
            while frame < L {
                size += second[frame].bias[output].unsigned_abs() as u64;
                let mut input = 0;
                while input < H1 {
                    size += second[frame].weights[output][input].unsigned_abs() as u64 * INPUT_SIZE as u64;
                    input += 1;
                }
                frame += 1;
            }
            if size > i32::MAX as u64 {
                return Err(TooLarge { output });
            }
            output += 1;
        }
        Ok(Self { first, second, last })
    }

    pub fn see(&self, features: &[i16; I]) -> [i16; H1] {
        let mut seen = [0; H1];
        self.see_some(features, 0..H1, &mut seen);
        seen
    }

    pub fn see_some(&self, features: &[i16; I], units: Range<usize>, seen: &mut [i16; H1]) {
        self.first.activate(features, units, seen);
    }

    pub fn judge(&self, seen: &[[i16; H1]; L]) -> i32 {
        let (mut sums, mut shift) = ([0; H2], 0);
        for (layer, seen) in self.second.iter().zip(seen).rev() {
            for (sum, bias) in sums.iter_mut().zip(&layer.bias) {
                *sum += bias;
            }
            sums = layer.add_sums(seen, sums);
            shift = layer.shift;
        }
        let hidden = sums.map(|sum| (sum >> shift).clamp(0, i32::from(ACTIVATION_MAX)) as i16);
        let [logit] = self.last.sums(&hidden);
        logit
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LookBack<const H1: usize, const L: usize> {
    seen: [[i16; H1]; L],
    missing: usize,
}

impl<const H1: usize, const L: usize> Default for LookBack<H1, L> {
    fn default() -> Self {
        Self { seen: [[0; H1]; L], missing: L }
    }
}

impl<const H1: usize, const L: usize> LookBack<H1, L> {
    /// None until `L` have been queued.
    pub fn push(&mut self, seen: [i16; H1]) -> Option<&[[i16; H1]; L]> {
        for n in (1..L).rev() {
            self.seen[n] = self.seen[n - 1];
        }
        if let Some(newest) = self.seen.first_mut() {
            *newest = seen;
        }
        self.missing = self.missing.saturating_sub(1);
        (self.missing == 0).then_some(&self.seen)
    }

    pub fn clear(&mut self) {
        self.missing = L;
    }
}
