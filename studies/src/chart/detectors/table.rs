//! The table of scores, and the kernel that belongs to each of its lines.

use std::collections::BTreeMap;

use anyhow::{Context, Result, ensure};
use serde::Deserialize;

/// One line of the table.
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub struct Row {
    /// On the paper's features `mlp` (76-32-16-1), `queue` (the same on queued features, 380-32-16-1), `logistic`, `svm`
    /// (linear), `lstm`, `lstm-autoencoder` (16 cells over ten frames); with structure functions `mlp-structure`
    /// (112-32-16-1).
    pub classifier: String,
    /// `float`, `16` or `8`: its weights.
    pub precision: String,
    /// Differences in the covariance and samples in the spectrum: `10/40`, `5/20` or `1/10`; `40/40` costs what `10/40` does.
    pub window: String,
    /// Slow frames that it sees at once: 1 is none but the present.
    pub lookback: u32,
    /// Mean of the part of slipping steps that it calls slip and the part of the others that it does not, 0 to 1.
    pub balanced: f64,
    /// Part of all steps that it gets right, 0 to 1.
    pub accuracy: f64,
    /// Steps of slip that it missed.
    pub missed: u64,
    /// Steps without slip that it took for slip.
    #[serde(rename = "false")]
    pub false_alarms: u64,
    /// Whether it is the one that is shipped: `true`, else empty. The column may be missing.
    #[serde(default, deserialize_with = "yes")]
    pub shipped: bool,
}

/// `true`; anything else is no.
fn yes<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<bool, D::Error> {
    Ok(String::deserialize(deserializer)? == "true")
}

impl Row {
    /// The kernels that it takes, and the one in them that it does not need.
    fn kernels(&self) -> (Vec<String>, Option<String>) {
        if self.shipped {
            return (vec!["slow_frame".to_owned()], None);
        }
        let classifier = match self.classifier.as_str() {
            // One weighted sum each.
            "svm" => "logistic",
            // An encoder is an LSTM; the decoder is only for training.
            "lstm-autoencoder" => "lstm",
            "mlp-structure" => "mlp_structure",
            other => other,
        };
        let kernels = vec![
            // One difference in, one out, however long the window is.
            format!("features_{}", self.window.replace("40/40", "10/40").replace('/', "_")),
            format!("{classifier}_{}_{}", self.precision, self.lookback),
        ];
        // The features' kernel makes all of them.
        (kernels, (classifier != "mlp_structure").then(|| "structure".to_owned()))
    }
}

/// A line and what it costs.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The line.
    pub row: Row,
    /// Of a slow frame.
    pub instructions: u64,
}

/// Reads the table and adds up what each of its lines takes.
pub fn read(table: &str, instructions: &BTreeMap<String, u64>) -> Result<Vec<Measured>> {
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let mut all = Vec::new();
    for (n, row) in reader.deserialize().enumerate() {
        let line = n + 2;
        let row: Row = row.with_context(|| format!("line {line} of the detectors' table"))?;
        for part in [row.balanced, row.accuracy] {
            ensure!(
                (0.0..=1.0).contains(&part),
                "line {line}: an accuracy is a part of all steps, 0 to 1, not {part}"
            );
        }
        let cost = |kernel: &String| {
            instructions.get(kernel).copied().with_context(|| {
                let known: Vec<&str> = instructions.keys().map(String::as_str).collect();
                format!("line {line}: the kernels' table has no `{kernel}`, only {}", known.join(", "))
            })
        };
        let (needed, not_needed) = row.kernels();
        let sum: u64 = needed.iter().map(cost).sum::<Result<u64>>()?;
        let sum = sum.saturating_sub(not_needed.as_ref().map_or(Ok(0), cost)?);
        all.push(Measured { row, instructions: sum });
    }
    ensure!(!all.is_empty(), "the detectors' table is empty: `tenax train` writes it");
    Ok(all)
}
