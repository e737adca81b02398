//! The rows of the table: the detectors that ship, pairs of them, the hand, and rivals that anybody would try first.
//!
//! **A detector of your own** is a [`Judge`] and one line in [`rows`].

use std::sync::Arc;

use tenax_hal_shim::channel::{FRAME_HZ, SLOW_HZ, frames};
use tenax_hal_shim::detector::DetectorId;
use tenax_logic::array::{FEATURES, Features};

use super::heard::{CONTROLS, Felt, Judge};
use crate::equations::Equations;
use crate::learn::control::Control;

mod plain;

/// Features of the paper (Bamshad 2023): covariances and spectrum.
pub const OF_PAPER: usize = 76;
/// A rival's word lasts until its score has been below the threshold for so long, frames.
const HELD: u32 = frames(50);
/// False alarms an hour that a rival's threshold may have on the fingertips that it is chosen on.
#[derive(Clone, Copy, Debug)]
pub struct Cap {
    /// In quiet minutes, and in disturbed ones.
    pub held: f64,
    /// While balls are poured and boxes lifted.
    pub slips: f64,
    name: &'static str,
}

/// The last is about what the network that ships has.
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
    /// The kernels that it takes: see [`super::costs`].
    pub kernels: &'static [&'static str],
    /// The threshold that was chosen, on fingertips that are not scored.
    pub threshold: Option<i32>,
    /// How often it decides.
    pub per_s: u32,
    /// Fresh for each recording: whoever of them speaks first.
    pub make: Make,
}

type Make = Box<dyn Fn() -> Vec<Box<dyn Judge>> + Send + Sync>;

/// What ships says slip, or warns of it, and is believed.
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

impl Score for plain::Loudness {
    fn of(&mut self, felt: &Felt<'_>) -> Option<i32> {
        Some(self.step(&felt.frame.pvdf))
    }
}

#[derive(Clone)]
struct Ratio;

impl Score for Ratio {
    fn of(&mut self, felt: &Felt<'_>) -> Option<i32> {
        let forces = felt.sensed.forces.filter(|_| felt.sensed.forces_are_new)?;
        Some(plain::ratio_permille(forces.ft_mn, forces.load_mn))
    }
}

/// A logistic regression of the array's features, in the integers that the core would use.
#[derive(Clone, Debug, PartialEq)]
pub struct Logistic {
    pub weights: Vec<i32>,
    pub bias: i32,
}

impl Score for Logistic {
    fn of(&mut self, felt: &Felt<'_>) -> Option<i32> {
        felt.features.map(|features| plain::logit(&self.weights, self.bias, features))
    }
}

/// A rival and the thresholds from which one is chosen.
pub struct Rival {
    pub name: &'static str,
    pub kernels: &'static [&'static str],
    pub grid: Vec<i32>,
    per_s: u32,
    make: Arc<dyn Fn(i32) -> Box<dyn Judge> + Send + Sync>,
}

impl Rival {
    fn new<S: Score + Clone + Send + Sync + 'static>(
        name: &'static str,
        kernels: &'static [&'static str],
        grid: Vec<i32>,
        per_s: u32,
        score: S,
    ) -> Self {
        let make = move |threshold| -> Box<dyn Judge> {
            Box::new(Above { threshold, score: score.clone(), left: 0 })
        };
        Self { name, kernels, grid, per_s, make: Arc::new(make) }
    }

    pub fn judge(&self, threshold: i32) -> Box<dyn Judge> {
        (self.make)(threshold)
    }

    /// Its row with this threshold, which was chosen within a cap.
    pub fn row(&self, threshold: i32, cap: &Cap) -> Row {
        let &Self { name, kernels, per_s, .. } = self;
        let make = Arc::clone(&self.make);
        let name = format!("{name}, {}", cap.name);
        Row {
            name,
            kernels,
            per_s,
            threshold: Some(threshold),
            make: Box::new(move || vec![make(threshold)]),
        }
    }
}

/// The rivals whose threshold is chosen. `linear` learned on all features, `paper` on those of the paper alone.
pub fn rivals(linear: &Logistic, paper: &Logistic) -> Vec<Rival> {
    let doubling = |n: i32| (16.0 * 2.0_f64.powf(f64::from(n) / 3.0)) as i32;
    let nats = || (-8..=40).map(|n| n * 64).collect();
    vec![
        Rival::new(
            "vibration threshold",
            &["loudness"],
            (15..43).map(doubling).collect(),
            FRAME_HZ,
            plain::Loudness::default(),
        ),
        Rival::new(
            "Ft/Fn threshold",
            &["force", "ratio"],
            (3..=24).map(|n| 50 * n).collect(),
            SLOW_HZ,
            Ratio,
        ),
        Rival::new("logistic, 112 features", &["features", "logistic_112"], nats(), SLOW_HZ, linear.clone()),
        Rival::new("logistic, the paper's 76", &["features", "logistic_76"], nats(), SLOW_HZ, paper.clone()),
    ]
}

