//! Single precision.

/// `O` sums of `I` products.
pub struct FloatDense<const I: usize, const O: usize> {
    weights: [[f32; I]; O],
    bias: [f32; O],
}

impl<const I: usize, const O: usize> FloatDense<I, O> {
    pub const fn specimen(seed: &mut u32) -> Self {
        let mut layer = Self { weights: [[0.0; I]; O], bias: [0.0; O] };
        let weights = layer.weights.as_flattened_mut();
        let mut n = 0;
        while n < weights.len() {
            weights[n] = next(seed);
            n += 1;
        }
        let mut n = 0;
        while n < O {
            layer.bias[n] = next(seed);
            n += 1;
        }
        layer
    }

    pub fn sums(&self, inputs: &[f32; I]) -> [f32; O] {
        self.add_sums(inputs, self.bias)
    }

    /// Four rows at a time, so that an input is loaded once for all four.
    fn add_sums(&self, inputs: &[f32; I], mut sums: [f32; O]) -> [f32; O] {
        let (blocks, rest) = self.weights.as_chunks::<4>();
        let (block_sums, rest_sums) = sums.as_chunks_mut::<4>();
        for ([s0, s1, s2, s3], [r0, r1, r2, r3]) in block_sums.iter_mut().zip(blocks) {
            for ((((w0, w1), w2), w3), x) in r0.iter().zip(r1).zip(r2).zip(r3).zip(inputs) {
                *s0 += w0 * x;
                *s1 += w1 * x;
                *s2 += w2 * x;
                *s3 += w3 * x;
            }
        }
        for (sum, row) in rest_sums.iter_mut().zip(rest) {
            for (w, x) in row.iter().zip(inputs) {
                *sum += w * x;
            }
        }
        sums
    }
}

/// Within +-1/16.
const fn next(seed: &mut u32) -> f32 {
    *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    (*seed as i32 >> 16) as f32 / 524_288.0
}

/// The network of `logic` in single precision.
pub struct FloatMlp<const I: usize, const H1: usize, const L: usize, const H2: usize> {
    first: FloatDense<I, H1>,
    second: [FloatDense<H1, H2>; L],
    last: FloatDense<H2, 1>,
}

impl<const I: usize, const H1: usize, const L: usize, const H2: usize> FloatMlp<I, H1, L, H2> {
    pub const fn specimen(mut seed: u32) -> Self {
        let first = FloatDense::specimen(&mut seed);
        let mut second = [const { FloatDense::specimen(&mut 1) }; L];
        let mut n = 0;
        while n < L {
            second[n] = FloatDense::specimen(&mut seed);
            n += 1;
        }
        Self { first, second, last: FloatDense::specimen(&mut seed) }
    }

    pub fn judge(&self, back: &mut [[f32; H1]; L], inputs: &[f32; I]) -> f32 {
        back.rotate_right(1);
        back[0] = relu(self.first.sums(inputs));
        let mut sums = [0.0; H2];
        for (layer, seen) in self.second.iter().zip(&*back) {
            sums = layer.add_sums(seen, sums);
        }
        let [logit] = self.last.sums(&relu(sums));
        logit
    }
}

fn relu<const O: usize>(sums: [f32; O]) -> [f32; O] {
    sums.map(|sum| if sum > 0.0 { sum } else { 0.0 })
}

/// Frames that an LSTM is run over, from nothing, in each slow frame: as it was trained (`train/src/recurrent.rs`).
pub const LSTM_FRAMES: usize = 10;

/// An LSTM layer of `H` cells without peepholes, and `H`-16-1 behind it.
pub struct FloatLstm<const I: usize, const H: usize> {
    /// Input, forget, output gate and candidate: from the inputs, and from the last hidden state.
    from_inputs: [FloatDense<I, H>; 4],
    from_hidden: [FloatDense<H, H>; 4],
    hidden: FloatDense<H, 16>,
    last: FloatDense<16, 1>,
}

/// What the gates hear of the inputs of the last frames, the newest first: each frame's is made once.
pub struct LstmQueue<const H: usize>([[[f32; H]; 4]; LSTM_FRAMES]);

impl<const H: usize> Default for LstmQueue<H> {
    fn default() -> Self {
        Self([[[0.0; H]; 4]; LSTM_FRAMES])
    }
}

impl<const I: usize, const H: usize> FloatLstm<I, H> {
    pub const fn specimen(mut seed: u32) -> Self {
        let mut from_inputs = [const { FloatDense::specimen(&mut 1) }; 4];
        let mut from_hidden = [const { FloatDense::specimen(&mut 1) }; 4];
        let mut gate = 0;
        while gate < 4 {
            from_inputs[gate] = FloatDense::specimen(&mut seed);
            from_hidden[gate] = FloatDense::specimen(&mut seed);
            gate += 1;
        }
        let hidden = FloatDense::specimen(&mut seed);
        Self { from_inputs, from_hidden, hidden, last: FloatDense::specimen(&mut seed) }
    }

    pub fn judge(&self, queue: &mut LstmQueue<H>, inputs: &[f32; I]) -> f32 {
        queue.0.rotate_right(1);
        for (gate, from_inputs) in queue.0[0].iter_mut().zip(&self.from_inputs) {
            *gate = from_inputs.sums(inputs);
        }
        let (mut cell, mut hidden) = ([0.0; H], [0.0; H]);
        for heard in queue.0.iter().rev() {
            let mut gates = *heard;
            for (gate, from_hidden) in gates.iter_mut().zip(&self.from_hidden) {
                *gate = from_hidden.add_sums(&hidden, *gate);
            }
            let [input, forget, output, candidate] = gates;
            for n in 0..H {
                cell[n] = sigmoid(forget[n]) * cell[n] + sigmoid(input[n]) * tanh(candidate[n]);
                hidden[n] = sigmoid(output[n]) * tanh(cell[n]);
            }
        }
        let [logit] = self.last.sums(&relu(self.hidden.sums(&hidden)));
        logit
    }
}

fn sigmoid(x: f32) -> f32 {
    0.5 + 0.5 * tanh(0.5 * x)
}

/// Lambert's continued fraction to the seventh order: within 1e-4, a division and eleven other operations.
fn tanh(x: f32) -> f32 {
    let x = x.clamp(-4.97, 4.97);
    let xx = x * x;
    x * (135_135.0 + xx * (17_325.0 + xx * (378.0 + xx)))
        / (135_135.0 + xx * (62_370.0 + xx * (3_150.0 + 28.0 * xx)))
}
