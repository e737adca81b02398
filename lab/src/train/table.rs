//! Sequences as rows to learn from.

use tenax_logic::array::FEATURES;

use crate::train::features::{Kind, Sequence};

/// Rows, one a time step.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// Features, [`FEATURES`] a row.
    pub features: Vec<f32>,
    /// 1 where it slipped, else 0.
    pub labels: Vec<f32>,
    /// The row at which the sequence of a row begins: nothing may look back beyond it.
    pub begins: Vec<usize>,
}

impl Table {
    /// All steps of sequences.
    pub fn of<'a>(sequences: impl IntoIterator<Item = &'a Sequence>) -> Self {
        let mut table = Self::default();
        for sequence in sequences {
            let begin = table.labels.len();
            for (features, &slip) in sequence.features.iter().zip(&sequence.slips) {
                table.features.extend(features.iter().map(|&feature| f32::from(feature)));
                table.labels.push(f32::from(u8::from(slip)));
                table.begins.push(begin);
            }
        }
        table
    }

    pub fn len(&self) -> usize {
        self.labels.len()
    }

    pub fn is_empty(&self) -> bool {
        self.labels.is_empty()
    }

    pub fn row(&self, row: usize) -> &[f32] {
        &self.features[row * FEATURES..][..FEATURES]
    }

    /// Weights of a row that slips not and of one that does, so that both kinds count alike and the mean is 1.
    pub fn class_weights(&self) -> [f32; 2] {
        let all = self.len().max(1) as f32;
        let slips = self.labels.iter().sum::<f32>();
        [all / (2.0 * (all - slips).max(1.0)), all / (2.0 * slips.max(1.0))]
    }

    /// Rows that have `look_back` rows of their own sequence, themselves included.
    pub fn ready(&self, look_back: usize) -> Vec<usize> {
        (0..self.len()).filter(|&row| row + 1 >= self.begins[row] + look_back).collect()
    }
}

/// Brings features to a common scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Standard {
    /// Taken off.
    pub mean: Vec<f32>,
    /// Multiplied with.
    pub scale: Vec<f32>,
}

impl Standard {
    /// From the rows to learn from.
    ///
    /// `shyness` scales down all features but variances and structure functions, which says before anything is learned that
    /// those are to be believed first: with few objects, covariances and spectra tell the objects apart rather than their sliding. At 1
    /// every feature gets a deviation of 1; below, features of one kind share their scale, so that a quiet element is not
    /// made loud.
    pub fn of(table: &Table, shyness: f32) -> Self {
        let rows = table.len().max(1) as f64;
        let moment = |feature: usize, about: f64, power: i32| -> f64 {
            table
                .features
                .iter()
                .skip(feature)
                .step_by(FEATURES)
                .map(|&x| (f64::from(x) - about).powi(power))
                .sum::<f64>()
                / rows
        };
        let mean: Vec<f64> = (0..FEATURES).map(|feature| moment(feature, 0.0, 1)).collect();
        let deviation: Vec<f64> =
            mean.iter().enumerate().map(|(feature, &mean)| moment(feature, mean, 2).sqrt()).collect();
        let shared = |feature: usize| {
            let same: Vec<f64> = (0..FEATURES)
                .filter(|&other| Kind::of(other) == Kind::of(feature))
                .map(|other| deviation[other])
                .collect();
            same.iter().sum::<f64>() / same.len().max(1) as f64
        };
        let scale = (0..FEATURES)
            .map(|feature| match () {
                // A feature that hardly ever changes would get a weight that nothing has taught it.
                () if deviation[feature] < 1.0 => 0.0,
                () if shyness >= 1.0 => 1.0 / deviation[feature].max(1.0) as f32,
                () if Kind::of(feature).is_believed_first() => 1.0 / shared(feature).max(1.0) as f32,
                () => shyness / shared(feature).max(1.0) as f32,
            })
            .collect();
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
