//! The network in the firmware's integers.

use anyhow::anyhow;
use tenax_sim::array::network::{fixed, square};
use tenax_logic::array::{FEATURES, Features, Layer, Mlp};

use crate::train::features::Sequence;
use crate::train::network::{H1, H2, Network};
use crate::train::table::Table;

/// Weights as integers, and what a logit of theirs is worth.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantised {
    /// First layer's rows.
    pub first: Vec<Vec<i16>>,
    pub first_bias: Vec<i32>,
    pub first_shift: u32,
    /// Second layer's rows, all frames of a unit in one, the present frame first.
    pub second: Vec<Vec<i16>>,
    pub second_bias: Vec<i32>,
    pub second_shift: u32,
    pub last: Vec<i16>,
    pub last_bias: i32,
    /// Integer logits for one of the float network's.
    pub per_logit: f64,
}

/// How much more than the largest activation seen an activation may be before it saturates.
const HEADROOM: f32 = 1.5;

impl Quantised {
    /// Rounds a network to weights of at most `bits` bits (the sign's one included); `table` is what its activations are
    /// measured on.
    ///
    /// The units of the first layer are scaled so that a unit's weights before and after it are about as large (Nagel et
    /// al. 2019, cross-layer equalisation): a ReLU does not mind, and no unit loses more to rounding than another.
    pub fn of(network: &Network, table: &Table, bits: u32) -> Self {
        let network = equalised(network);
        let back = network.look_back();
        let (mut seen_max, mut hidden_max) = (0f32, 0f32);
        let seen: Vec<Vec<f32>> = (0..table.len()).map(|row| network.see(table.row(row))).collect();
        for row in table.ready(back) {
            let frames: Vec<f32> = (0..back).flat_map(|n| seen[row - n].iter().copied()).collect();
            seen_max = frames.iter().copied().fold(seen_max, f32::max);
            hidden_max = network
                .second
                .chunks_exact(frames.len())
                .zip(&network.second_bias)
                .map(|(weights, bias)| bias + weights.iter().zip(&frames).map(|(w, x)| w * x).sum::<f32>())
                .fold(hidden_max, f32::max);
        }
        let first_scale = scale(&network.first, FEATURES, bits);
        let (first_shift, seen_scale) = shift(first_scale, seen_max);
        let second_scale = scale(&network.second, H1 * back, bits);
        let (second_shift, hidden_scale) = shift(second_scale * seen_scale, hidden_max);
        let last_scale = scale(&network.last, H2, bits);
        let rows = |weights: &[f32], inputs: usize, scale: f64| -> Vec<Vec<i16>> {
            weights
                .chunks_exact(inputs)
                .map(|row| row.iter().map(|w| (f64::from(*w) * scale).round() as i16).collect())
                .collect()
        };
        // Half a step more, so that the shift rounds to nearest.
        let biases = |biases: &[f32], scale: f64, shift: u32| -> Vec<i32> {
            biases
                .iter()
                .map(|b| ((f64::from(*b) * scale).round() + f64::from((1u32 << shift) >> 1)) as i32)
                .collect()
        };
        let per_logit = last_scale * hidden_scale;
        Self {
            first: rows(&network.first, FEATURES, first_scale),
            first_bias: biases(&network.first_bias, first_scale, first_shift),
            first_shift,
            second: rows(&network.second, H1 * back, second_scale),
            second_bias: biases(&network.second_bias, second_scale * seen_scale, second_shift),
            second_shift,
            last: rows(&network.last, H2, last_scale).pop().unwrap_or_default(),
            last_bias: (f64::from(network.last_bias) * per_logit).round() as i32,
            per_logit,
        }
    }

    /// The firmware's network of these weights. Fails if the sizes are others, or a sum could overflow.
    pub fn integer(&self) -> anyhow::Result<Mlp> {
        let too_large = |_| anyhow!("a sum of the network could overflow");
        Ok(Mlp {
            first: Layer::new(square(&self.first)?, fixed(&self.first_bias)?, self.first_shift)
                .map_err(too_large)?,
            second: Layer::new(square(&self.second)?, fixed(&self.second_bias)?, self.second_shift)
                .map_err(too_large)?,
            last: Layer::new([fixed(&self.last)?], [self.last_bias], 0).map_err(too_large)?,
        })
    }

    /// Logits of a sequence in units of the float network's. Fails if the network is none of the firmware's.
    pub fn logits(&self, sequence: &Sequence) -> anyhow::Result<Vec<f64>> {
        let network = self.integer()?;
        let logit = |features: &Features| {
            let mut seen = [0; H1];
            network.first.activate(features, 0..H1, &mut seen);
            f64::from(network.judge(&seen)) / self.per_logit
        };
        Ok(sequence.features.iter().map(logit).collect())
    }
}

/// The same network with its first layer's units scaled.
fn equalised(network: &Network) -> Network {
    let mut network = network.clone();
    let seen = network.look_back() * H1;
    for unit in 0..H1 {
        let before = largest(&network.first[unit * FEATURES..][..FEATURES]);
        let columns = (0..network.second.len()).filter(|n| n % seen % H1 == unit);
        let after = columns.map(|n| network.second[n].abs()).fold(0f32, f32::max);
        if before <= 0.0 || after <= 0.0 {
            continue;
        }
        let scale = (after / before).sqrt();
        for weight in &mut network.first[unit * FEATURES..][..FEATURES] {
            *weight *= scale;
        }
        network.first_bias[unit] *= scale;
        for n in (0..network.second.len()).filter(|n| n % seen % H1 == unit) {
            network.second[n] /= scale;
        }
    }
    network
}

fn largest(weights: &[f32]) -> f32 {
    weights.iter().fold(0.0, |largest, weight| largest.max(weight.abs()))
}

/// Integers for a weight of 1: as many as `bits` allow, and as few as keep every sum of full-scale inputs in an `i32`.
fn scale(weights: &[f32], inputs: usize, bits: u32) -> f64 {
    let heaviest =
        weights.chunks_exact(inputs).map(|row| row.iter().map(|w| f64::from(w.abs())).sum::<f64>());
    // Full scale is 2^15; a quarter of the range is left to the bias and to rounding.
    let sum = heaviest.fold(1e-12, f64::max);
    let by_sum = 0.75 * f64::from(1 << 16) / sum;
    by_sum.min(f64::from((1 << (bits - 1)) - 1) / f64::from(largest(weights)).max(1e-12))
}

/// By how many bits sums of a scale are shifted so that activations do not saturate, and the scale afterwards.
fn shift(scale: f64, largest: f32) -> (u32, f64) {
    let most = f64::from(largest * HEADROOM) * scale / f64::from(i16::MAX);
    let shift = most.max(1.0).log2().ceil() as u32;
    (shift, scale / f64::from(1u32 << shift))
}
