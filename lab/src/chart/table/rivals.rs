//! The rows of the table: the detectors that ship, pairs of them, the hand, and rivals that anybody would try first.
//!
//! **A detector of your own** is a [`Judge`] and one line in [`rows`].

use std::sync::Arc;

use tenax_hal_shim::channel::{PVDF_COUNT, frames};
use tenax_hal_shim::detector::DetectorId;
use tenax_logic::array::{FEATURES, Features};

use super::heard::{Felt, Judge};
use crate::equations;
use crate::learn::control::Control;

/// Features of the paper (Bamshad 2023): covariances and spectrum.
pub const OF_PAPER: usize = 76;
/// A rival's report lasts until its score has been below the threshold for so long, frames.
const HELD: u32 = frames(50);

/// False alarms an hour of a rival's threshold on the fingertips that it is chosen on.
#[derive(Clone, Copy, Debug)]
pub struct Cap {
    /// In quiet minutes, and in disturbed ones.
    pub held: f64,
    /// While balls are poured and boxes lifted.
    pub slips: f64,
    name: &'static str,
}

/// The last is about that of the network that ships.
pub const CAPS: [Cap; 3] = [
    Cap { held: 10.0, slips: f64::INFINITY, name: "10 false/h" },
    Cap { held: 60.0, slips: f64::INFINITY, name: "60 false/h" },
    Cap { held: 10.0, slips: 30.0, name: "10, slipping 30" },
];
/// Ft/Fn of the fixed ratio that nobody chose, per mille.
const FIXED_PERMILLE: i32 = 300;

/// A row, before it hears anything.
pub struct Row {
    pub name: String,
    pub parts: &'static [&'static str],
    /// The threshold that was chosen, on fingertips that are not scored.
    pub threshold: Option<i32>,
    /// Fresh judges for each recording: the first report of any counts.
    pub make: Make,
}

type Make = Box<dyn Fn() -> Vec<Box<dyn Judge>> + Send + Sync>;

/// A detector that ships reports slip, or warns of it, and is believed.
struct Shipped(DetectorId);

impl Judge for Shipped {
    fn hear(&mut self, felt: &Felt<'_>) -> bool {
        felt.believed.contains(self.0)
    }
}

/// The network with something of its learning changed.
struct Changed(usize);

impl Judge for Changed {
    fn hear(&mut self, felt: &Felt<'_>) -> bool {
        felt.controls.get(self.0).is_some_and(|says| *says)
    }
}

/// A score above a threshold.
struct Above<S> {
    threshold: i32,
    score: S,
    left: u32,
}

/// A rival's score of a frame, None where it decides nothing.
trait Score {
    fn of(&mut self, felt: &Felt<'_>) -> Option<i32>;
}

impl<S: Score> Judge for Above<S> {
    fn hear(&mut self, felt: &Felt<'_>) -> bool {
        self.left = self.left.saturating_sub(1);
        if self.score.of(felt).is_some_and(|score| score >= self.threshold) {
            self.left = HELD;
        }
        self.left > 0
    }
}

/// Envelope of the loudest film, without a filter for hum, impacts or a film that is doubted.
#[derive(Clone, Debug, Default)]
struct Loudness {
    /// Slow mean of each film, and the envelope of the rest, Q8 samples.
    films: [(i32, i32); PVDF_COUNT],
}

impl Score for Loudness {
    /// Samples with 4 fraction bits.
    fn of(&mut self, felt: &Felt<'_>) -> Option<i32> {
        let mut loudest = 0;
        for ((mean, envelope), &sample) in self.films.iter_mut().zip(&felt.frame.pvdf) {
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
    }
}

/// Shear over normal force, per mille; 0 below a tenth of a newton.
#[derive(Clone)]
struct Ratio;

impl Score for Ratio {
    fn of(&mut self, felt: &Felt<'_>) -> Option<i32> {
        let forces = felt.sensed.forces.filter(|_| felt.sensed.forces_are_new)?;
        let (ft_mn, fn_mn) = (forces.ft_mn, forces.load_mn);
        Some(if fn_mn < 100 { 0 } else { ft_mn.saturating_mul(1_000) / fn_mn })
    }
}

/// A logistic regression of the array's features in integers: weights have 16 fraction bits, features 9, the logit 8.
#[derive(Clone, Debug, PartialEq)]
pub struct Logistic {
    pub weights: Vec<i32>,
    pub bias: i32,
}

impl Score for Logistic {
    fn of(&mut self, felt: &Felt<'_>) -> Option<i32> {
        let rows = self.weights.iter().zip(felt.features?);
        let sum: i64 = rows.map(|(&weight, &feature)| i64::from(weight) * i64::from(feature)).sum();
        Some((sum >> 17) as i32 + self.bias)
    }
}

fn above(threshold: i32, score: impl Score + 'static) -> Box<dyn Judge> {
    Box::new(Above { threshold, score, left: 0 })
}

pub fn loudness() -> Box<dyn Judge> {
    above(0, Loudness::default())
}

pub fn ratio() -> Box<dyn Judge> {
    above(0, Ratio)
}

pub fn logistic(own: Logistic) -> Box<dyn Judge> {
    above(0, own)
}

/// A rival and the thresholds from which one is chosen.
pub struct Rival {
    name: &'static str,
    parts: &'static [&'static str],
    pub grid: Vec<i32>,
    make: Arc<dyn Fn(i32) -> Box<dyn Judge> + Send + Sync>,
}

impl Rival {
    fn new<S: Score + Clone + Send + Sync + 'static>(
        name: &'static str,
        parts: &'static [&'static str],
        grid: Vec<i32>,
        score: S,
    ) -> Self {
        Self { name, parts, grid, make: Arc::new(move |threshold| above(threshold, score.clone())) }
    }

    pub fn judge(&self, threshold: i32) -> Box<dyn Judge> {
        (self.make)(threshold)
    }

    pub fn row(&self, threshold: i32, cap: &Cap) -> Row {
        let make = Arc::clone(&self.make);
        Row {
            name: format!("{}, {}", self.name, cap.name),
            parts: self.parts,
            threshold: Some(threshold),
            make: Box::new(move || vec![make(threshold)]),
        }
    }
}

