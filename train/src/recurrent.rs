//! The paper's two recurrent rivals: LSTM + perceptron, and LSTM autoencoder + perceptron (Bamshad 2023, section 5.1).
//!
//! Both see the last [`FRAMES`] frames. The first learns the label end to end; the second first learns to give the frames
//! back from the encoder's last state, and a perceptron then learns the label from that state alone.

use candle_core::{DType, Device, Tensor, Var};
use candle_nn::optim::{AdamW, Optimizer, ParamsAdamW};
use candle_nn::rnn::{LSTM, LSTMConfig, RNN};
use candle_nn::{VarBuilder, VarMap};
use rand::seq::SliceRandom;
use rand::{SeedableRng, rngs::ChaCha8Rng};
use rand_distr::{Distribution, StandardNormal};
use tenax_logic::array::FEATURES;

use crate::network::cross_entropy;
use crate::table::{Standard, Table};

/// Frames seen.
pub const FRAMES: usize = 10;
/// Units of a cell.
pub const CELLS: usize = 16;
/// Units of the perceptron's hidden layer.
pub const HIDDEN: usize = 16;
/// Sequences of one gradient.
const BATCH: usize = 256;

/// A recurrent detector.
pub struct Recurrent {
    encoder: LSTM,
    head: [Var; 4],
    standard: Standard,
}

/// How it learns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Whether the encoder learns to give its frames back instead of the label.
    pub autoencoder: bool,
    /// Passes.
    pub epochs: usize,
    /// Sequences learned in a pass, drawn anew for each.
    pub sequences: usize,
    pub seed: u64,
}

impl Recurrent {
    /// Learns a table; `progress` is told which part is done. Fails if candle fails.
    pub fn fit(
        table: &Table,
        standard: &Standard,
        settings: Settings,
        progress: &mut dyn FnMut(f64),
    ) -> anyhow::Result<Self> {
        let mut rng = ChaCha8Rng::seed_from_u64(settings.seed);
        let map = VarMap::new();
        let builder = VarBuilder::from_varmap(&map, DType::F32, &Device::Cpu);
        let encoder = LSTM::new(FEATURES, CELLS, LSTMConfig::default(), builder.pp("encoder"))?;
        let decoder = LSTM::new(CELLS, CELLS, LSTMConfig::default(), builder.pp("decoder"))?;
        seed(&map, &mut rng)?;
        let mut draw = |shape: (usize, usize)| -> candle_core::Result<Var> {
            let deviation = (2.0 / shape.1 as f32).sqrt();
            let values: Vec<f32> = (0..shape.0 * shape.1)
                .map(|_| {
                    let normal: f32 = StandardNormal.sample(&mut rng);
                    normal * deviation
                })
                .collect();
            Var::from_tensor(&Tensor::from_vec(values, shape, &Device::Cpu)?)
        };
        let zeros = |size: usize| Var::zeros((1, size), DType::F32, &Device::Cpu);
        let head = [draw((HIDDEN, CELLS))?, zeros(HIDDEN)?, draw((1, HIDDEN))?, zeros(1)?];
        let back = draw((FEATURES, CELLS))?;
        let detector = Self { encoder, head, standard: standard.clone() };
        let rows = Tensor::from_vec(standard.apply(table), (table.len(), FEATURES), &Device::Cpu)?;
        let mut order = table.ready(FRAMES);
        let recurrent: Vec<Var> = map.all_vars();
        let heads: Vec<Var> = detector.head.to_vec();
        let stages: Vec<(bool, Vec<Var>)> = if settings.autoencoder {
            let mut all = sorted(&map);
            all.push(back.clone());
            vec![(true, all), (false, heads)]
        } else {
            let encoder_only = recurrent.len() / 2;
            let mut all: Vec<Var> = sorted(&map).into_iter().skip(encoder_only).collect();
            all.extend(heads);
            vec![(false, all)]
        };
        let passes = stages.len() * settings.epochs;
        for (stage, (gives_back, vars)) in stages.into_iter().enumerate() {
            let mut optimizer = AdamW::new(vars, ParamsAdamW { lr: 3e-3, ..ParamsAdamW::default() })?;
            for epoch in 0..settings.epochs {
                let done = epoch as f64 / settings.epochs as f64;
                optimizer.set_learning_rate(3e-3 * 0.5 * (1.0 + (std::f64::consts::PI * done).cos()));
                order.shuffle(&mut rng);
                for batch in order[..settings.sequences.min(order.len())].chunks(BATCH) {
                    let frames = frames(&rows, batch)?;
                    let state = detector.encode(&frames)?;
                    let loss = if gives_back {
                        // The decoder is shown the state in every frame, and gives the frames back newest first, which
                        // is how the encoder last saw them (Srivastava et al. 2015).
                        let mut now = decoder.zero_state(batch.len())?;
                        let mut loss = Tensor::zeros((), DType::F32, &Device::Cpu)?;
                        for frame in frames.iter().rev() {
                            now = decoder.step(&state, &now)?;
                            loss = (loss + (now.h().matmul(&back.t()?)? - frame)?.sqr()?.mean_all()?)?;
                        }
                        loss
                    } else {
                        let state = if settings.autoencoder { state.detach() } else { state };
                        let labels: Vec<f32> = batch.iter().map(|&row| table.labels[row]).collect();
                        cross_entropy(&detector.judge(&state)?, &labels, &vec![1.0; labels.len()])?
                    };
                    optimizer.backward_step(&loss)?;
                }
                progress((stage * settings.epochs + epoch + 1) as f64 / passes as f64);
            }
        }
        Ok(detector)
    }

