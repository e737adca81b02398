//! Sequences as rows to learn from.

use tenax_logic::array::FEATURES;

use crate::train::features::{Sequence, is_believed_first, kind_of};

/// Rows, one a time step.
#[derive(Clone, Debug, Default)]
pub struct Table {
    pub features: Vec<f32>,
    pub slips: Vec<bool>,
}

impl Table {
    pub fn of<'a>(sequences: impl IntoIterator<Item = &'a Sequence>) -> Self {
        let mut table = Self::default();
        for sequence in sequences {
            table.features.extend(sequence.features.iter().flatten().map(|&feature| f32::from(feature)));
            table.slips.extend(&sequence.slips);
        }
        table
    }

    pub fn count(&self) -> usize {
        self.slips.len()
    }

    pub fn rows(&self) -> impl Iterator<Item = &[f32]> {
        self.features.chunks_exact(FEATURES)
    }

    /// Weights of a row without slip and of one with slip: both kinds count alike, and the mean is 1.
    pub fn class_weights(&self) -> [f32; 2] {
        let slips = self.slips.iter().filter(|&&slips| slips).count();
        let weight = |count: usize| self.count().max(1) as f32 / (2.0 * count.max(1) as f32);
        [weight(self.count() - slips), weight(slips)]
    }
}

/// Mean and scale that bring features to a common scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Standard {
    pub mean: Vec<f32>,
    pub scale: Vec<f32>,
}

impl Standard {
    /// `shyness` scales down all features but variances and structure functions: with few objects, covariances and spectra tell the
    /// objects apart rather than their sliding. At 1 every feature gets a deviation of 1; below, features of one kind share their scale,
    /// so that a quiet element is not amplified.
    pub fn of(table: &Table, shyness: f32) -> Self {
        let rows = table.count().max(1) as f64;
        let moment = |feature: usize, about: f64, power: i32| -> f64 {
            table.rows().map(|row| (f64::from(row[feature]) - about).powi(power)).sum::<f64>() / rows
        };
        let mean: Vec<f64> = (0..FEATURES).map(|feature| moment(feature, 0.0, 1)).collect();
        let deviation: Vec<f64> =
            mean.iter().enumerate().map(|(feature, &mean)| moment(feature, mean, 2).sqrt()).collect();
        let shared = |feature: usize| {
            let same = (0..FEATURES).filter(|&other| kind_of(other) == kind_of(feature));
            let same: Vec<f64> = same.map(|other| deviation[other]).collect();
            same.iter().sum::<f64>() / same.len().max(1) as f64
        };
        let scale = |feature: usize| match () {
            // A feature that hardly ever changes would keep a random weight.
            () if deviation[feature] < 1.0 => 0.0,
            () if shyness >= 1.0 => 1.0 / deviation[feature].max(1.0) as f32,
            () if is_believed_first(feature) => 1.0 / shared(feature).max(1.0) as f32,
            () => shyness / shared(feature).max(1.0) as f32,
        };
        let scale = (0..FEATURES).map(scale).collect();
        Self { mean: mean.into_iter().map(|mean| mean as f32).collect(), scale }
    }

    /// All rows, on the common scale.
    pub fn apply(&self, table: &Table) -> Vec<f32> {
        let mut rows = table.features.clone();
        for row in rows.chunks_exact_mut(FEATURES) {
            for ((x, mean), scale) in row.iter_mut().zip(&self.mean).zip(&self.scale) {
                *x = (*x - mean) * scale;
            }
        }
        rows
    }
}
