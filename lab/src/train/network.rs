//! The perceptron in single precision, in the firmware's order of layers (Bamshad 2023, section 5.3).

use candle_core::{Device, Tensor, Var};
use candle_nn::optim::{AdamW, Optimizer, ParamsAdamW};
use rand::seq::SliceRandom;
use rand::{SeedableRng, rngs::ChaCha8Rng};
use rand_distr::{Distribution, StandardNormal};
use tenax_logic::array::FEATURES;

use crate::train::fit::{Candidate, Linear};
use crate::train::table::{Standard, Table};

/// Units of the hidden layers.
pub const H1: usize = 32;
pub const H2: usize = 16;
/// Rows of one gradient.
const BATCH: usize = 256;

/// A network that takes features as they are. Weights are row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    pub first: Vec<f32>,
    pub first_bias: Vec<f32>,
    pub second: Vec<f32>,
    pub second_bias: Vec<f32>,
    pub last: Vec<f32>,
    pub last_bias: f32,
}

impl Network {
    /// Activations of the two hidden layers.
    pub fn hidden(&self, row: &[f32]) -> [Vec<f32>; 2] {
        let seen = layer(&self.first, &self.first_bias, row);
        let hidden = layer(&self.second, &self.second_bias, &seen);
        [seen, hidden]
    }

    pub fn logits(&self, table: &Table) -> Vec<f64> {
        let logit = |row| {
            let [_, hidden] = self.hidden(row);
            f64::from(self.last_bias + hidden.iter().zip(&self.last).map(|(h, w)| h * w).sum::<f32>())
        };
        table.rows().map(logit).collect()
    }
}

fn layer(weights: &[f32], bias: &[f32], inputs: &[f32]) -> Vec<f32> {
    let unit = |(row, bias): (&[f32], &f32)| {
        (bias + row.iter().zip(inputs).map(|(w, x)| w * x).sum::<f32>()).max(0.0)
    };
    weights.chunks_exact(inputs.len()).zip(bias).map(unit).collect()
}

/// A network that is learning, on the common scale.
pub struct Learner {
    vars: [Var; 6],
    standard: Standard,
    candidate: Candidate,
    rng: ChaCha8Rng,
}

impl Learner {
    /// Random weights, or those of a linear model: two units of each layer carry that one's logit and its negative. Fails if candle fails.
    pub fn new(
        standard: &Standard,
        candidate: Candidate,
        seed: u64,
        begin: Option<&Linear>,
    ) -> anyhow::Result<Self> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        // He et al. 2015: a deviation of sqrt(2 / inputs) keeps the size of what a ReLU hands on.
        let mut draw = |count: usize, inputs: usize| -> Vec<f32> {
            let deviation = (2.0 / inputs as f32).sqrt();
            let normals = StandardNormal.sample_iter(&mut rng).take(count);
            normals.map(|normal: f32| normal * deviation).collect()
        };
        let mut first = draw(H1 * FEATURES, FEATURES);
        let mut second = draw(H2 * H1, H1);
        let mut last = draw(H2, H2);
        let mut first_bias = vec![0.0; H1];
        if let Some((weights, bias)) = begin {
            last.fill(0.0);
            for (unit, sign) in [(0, 1.0), (1, -1.0)] {
                for (to, weight) in first[unit * FEATURES..].iter_mut().zip(weights) {
                    *to = sign * weight;
                }
                first_bias[unit] = sign * bias;
                second[unit * H1..][..H1].fill(0.0);
                second[unit * H1 + unit] = 1.0;
                last[unit] = sign;
            }
        }
        let var = |values: Vec<f32>, shape: (usize, usize)| -> candle_core::Result<Var> {
            Var::from_tensor(&Tensor::from_vec(values, shape, &Device::Cpu)?)
        };
        let vars = [
            var(first, (H1, FEATURES))?,
            var(first_bias, (1, H1))?,
            var(second, (H2, H1))?,
            var(vec![0.0; H2], (1, H2))?,
            var(last, (1, H2))?,
            var(vec![0.0], (1, 1))?,
        ];
        Ok(Self { vars, standard: standard.clone(), candidate, rng })
    }

    fn forward(&self, rows: &Tensor) -> candle_core::Result<Tensor> {
        let [first, first_bias, second, second_bias, last, last_bias] = &self.vars;
        let seen = rows.matmul(&first.t()?)?.broadcast_add(first_bias)?.relu()?;
        let hidden = seen.matmul(&second.t()?)?.broadcast_add(second_bias)?.relu()?;
        hidden.matmul(&last.t()?)?.broadcast_add(last_bias)?.squeeze(1)
    }

    /// Learns a table for the candidate's passes, over which the learning rate falls to nothing as a cosine; after each pass `seen` gets
    /// the network and says whether to go on. With `balanced`, both kinds of rows count alike in sum. Fails if candle fails.
    pub fn learn(
        &mut self,
        table: &Table,
        balanced: bool,
        seen: &mut dyn FnMut(usize, &Network) -> bool,
    ) -> anyhow::Result<()> {
        let Candidate { epochs, learning_rate, decay, .. } = self.candidate;
        let rows = Tensor::from_vec(self.standard.apply(table), (table.count(), FEATURES), &Device::Cpu)?;
        let weights = if balanced { table.class_weights() } else { [1.0; 2] };
        let mut order: Vec<usize> = (0..table.count()).collect();
        let batches = order.len().div_ceil(BATCH).max(1);
        let config = ParamsAdamW { lr: learning_rate, weight_decay: decay, ..ParamsAdamW::default() };
        let mut optimizer = AdamW::new(self.vars.to_vec(), config)?;
        for epoch in 0..epochs {
            order.shuffle(&mut self.rng);
            for (n, batch) in order.chunks(BATCH).enumerate() {
                let done = (epoch * batches + n) as f64 / (epochs * batches) as f64;
                let rate = learning_rate * 0.5 * (1.0 + (std::f64::consts::PI * done).cos());
                optimizer.set_learning_rate(rate);
                let index: Vec<u32> = batch.iter().map(|&row| row as u32).collect();
                let inputs = rows.index_select(&Tensor::from_vec(index, batch.len(), &Device::Cpu)?, 0)?;
                let slips = batch.iter().map(|&row| usize::from(table.slips[row]));
                let labels: Vec<f32> = slips.clone().map(|slip| slip as f32).collect();
                let weights: Vec<f32> = slips.map(|slip| weights[slip]).collect();
                let loss = cross_entropy(&self.forward(&inputs)?, &labels, &weights)?;
                optimizer.backward_step(&loss)?;
            }
            if !seen(epoch, &self.network()?) {
                break;
            }
        }
        Ok(())
    }

    /// The network for features as they are. Fails if candle fails.
    pub fn network(&self) -> candle_core::Result<Network> {
        let values = |var: &Var| var.flatten_all()?.to_vec1::<f32>();
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

/// Weighted cross entropy of logits, in a form that no logit is too large for. Fails if candle fails.
fn cross_entropy(logits: &Tensor, labels: &[f32], weights: &[f32]) -> candle_core::Result<Tensor> {
    let labels = Tensor::from_slice(labels, labels.len(), &Device::Cpu)?;
    let weights = Tensor::from_slice(weights, weights.len(), &Device::Cpu)?;
    let rest = logits.abs()?.neg()?.exp()?.affine(1.0, 1.0)?.log()?;
    let loss = (logits.relu()? - (logits * labels)?)?;
    ((loss + rest)? * weights)?.mean_all()
}
