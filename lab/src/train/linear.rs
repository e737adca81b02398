//! Logistic regression, from linfa.

use anyhow::Context;
use linfa::dataset::DatasetBase;
use linfa::traits::Fit;
use linfa_logistic::LogisticRegression;
use ndarray::{Array1, Array2};
use tenax_logic::array::FEATURES;

use crate::train::table::{Standard, Table};

/// A weighted sum.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    /// Weights of the features as they are.
    pub weights: Vec<f32>,
    /// What is added.
    pub bias: f32,
}

impl Linear {
    /// From weights and bias on the common scale.
    fn unscaled(weights: &[f64], bias: f64, standard: &Standard) -> Self {
        let mut model = Self { weights: Vec::new(), bias: 0.0 };
        let mut bias = bias;
        for ((weight, mean), scale) in weights.iter().zip(&standard.mean).zip(&standard.scale) {
            let weight = weight * f64::from(*scale);
            bias -= weight * f64::from(*mean);
            model.weights.push(weight as f32);
        }
        model.bias = bias as f32;
        model
    }
}

/// Rows that both kinds have about as many of: the rarer kind is repeated.
fn balanced(table: &Table, rows: impl Iterator<Item = usize>) -> Vec<usize> {
    let (slips, rest): (Vec<usize>, Vec<usize>) = rows.partition(|&row| table.labels[row] > 0.5);
    let (rare, often) = if slips.len() < rest.len() { (slips, rest) } else { (rest, slips) };
    let times = (often.len() as f64 / rare.len().max(1) as f64).round().max(1.0) as usize;
    let mut all = often;
    for _ in 0..times {
        all.extend(&rare);
    }
    all
}

fn dataset(table: &Table, rows: &[usize], standard: &Standard) -> DatasetBase<Array2<f64>, Array1<bool>> {
    let records = Array2::from_shape_fn((rows.len(), FEATURES), |(n, feature)| {
        f64::from((table.row(rows[n])[feature] - standard.mean[feature]) * standard.scale[feature])
    });
    let targets = rows.iter().map(|&row| table.labels[row] > 0.5).collect();
    DatasetBase::new(records, targets)
}

/// Logistic regression; with `alike`, both kinds count alike in sum. `ridge` is the penalty of a squared weight for each
/// row. Fails if there are not both kinds of rows, or the optimiser fails.
pub fn logistic(table: &Table, standard: &Standard, ridge: f64, alike: bool) -> anyhow::Result<Linear> {
    let rows = if alike { balanced(table, 0..table.len()) } else { (0..table.len()).collect() };
    let model = LogisticRegression::default()
        .alpha(ridge * rows.len() as f64)
        .max_iterations(200)
        .fit(&dataset(table, &rows, standard))
        .context("logistic regression")?;
    // linfa's positive class is the larger one, `true`; `labels` says if it ever were not.
    let sign = if model.labels().pos.class { 1.0 } else { -1.0 };
    let weights: Vec<f64> = model.params().iter().map(|weight| sign * weight).collect();
    Ok(Linear::unscaled(&weights, sign * model.intercept(), standard))
}
