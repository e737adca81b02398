//! The perceptron in single precision: two hidden layers, the second of which looks back at what the first made of
//! earlier frames (Bamshad 2023, section 5.3; the firmware's order, [`tenax_logic::array::network`]).

use candle_core::{DType, Device, Tensor, Var};
use candle_nn::optim::{AdamW, Optimizer, ParamsAdamW};
use rand::seq::SliceRandom;
use rand::{SeedableRng, rngs::ChaCha8Rng};
use rand_distr::{Distribution, StandardNormal};
use tenax_logic::array::FEATURES;

use crate::train::linear::Linear;
use crate::train::table::{Standard, Table};

/// Units of the first hidden layer.
pub const H1: usize = 32;
/// Units of the second.
pub const H2: usize = 16;
/// Rows of one gradient.
const BATCH: usize = 256;

/// How it learns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Frames seen: 1 is the present only.
    pub look_back: usize,
    /// Passes over the rows, over which the learning rate falls to nothing as a cosine.
    pub epochs: usize,
    /// AdamW's first learning rate.
    pub learning_rate: f64,
    /// AdamW's weight decay.
    pub decay: f64,
    /// Whether steps that slip and steps that do not count alike in sum, however few there are of one.
    pub balanced: bool,
    /// Seed of first weights and of the order of rows.
    pub seed: u64,
}

/// A network that takes features as they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    /// Row by row, `H1` rows of [`FEATURES`].
    pub first: Vec<f32>,
    pub first_bias: Vec<f32>,
    /// Row by row, `H2` rows of `look_back` times `H1`, the present frame first.
    pub second: Vec<f32>,
    pub second_bias: Vec<f32>,
    /// `H2` weights.
    pub last: Vec<f32>,
    pub last_bias: f32,
}

impl Network {
    /// Frames seen.
    pub fn look_back(&self) -> usize {
        self.second.len() / (H1 * H2)
    }

    /// What the first layer makes of a row.
    pub fn see(&self, row: &[f32]) -> Vec<f32> {
        layer(&self.first, &self.first_bias, row)
    }

    /// The logit of what was seen, the present frame first.
    pub fn judge(&self, seen: &[f32]) -> f64 {
        let hidden = layer(&self.second, &self.second_bias, seen);
        f64::from(self.last_bias + hidden.iter().zip(&self.last).map(|(h, w)| h * w).sum::<f32>())
    }

    /// Logits of a table's rows that can look back far enough, in their order.
    pub fn logits(&self, table: &Table) -> Vec<f64> {
        let seen: Vec<Vec<f32>> = (0..table.len()).map(|row| self.see(table.row(row))).collect();
        let back = self.look_back();
        let judge = |row: usize| {
            let frames: Vec<f32> = (0..back).flat_map(|n| seen[row - n].iter().copied()).collect();
            self.judge(&frames)
        };
        table.ready(back).into_iter().map(judge).collect()
    }
}

fn layer(weights: &[f32], bias: &[f32], inputs: &[f32]) -> Vec<f32> {
    weights
        .chunks_exact(inputs.len())
        .zip(bias)
        .map(|(row, bias)| (bias + row.iter().zip(inputs).map(|(w, x)| w * x).sum::<f32>()).max(0.0))
        .collect()
}

/// A network that is learning, on the common scale.
pub struct Learner {
    vars: [Var; 6],
    standard: Standard,
    settings: Settings,
    rng: ChaCha8Rng,
}

impl Learner {
    /// One that has learned nothing, or that begins as a linear model: two units of each layer carry that one's logit and
    /// its negative, so it can be unlearned but need not be found. Fails if candle fails.
    pub fn new(standard: &Standard, settings: Settings, begin: Option<&Linear>) -> anyhow::Result<Self> {
        let mut rng = ChaCha8Rng::seed_from_u64(settings.seed);
        let seen = H1 * settings.look_back;
        // He et al. 2015: a deviation of sqrt(2 / inputs) keeps the size of what a ReLU hands on.
        let mut draw = |count: usize, inputs: usize| -> Vec<f32> {
            let deviation = (2.0 / inputs as f32).sqrt();
            (0..count)
                .map(|_| {
                    let normal: f32 = StandardNormal.sample(&mut rng);
                    normal * deviation
                })
                .collect()
        };
        let mut first = draw(H1 * FEATURES, FEATURES);
        let mut second = draw(H2 * seen, seen);
        let mut last = draw(H2, H2);
        let mut first_bias = vec![0.0; H1];
        if let Some(linear) = begin {
            let mut bias = linear.bias;
            let mut weights = Vec::new();
            for ((weight, mean), scale) in linear.weights.iter().zip(&standard.mean).zip(&standard.scale) {
                bias += weight * mean;
                weights.push(if *scale > 0.0 { weight / scale } else { 0.0 });
            }
            last.fill(0.0);
            for (unit, sign) in [(0, 1.0), (1, -1.0)] {
                for (to, weight) in first[unit * FEATURES..].iter_mut().zip(&weights) {
                    *to = sign * weight;
                }
                first_bias[unit] = sign * bias;
                second[unit * seen..][..seen].fill(0.0);
                second[unit * seen + unit] = 1.0;
                last[unit] = sign;
            }
        }
        let var = |values: Vec<f32>, shape: (usize, usize)| -> candle_core::Result<Var> {
            Var::from_tensor(&Tensor::from_vec(values, shape, &Device::Cpu)?)
        };
        let vars = [
            var(first, (H1, FEATURES))?,
            var(first_bias, (1, H1))?,
            var(second, (H2, seen))?,
            var(vec![0.0; H2], (1, H2))?,
            var(last, (1, H2))?,
            var(vec![0.0], (1, 1))?,
        ];
        Ok(Self { vars, standard: standard.clone(), settings, rng })
    }