/// The rivals whose threshold is chosen. `linear` learned on all features, `paper` on those of the paper alone.
pub fn rivals(linear: &Logistic, paper: &Logistic) -> Vec<Rival> {
    let doubling = |n: i32| (16.0 * 2.0_f64.powf(f64::from(n) / 3.0)) as i32;
    let nats = || (-8..=40).map(|n| n * 64).collect();
    let ratios = (3..=24).map(|n| 50 * n).collect();
    vec![
        Rival::new(
            "vibration threshold",
            &["loudness"],
            (15..43).map(doubling).collect(),
            Loudness::default(),
        ),
        Rival::new("Ft/Fn threshold", &["ratio"], ratios, Ratio),
        Rival::new("logistic, 112 features", &["features", "logistic_112"], nats(), linear.clone()),
        Rival::new("logistic, the paper's 76", &["features", "logistic_76"], nats(), paper.clone()),
    ]
}

/// The rows that need no threshold, in the table's order.
pub fn rows() -> Vec<Row> {
    use DetectorId::{Hebbian, Mlp, S1, S2};
    let shipped = |name: &str, parts, ids: &'static [DetectorId]| {
        let judge = |&id| -> Box<dyn Judge> { Box::new(Shipped(id)) };
        let make: Make = Box::new(move || ids.iter().map(judge).collect());
        Row { name: name.to_owned(), parts, threshold: None, make }
    };
    let fixed: Make = Box::new(|| vec![above(FIXED_PERMILLE, Ratio)]);
    let control = |(n, what): (usize, Control)| {
        let make: Make = Box::new(move || vec![Box::new(Changed(n))]);
        let name = format!("hebbian, {}", what.name());
        Row { name, parts: &["hebbian"], threshold: None, make }
    };
    let mut rows = vec![
        shipped("s1", &["s1"], &[S1]),
        shipped("s2", &["s2"], &[S2]),
        shipped("hebbian", &["hebbian"], &[Hebbian]),
        shipped("mlp", &["mlp"], &[Mlp]),
        shipped("s1 or s2", &["s1", "s2"], &[S1, S2]),
        shipped("s1 or mlp", &["s1", "mlp"], &[S1, Mlp]),
        shipped("s2 or mlp", &["s2", "mlp"], &[S2, Mlp]),
        shipped("s1 or hebbian", &["s1", "hebbian"], &[S1, Hebbian]),
        shipped("the hand: any of four", &["s1", "s2", "hebbian", "mlp"], &[S1, S2, Hebbian, Mlp]),
        Row {
            name: "Ft/Fn above 0.3".to_owned(),
            parts: &["ratio"],
            threshold: Some(FIXED_PERMILLE),
            make: fixed,
        },
    ];
    rows.splice(3..3, Control::ALL.into_iter().enumerate().map(control));
    rows
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
        (*slips, 1.0)
    });
    let shift: f64 = mean.iter().zip(&weights).map(|(mean, weight)| mean * weight).sum();
    Logistic {
        weights: weights.iter().map(|weight| (weight * 65_536.0).round() as i32).collect(),
        bias: ((bias - shift) * 256.0).round() as i32,
    }
}

const RIDGE: f64 = 10.0;
const _: () = assert!(OF_PAPER < FEATURES);
