//! The network in the firmware's integers.

use anyhow::anyhow;
use tenax_logic::array::{FEATURES, Features, Layer, Mlp};
use tenax_sim::array::network::{fixed, square};

use crate::train::features::Sequence;
use crate::train::network::{H1, H2, Network};
use crate::train::table::Table;

/// Bits of a weight, the sign's one included.
const BITS: u32 = 8;
/// Largest activation over the largest one seen, before it saturates.
const HEADROOM: f32 = 1.5;

/// Weights as integers, row by row; biases; shifts.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantised {
    pub first: (Vec<Vec<i16>>, Vec<i32>, u32),
    pub second: (Vec<Vec<i16>>, Vec<i32>, u32),
    pub last: (Vec<i16>, i32),
    /// Integer logits for one of the float network's.
    pub per_logit: f64,
}

impl Quantised {
    /// Rounds a network; activations are measured on `table`. The units of the first layer are scaled so that a unit's weights before and after it are about as large (Nagel et al. 2019,
    /// cross-layer equalisation): a ReLU does not mind, and no unit loses more to rounding than another.
    pub fn of(network: &Network, table: &Table) -> Self {
        let network = equalised(network);
        let (mut seen_max, mut hidden_max) = (0f32, 0f32);
        for row in table.rows() {
            let [seen, hidden] = network.hidden(row);
            seen_max = seen.into_iter().fold(seen_max, f32::max);
            hidden_max = hidden.into_iter().fold(hidden_max, f32::max);
        }
        let first_scale = scale(&network.first, FEATURES);
        let (first_shift, seen_scale) = shift(first_scale, seen_max);
        let second_scale = scale(&network.second, H1);
        let (second_shift, hidden_scale) = shift(second_scale * seen_scale, hidden_max);
        let last_scale = scale(&network.last, H2);
        let rows = |weights: &[f32], inputs: usize, scale: f64| -> Vec<Vec<i16>> {
            let rounded = |row: &[f32]| row.iter().map(|w| (f64::from(*w) * scale).round() as i16).collect();
            weights.chunks_exact(inputs).map(rounded).collect()
        };
        // Half a step more, so that the shift rounds to nearest.
        let biases = |biases: &[f32], scale: f64, shift: u32| -> Vec<i32> {
            let half = f64::from((1u32 << shift) >> 1);
            biases.iter().map(|b| ((f64::from(*b) * scale).round() + half) as i32).collect()
        };
        let per_logit = last_scale * hidden_scale;
        let first_biases = biases(&network.first_bias, first_scale, first_shift);
        let second_biases = biases(&network.second_bias, second_scale * seen_scale, second_shift);
        Self {
            first: (rows(&network.first, FEATURES, first_scale), first_biases, first_shift),
            second: (rows(&network.second, H1, second_scale), second_biases, second_shift),
            last: (
                rows(&network.last, H2, last_scale).pop().unwrap_or_default(),
                (f64::from(network.last_bias) * per_logit).round() as i32,
            ),
            per_logit,
        }
    }

    /// Logits of a sequence in units of the float network's. Fails if a sum of the firmware's network could overflow.
    pub fn logits(&self, sequence: &Sequence) -> anyhow::Result<Vec<f64>> {
        let too_large = |_| anyhow!("a sum of the network could overflow");
        let Self { first, second, last, .. } = self;
        let network = Mlp {
            first: Layer::new(square(&first.0)?, fixed(&first.1)?, first.2).map_err(too_large)?,
            second: Layer::new(square(&second.0)?, fixed(&second.1)?, second.2).map_err(too_large)?,
            last: Layer::new([fixed(&last.0)?], [last.1], 0).map_err(too_large)?,
        };
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
    for unit in 0..H1 {
        let before = largest(&network.first[unit * FEATURES..][..FEATURES]);
        let column = || (unit..H1 * H2).step_by(H1);
        let after = column().map(|n| network.second[n].abs()).fold(0f32, f32::max);
        if before <= 0.0 || after <= 0.0 {
            continue;
        }
        let scale = (after / before).sqrt();
        network.first[unit * FEATURES..][..FEATURES].iter_mut().for_each(|weight| *weight *= scale);
        network.first_bias[unit] *= scale;
        column().for_each(|n| network.second[n] /= scale);
    }
    network
}

fn largest(weights: &[f32]) -> f32 {
    weights.iter().fold(0.0, |largest, weight| largest.max(weight.abs()))
}

/// Integers for a weight of 1: as many as the bits allow, and as few as keep every sum of full-scale inputs in an `i32`.
fn scale(weights: &[f32], inputs: usize) -> f64 {
    let heaviest =
        weights.chunks_exact(inputs).map(|row| row.iter().map(|w| f64::from(w.abs())).sum::<f64>());
    // Full scale is 2^15; a quarter of the range is left to the bias and to rounding.
    let by_sum = 0.75 * f64::from(1 << 16) / heaviest.fold(1e-12, f64::max);
    by_sum.min(f64::from((1 << (BITS - 1)) - 1) / f64::from(largest(weights)).max(1e-12))
}

/// Bits by which sums of a scale are shifted so that activations do not saturate, and the scale afterwards.
fn shift(scale: f64, largest: f32) -> (u32, f64) {
    let most = f64::from(largest * HEADROOM) * scale / f64::from(i16::MAX);
    let shift = most.max(1.0).log2().ceil() as u32;
    (shift, scale / f64::from(1u32 << shift))
}