/// The rows that need no threshold, in the table's order.
pub fn rows() -> Vec<Row> {
    use DetectorId::{Hebbian, Mlp, S1, S2};
    let shipped = |name: &str, kernels, per_s, ids: &'static [DetectorId]| {
        let make: Make =
            Box::new(|| ids.iter().map(|&id| -> Box<dyn Judge> { Box::new(Shipped(id)) }).collect());
        Row { name: name.to_owned(), kernels, threshold: None, per_s, make }
    };
    let fixed: Make = Box::new(|| vec![Box::new(Above { threshold: FIXED_PERMILLE, score: Ratio, left: 0 })]);
    let control = |(n, what): (usize, &Control)| {
        let make: Make = Box::new(move || vec![Box::new(Changed(n))]);
        let name = format!("hebbian, {}", what.key().replace('_', " "));
        Row { name, kernels: &["films", "gauges", "hebbian"], threshold: None, per_s: FRAME_HZ, make }
    };
    let mut rows = vec![
        shipped("s1", &["films", "s1"], FRAME_HZ, &[S1]),
        shipped("s2", &["force", "s2"], SLOW_HZ, &[S2]),
        shipped("hebbian", &["films", "gauges", "hebbian"], FRAME_HZ, &[Hebbian]),
        shipped("mlp", &["slow_frame"], SLOW_HZ, &[Mlp]),
        shipped("s1 or s2", &["films", "s1", "force", "s2"], FRAME_HZ, &[S1, S2]),
        shipped("s1 or mlp", &["films", "s1", "slow_frame"], FRAME_HZ, &[S1, Mlp]),
        shipped("s2 or mlp", &["force", "s2", "slow_frame"], SLOW_HZ, &[S2, Mlp]),
        shipped("s1 or hebbian", &["films", "s1", "gauges", "hebbian"], FRAME_HZ, &[S1, Hebbian]),
        shipped("the hand: any of four", &["tick"], FRAME_HZ, &[S1, S2, Hebbian, Mlp]),
        Row {
            name: "Ft/Fn above 0.3".to_owned(),
            kernels: &["force", "ratio"],
            threshold: Some(FIXED_PERMILLE),
            per_s: SLOW_HZ,
            make: fixed,
        },
    ];
    rows.splice(3..3, CONTROLS.iter().enumerate().map(control));
    rows
}

/// Learns a logistic regression of the first `count` features by Newton's method, with a little ridge. Labels are slip or not.
pub fn learn(steps: &[(Features, bool)], count: usize) -> Logistic {
    let n = count + 1;
    let total = steps.len().max(1) as f64;
    // In doublings (9 fraction bits) about their mean, so that the equations are well conditioned.
    let at = |features: &Features, k: usize| f64::from(features[k]) / 512.0;
    let mean: Vec<f64> =
        (0..count).map(|k| steps.iter().map(|(own, _)| at(own, k)).sum::<f64>() / total).collect();
    let mut weights = vec![0.0; n];
    for _ in 0..ROUNDS {
        let (mut equations, mut row) = (Equations::new(n), vec![0.0; n]);
        for (features, slips) in steps {
            for k in 0..count {
                row[k] = at(features, k) - mean[k];
            }
            row[count] = 1.0;
            let logit: f64 = row.iter().zip(&weights).map(|(x, weight)| x * weight).sum();
            let p = 1.0 / (1.0 + (-logit).exp());
            let (miss, weight) = (f64::from(*slips) - p, (p * (1.0 - p)).max(1e-6));
            equations.add(&row, weight, miss);
        }
        (0..count).for_each(|k| equations.add_to(k, RIDGE, -RIDGE * weights[k]));
        equations.add_to(count, 1e-9, 0.0);
        for (weight, step) in weights.iter_mut().zip(equations.solve()) {
            *weight += step;
        }
    }
    let shift: f64 = mean.iter().zip(&weights).map(|(mean, weight)| mean * weight).sum();
    Logistic {
        weights: weights[..count].iter().map(|weight| (weight * 65_536.0).round() as i32).collect(),
        bias: ((weights[count] - shift) * 256.0).round() as i32,
    }
}

const ROUNDS: usize = 8;
const RIDGE: f64 = 10.0;
const _: () = assert!(OF_PAPER < FEATURES);
