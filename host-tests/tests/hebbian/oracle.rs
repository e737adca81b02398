//! Equations 3 to 6 in `f64`, written as they stand in the paper.

use tenax_logic::hebbian::{Activations, Code, Config, Network};

pub const FULL_SCALE: f64 = 8.0;

pub fn exact<const N: usize>(activations: &Activations<N>) -> [f64; N] {
    activations.as_bits().map(|t| f64::from(t) / f64::from(1 << 26))
}

pub fn weights_of<const I: usize, const O: usize>(network: &Network<I, O>) -> [[f64; I]; O] {
    network.weights().map(|row| row.map(|weight| weight.as_f64()))
}

/// Outputs from touch alone (equations 3 and 4).
pub fn outputs<const I: usize, const O: usize>(network: &Network<I, O>, t: &Activations<I>) -> [f64; O] {
    let sum = |output| network.sum_of_parts(output, 0..I, t) as f64 / f64::from(1 << 26);
    std::array::from_fn(|output| sum(output).clamp(-1.0, 1.0))
}

#[derive(Clone, Copy, Debug)]
pub struct Rates {
    pub alpha: f64,
    pub beta: f64,
    pub delta: f64,
}

impl From<&Config> for Rates {
    fn from(config: &Config) -> Self {
        Self {
            alpha: f64::from(config.alpha_ppb) * 1e-9,
            beta: f64::from(config.beta_ppb) * 1e-9,
            delta: f64::from(config.delta_ppm) * 1e-6,
        }
    }
}

#[derive(Clone, Debug)]
pub struct Reference<const I: usize, const O: usize> {
    pub weights: [[f64; I]; O],
}

impl<const I: usize, const O: usize> Default for Reference<I, O> {
    fn default() -> Self {
        Self { weights: [[0.0; I]; O] }
    }
}

impl<const I: usize, const O: usize> Reference<I, O> {
    /// Equations 3 and 4.
    pub fn output(&self, t: &[f64; I], codes: &[Code; O]) -> [f64; O] {
        std::array::from_fn(|i| {
            let sum: f64 = t.iter().zip(&self.weights[i]).map(|(t, w)| t * w).sum();
            (sum + f64::from(codes[i].sign())).clamp(-1.0, 1.0)
        })
    }

    /// Equations 5 and 6.
    pub fn learn(&mut self, rates: &Rates, t: &[f64; I], codes: &[Code; O]) {
        for (row, code) in self.weights.iter_mut().zip(codes) {
            let v = f64::from(code.sign());
            let sum: f64 = row.iter().map(|w| w.abs()).sum();
            for (w, t) in row.iter_mut().zip(t) {
                let r = (w.abs() + rates.delta) / (sum + rates.delta);
                *w = (*w + rates.alpha * r * t * v - rates.beta * *w).clamp(-FULL_SCALE, FULL_SCALE);
            }
        }
    }
}
