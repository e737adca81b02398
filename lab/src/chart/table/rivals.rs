//! The rows of the table: the detectors that ship, pairs of them, the hand, and rivals that anybody would try first.
//!
//! **A detector of your own** is a [`Judge`] and one line in [`rows`].

use std::sync::Arc;

use tenax_hal_shim::channel::{PVDF_COUNT, frames};
use tenax_hal_shim::detector::DetectorId;
use tenax_logic::array::{FEATURES, Features};

use super::heard::{Felt, Judge};
use crate::equations;

/// Features of the paper (Bamshad 2023): covariances and spectrum.
pub const OF_PAPER: usize = 76;
/// A rival's report lasts until its score has been below the threshold for so long, frames.
const HELD: u32 = frames(50);

/// A row, before it hears anything.
#[derive(Clone)]
pub struct Row {
    pub name: String,
    /// A rival's thresholds, from which one is chosen on fingertips that are not scored.
    pub grid: Vec<i32>,
    pub threshold: Option<i32>,
    /// Fresh judges with this threshold: the first report of any counts.
    pub make: Make,
}

type Make = Arc<dyn Fn(i32) -> Vec<Judge> + Send + Sync>;

impl Row {
    pub fn judges(&self, threshold: Option<i32>) -> Vec<Judge> {
        (self.make)(threshold.unwrap_or_default())
    }
}

/// A detector that ships reports slip, or warns of it, and is believed.
fn shipped(id: DetectorId) -> Judge {
    Box::new(move |felt| felt.believed.contains(id))
}

/// A rival's score of a frame, None where it decides nothing.
pub type Score = Box<dyn FnMut(&Felt<'_>) -> Option<i32>>;

fn above(threshold: i32, mut score: Score) -> Judge {
    let mut left = 0_u32;
    Box::new(move |felt| {
        left = left.saturating_sub(1);
        if score(felt).is_some_and(|score| score >= threshold) {
            left = HELD;
        }
        left > 0
    })
}

/// Envelope of the loudest film, samples with 4 fraction bits, without a filter for hum, impacts or a film that is doubted.
pub fn loudness() -> Score {
    // Slow mean of each film, and the envelope of the rest, Q8 samples.
    let mut films = [(0_i32, 0_i32); PVDF_COUNT];
    Box::new(move |felt| {
        let mut loudest = 0;
        for ((mean, envelope), &sample) in films.iter_mut().zip(&felt.frame.pvdf) {
            let sample = i32::from(sample) << 8;
            // The first sample is where the film rests.
            if *mean == 0 {
                *mean = sample;
            }
            // Time constants of 16 ms, so from 10 Hz on, and of 8 ms.
            *mean += (sample - *mean) >> 5;
            *envelope += ((sample - *mean).abs() - *envelope) >> 4;
            loudest = loudest.max(*envelope);
        }
        Some(loudest >> 4)
    })
}

/// Shear over normal force, per mille; 0 below a tenth of a newton.
pub fn ratio() -> Score {
    Box::new(|felt| {
        let forces = felt.sensed.forces.filter(|_| felt.sensed.forces_are_new)?;
        let (ft_mn, fn_mn) = (forces.ft_mn, forces.load_mn);
        Some(if fn_mn < 100 { 0 } else { ft_mn.saturating_mul(1_000) / fn_mn })
    })
}

/// A logistic regression of the array's features in integers: weights have 16 fraction bits, features 9, the logit 8.
#[derive(Clone, Debug, PartialEq)]
pub struct Logistic {
    pub weights: Vec<i32>,
    pub bias: i32,
}

pub fn logistic(own: Arc<Logistic>) -> Score {
    Box::new(move |felt| {
        let rows = own.weights.iter().zip(felt.features?);
        let sum: i64 = rows.map(|(&weight, &feature)| i64::from(weight) * i64::from(feature)).sum();
        Some((sum >> 17) as i32 + own.bias)
    })
}

/// The rivals whose threshold is chosen. `linear` learned on all features, `paper` on those of the paper alone.
pub fn rivals(linear: Logistic, paper: Logistic) -> Vec<Row> {
    let rival = |name: &str, grid, make| Row { name: name.to_owned(), grid, threshold: None, make };
    let learned = |own: Logistic| -> Make {
        let own = Arc::new(own);
        Arc::new(move |at| vec![above(at, logistic(Arc::clone(&own)))])
    };
    let levels = (15..43).map(|n| (16.0 * 2.0_f64.powf(f64::from(n) / 3.0)) as i32).collect();
    let ratios = (3..=24).map(|n| 50 * n).collect();
    let nats = || (-8..=40).map(|n| n * 64).collect();
    vec![
        rival("vibration threshold", levels, Arc::new(|at| vec![above(at, loudness())])),
        rival("Ft/Fn threshold", ratios, Arc::new(|at| vec![above(at, ratio())])),
        rival("linear on the mlp's 112 features", nats(), learned(linear)),
        rival("linear on the paper's 76", nats(), learned(paper)),
    ]
}

/// The rows that need no threshold, in the table's order.
pub fn rows() -> Vec<Row> {
    use DetectorId::{Hebbian, Mlp, S1, S2};
    let row = |name: &str, ids: &'static [DetectorId]| Row {
        name: name.to_owned(),
        grid: Vec::new(),
        threshold: None,
        make: Arc::new(move |_| ids.iter().map(|&id| shipped(id)).collect()),
    };
    vec![
        row("s1", &[S1]),
        row("s2", &[S2]),
        row("hebbian", &[Hebbian]),
        row("mlp", &[Mlp]),
        row("s1 or s2", &[S1, S2]),
        row("s1 or mlp", &[S1, Mlp]),
        row("s2 or mlp", &[S2, Mlp]),
        row("s1 or hebbian", &[S1, Hebbian]),
        row("the hand: any of four", &[S1, S2, Hebbian, Mlp]),
    ]
}

/// Learns a logistic regression of the first `count` features. Labels are slip or not.
pub fn learn(steps: &[(Features, bool)], count: usize) -> Logistic {
    let total = steps.len().max(1) as f64;
    // In doublings (9 fraction bits) about their mean, so that the equations are well conditioned.
    let at = |features: &Features, k: usize| f64::from(features[k]) / 512.0;
    let mean: Vec<f64> =
        (0..count).map(|k| steps.iter().map(|(own, _)| at(own, k)).sum::<f64>() / total).collect();
    let (weights, bias) = equations::logistic(count, steps.len(), RIDGE, |n, row| {
        let (features, slips) = &steps[n];
        row.iter_mut().enumerate().for_each(|(k, to)| *to = at(features, k) - mean[k]);
        *slips
    });
    let shift: f64 = mean.iter().zip(&weights).map(|(mean, weight)| mean * weight).sum();
    Logistic {
        weights: weights.iter().map(|weight| (weight * 65_536.0).round() as i32).collect(),
        bias: ((bias - shift) * 256.0).round() as i32,
    }
}

const RIDGE: f64 = 10.0;
const _: () = assert!(OF_PAPER < FEATURES);