    fn forward(&self, rows: &Tensor) -> candle_core::Result<Tensor> {
        let [first, first_bias, second, second_bias, last, last_bias] = &self.vars;
        let back = self.settings.look_back;
        let batch = rows.dim(0)? / back;
        let seen = rows.matmul(&first.t()?)?.broadcast_add(first_bias)?.relu()?;
        let seen = seen.reshape((batch, back * H1))?;
        let hidden = seen.matmul(&second.t()?)?.broadcast_add(second_bias)?.relu()?;
        hidden.matmul(&last.t()?)?.broadcast_add(last_bias)?.squeeze(1)
    }

    /// Learns a table; after each pass `seen` is shown the network, and says whether to go on. Fails if candle fails.
    pub fn learn(
        &mut self,
        table: &Table,
        seen: &mut dyn FnMut(usize, &Network) -> bool,
    ) -> anyhow::Result<()> {
        let Settings { look_back, epochs, learning_rate, decay, .. } = self.settings;
        let rows = Tensor::from_vec(self.standard.apply(table), (table.len(), FEATURES), &Device::Cpu)?;
        let weights = if self.settings.balanced { table.class_weights() } else { [1.0; 2] };
        let mut order = table.ready(look_back);
        let batches = order.len().div_ceil(BATCH).max(1);
        let config = ParamsAdamW { lr: learning_rate, weight_decay: decay, ..ParamsAdamW::default() };
        let mut optimizer = AdamW::new(self.vars.to_vec(), config)?;
        for epoch in 0..epochs {
            order.shuffle(&mut self.rng);
            for (n, batch) in order.chunks(BATCH).enumerate() {
                let done = (epoch * batches + n) as f64 / (epochs * batches) as f64;
                optimizer
                    .set_learning_rate(learning_rate * 0.5 * (1.0 + (std::f64::consts::PI * done).cos()));
                let index: Vec<u32> = batch
                    .iter()
                    .flat_map(|&row| (0..look_back).map(move |back| (row - back) as u32))
                    .collect();
                let count = index.len();
                let inputs = rows.index_select(&Tensor::from_vec(index, count, &Device::Cpu)?, 0)?;
                let labels: Vec<f32> = batch.iter().map(|&row| table.labels[row]).collect();
                let weights: Vec<f32> =
                    labels.iter().map(|&label| weights[usize::from(label > 0.5)]).collect();
                let loss = cross_entropy(&self.forward(&inputs)?, &labels, &weights)?;
                optimizer.backward_step(&loss)?;
            }
            if !seen(epoch, &self.network()?) {
                break;
            }
        }
        Ok(())
    }

    /// What it has learned, for features as they are. Fails if candle fails.
    pub fn network(&self) -> candle_core::Result<Network> {
        let values = |var: &Var| var.flatten_all()?.to_dtype(DType::F32)?.to_vec1::<f32>();
        let [first, first_bias, second, second_bias, last, last_bias] = &self.vars;
        let (mut first, mut first_bias) = (values(first)?, values(first_bias)?);
        for (row, bias) in first.chunks_exact_mut(FEATURES).zip(&mut first_bias) {
            for ((weight, mean), scale) in row.iter_mut().zip(&self.standard.mean).zip(&self.standard.scale) {
                *weight *= scale;
                *bias -= *weight * mean;
            }
        }
        Ok(Network {
            first,
            first_bias,
            second: values(second)?,
            second_bias: values(second_bias)?,
            last: values(last)?,
            last_bias: values(last_bias)?.first().copied().unwrap_or_default(),
        })
    }
}

/// Weighted cross entropy of logits, written so that no logit is too large for it. Fails if candle fails.
pub fn cross_entropy(logits: &Tensor, labels: &[f32], weights: &[f32]) -> candle_core::Result<Tensor> {
    let labels = Tensor::from_slice(labels, labels.len(), &Device::Cpu)?;
    let weights = Tensor::from_slice(weights, weights.len(), &Device::Cpu)?;
    let rest = logits.abs()?.neg()?.exp()?.affine(1.0, 1.0)?.log()?;
    let loss = (logits.relu()? - (logits * labels)?)?;
    ((loss + rest)? * weights)?.mean_all()
}