    fn encode(&self, frames: &[Tensor]) -> candle_core::Result<Tensor> {
        let mut state = self.encoder.zero_state(frames.first().map_or(Ok(0), |frame| frame.dim(0))?)?;
        for frame in frames {
            state = self.encoder.step(frame, &state)?;
        }
        Ok(state.h().clone())
    }

    fn judge(&self, state: &Tensor) -> candle_core::Result<Tensor> {
        let [first, first_bias, last, last_bias] = &self.head;
        let hidden = state.matmul(&first.t()?)?.broadcast_add(first_bias)?.relu()?;
        hidden.matmul(&last.t()?)?.broadcast_add(last_bias)?.squeeze(1)
    }

    /// Logits of a table's rows that have enough frames, in their order. Fails if candle fails.
    pub fn logits(&self, table: &Table) -> anyhow::Result<Vec<f64>> {
        let rows = Tensor::from_vec(self.standard.apply(table), (table.len(), FEATURES), &Device::Cpu)?;
        let mut logits = Vec::new();
        for batch in table.ready(FRAMES).chunks(4_096) {
            let said = self.judge(&self.encode(&frames(&rows, batch)?)?)?.to_vec1::<f32>()?;
            logits.extend(said.into_iter().map(f64::from));
        }
        Ok(logits)
    }
}

/// The variables in the order of their names: a map's own order changes from run to run.
fn sorted(map: &VarMap) -> Vec<Var> {
    let Ok(data) = map.data().lock() else { return Vec::new() };
    let mut named: Vec<(String, Var)> = data.iter().map(|(name, var)| (name.clone(), var.clone())).collect();
    named.sort_by(|a, b| a.0.cmp(&b.0));
    named.into_iter().map(|(_, var)| var).collect()
}

/// First weights of our own drawing: candle's cannot be seeded on a CPU.
fn seed(map: &VarMap, rng: &mut ChaCha8Rng) -> candle_core::Result<()> {
    for var in sorted(map) {
        let deviation = 1.0 / (CELLS as f32).sqrt();
        let values: Vec<f32> = (0..var.elem_count())
            .map(|_| {
                let normal: f32 = StandardNormal.sample(rng);
                0.5 * deviation * normal
            })
            .collect();
        var.set(&Tensor::from_vec(values, var.shape(), &Device::Cpu)?)?;
    }
    Ok(())
}

/// The frames up to each row of a batch, the oldest first.
fn frames(rows: &Tensor, batch: &[usize]) -> candle_core::Result<Vec<Tensor>> {
    (0..FRAMES)
        .rev()
        .map(|back| {
            let index: Vec<u32> = batch.iter().map(|&row| (row - back) as u32).collect();
            rows.index_select(&Tensor::from_vec(index, batch.len(), &Device::Cpu)?, 0)
        })
        .collect()
}
