//! The network: two hidden layers and a logit, quantised, with a queue that looks back (Bamshad 2023, section 5.3).
//!
//! ```text
//! h1 = relu(W1 x + b1) >> shift             x: features of this slow frame
//! h2 = relu(W2 [h1, h1 of the L - 1 frames before] + b2) >> shift
//! logit = w3 h2 + b3                         slip is more likely than not above 0
//! ```
//!
//! The paper queues whole features before the first layer: five times 76 inputs, and most of the work done again in each
//! frame. Here what the first layer made of a frame is queued, so it is made once.
//!
//! | quantity | format | range |
//! |---|---|---|
//! | input, activation | `i16` | 0..2^15 - 1 behind a ReLU, saturated |
//! | weight | `i16`, of which a model uses 8 bits or what its sums leave | see [`Layer::new`] |
//! | bias, sum, logit | `i32` | cannot overflow: [`Layer::new`] refuses a layer whose sums could |
//!
//! A shift rounds down; to round to nearest, add half a step to the bias.

use core::ops::Range;

use super::dual::{self, Aligned, ROWS};

/// Largest activation of a hidden unit, where it saturates.
pub const ACTIVATION_MAX: i16 = i16::MAX;
/// Bound of an input's magnitude, 2^15.
const INPUT_SIZE: u32 = 1 << 15;

/// A refused layer: with the largest inputs the sum of this output could overflow `i32`, or the shift is above 31.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge {
    /// Index of the output.
    pub output: usize,
}

/// A fully connected layer: `I` inputs, `O` outputs.
#[derive(Clone, Debug, PartialEq, Eq)]
#[repr(C, align(8))]
pub struct Layer<const I: usize, const O: usize> {
    weights: [[i16; I]; O],
    bias: [i32; O],
    shift: u32,
}

impl<const I: usize, const O: usize> Layer<I, O> {
    /// A layer with weights and biases of 0.
    pub const ZERO: Self = Self { weights: [[0; I]; O], bias: [0; O], shift: 0 };

    /// A layer of `weights` (a row for each output), `bias` (units of the sum) and `shift` (bits by which a sum is shifted
    /// right to give an activation, 0 to 31).
    ///
    /// # Errors
    /// If `|bias| + 2^15 (sum of |weights|)` of a row is 2^31 or more, or `shift` is above 31. 100 weights of 8 bits always fit.
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

    /// Weighted sums of the inputs plus bias. Fastest if `I` and `O` are multiples of four.
    #[must_use]
    #[inline]
    pub fn sums(&self, inputs: &[i16; I]) -> [i32; O] {
        self.add_sums(inputs, self.bias)
    }

    /// Adds the weighted sums of the inputs to `sums`, without the bias.
    #[inline]
    fn add_sums(&self, inputs: &[i16; I], mut sums: [i32; O]) -> [i32; O] {
        let Aligned(inputs) = &Aligned(*inputs);
        let (blocks, rest) = self.weights.as_chunks::<ROWS>();
        let (block_sums, rest_sums) = sums.as_chunks_mut::<ROWS>();
        for (sums, rows) in block_sums.iter_mut().zip(blocks) {
            *sums = dual::dot_rows(rows, inputs, *sums);
        }
        for (sum, row) in rest_sums.iter_mut().zip(rest) {
            *sum = dual::portable::dot(row, inputs, *sum);
        }
        sums
    }

    /// Activations of a hidden layer: sums shifted right, then limited to 0..=[`ACTIVATION_MAX`].
    #[must_use]
    pub fn activations(&self, inputs: &[i16; I]) -> [i16; O] {
        self.activations_of(self.sums(inputs))
    }

    /// Writes the activations of a range of outputs to their places in `activations`, to split the work.
    /// Does nothing if the range exceeds the outputs. Not inlined, since its unrolled products are long.
    #[inline(never)]
    pub fn activate(&self, inputs: &[i16; I], outputs: Range<usize>, activations: &mut [i16; O]) {
        let Aligned(inputs) = &Aligned(*inputs);
        let (Some(weights), Some(bias), Some(activations)) =
            (self.weights.get(outputs.clone()), self.bias.get(outputs.clone()), activations.get_mut(outputs))
        else {
            return;
        };
        let (blocks, rest) = weights.as_chunks::<ROWS>();
        let (biases, rest_biases) = bias.as_chunks::<ROWS>();
        let (slots, rest_slots) = activations.as_chunks_mut::<ROWS>();
        for ((slots, rows), bias) in slots.iter_mut().zip(blocks).zip(biases) {
            *slots = dual::dot_rows(rows, inputs, *bias).map(|sum| self.activation(sum));
        }
        for ((slot, row), &bias) in rest_slots.iter_mut().zip(rest).zip(rest_biases) {
            *slot = self.activation(dual::portable::dot(row, inputs, bias));
        }
    }

    fn activations_of(&self, sums: [i32; O]) -> [i16; O] {
        sums.map(|sum| self.activation(sum))
    }

    fn activation(&self, sum: i32) -> i16 {
        (sum >> self.shift).clamp(0, i32::from(ACTIVATION_MAX)) as i16
    }
}

/// The network: `I` inputs, `H1` units in the first hidden layer, `H2` in the second. The second layer gets the first layer's
/// outputs of the last `L` slow frames (1: the newest only).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mlp<const I: usize, const H1: usize, const L: usize, const H2: usize> {
    first: Layer<I, H1>,
    /// Layers for this slow frame, the one before, and so on. Their sums add up; the first one's shift is used.
    second: [Layer<H1, H2>; L],
    last: Layer<H2, 1>,
}

impl<const I: usize, const H1: usize, const L: usize, const H2: usize> Mlp<I, H1, L, H2> {
    /// A network of these layers. `second` has one layer for each of the last `L` slow frames, the newest first; their biases
    /// add up, and the first one's shift is used.
    ///
    /// # Errors
    /// If the sum over the layers of `second` could overflow `i32`.
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

    /// Activations of the first layer for one slow frame's features, to be queued.
    #[must_use]
    pub fn see(&self, features: &[i16; I]) -> [i16; H1] {
        let mut seen = [0; H1];
        self.see_some(features, 0..H1, &mut seen);
        seen
    }

    /// Like [`see`](Self::see), for a range of units.
    pub fn see_some(&self, features: &[i16; I], units: Range<usize>, seen: &mut [i16; H1]) {
        self.first.activate(features, units, seen);
    }

    /// The logit from the first layer's activations of the last `L` slow frames.
    #[must_use]
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

/// Queue of the first layer's activations of the last `L` slow frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LookBack<const H1: usize, const L: usize> {
    /// The newest first.
    seen: [[i16; H1]; L],
    missing: usize,
}

impl<const H1: usize, const L: usize> Default for LookBack<H1, L> {
    /// An empty queue.
    fn default() -> Self {
        Self { seen: [[0; H1]; L], missing: L }
    }
}

impl<const H1: usize, const L: usize> LookBack<H1, L> {
    /// Queues the activations of a slow frame. None until `L` have been queued.
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

    /// Forgets: frames have gone unseen, and what is seen next does not follow on what was.
    pub fn clear(&mut self) {
        self.missing = L;
    }
}
