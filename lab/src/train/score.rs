//! Scores of a detector's logits.

use serde::Serialize;
use tenax_sim::array::real;

/// Logits and truth, step by step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Judged {
    pub logits: Vec<f64>,
    pub slips: Vec<bool>,
}

impl Judged {
    pub fn extend(&mut self, other: &Self) {
        self.logits.extend(&other.logits);
        self.slips.extend(&other.slips);
    }

    fn steps(&self) -> impl Iterator<Item = (f64, bool)> {
        self.logits.iter().copied().zip(self.slips.iter().copied())
    }

    fn of(&self, slip: bool) -> usize {
        self.slips.iter().filter(|&&slipped| slipped == slip).count()
    }
}

/// What a threshold is chosen by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Aim {
    /// The mean of sensitivity and specificity.
    Balanced,
    /// The same in pours, with few false steps.
    Pours,
}

/// Part of the steps: the paper's 36 in 2800, less a fifth for sessions other than those that a threshold is chosen on.
pub const FALSE_MAX: f64 = 0.8 * 36.0 / 2_800.0;

/// Counts at a threshold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Score {
    pub steps: usize,
    pub missed: usize,
    #[serde(rename = "false")]
    pub false_alarms: usize,
    pub accuracy: f64,
    /// Mean of sensitivity and specificity. Where there is only one kind of step, the share of right ones.
    pub balanced: f64,
    /// Probability that a step that slips has a higher logit than one that does not. Where there is only one kind, 0.5.
    pub auc: f64,
}

/// Slip is above the threshold.
pub fn score(judged: &Judged, threshold: f64) -> Score {
    let (positives, negatives) = (judged.of(true), judged.of(false));
    let (mut missed, mut false_alarms) = (0, 0);
    for (logit, slip) in judged.steps() {
        missed += usize::from(slip && logit <= threshold);
        false_alarms += usize::from(!slip && logit > threshold);
    }
    let steps = judged.slips.len();
    let right = |wrong: usize, of: usize| if of == 0 { 1.0 } else { 1.0 - wrong as f64 / of as f64 };
    let accuracy = right(missed + false_alarms, steps);
    let (balanced, auc) = if positives == 0 || negatives == 0 {
        (accuracy, 0.5)
    } else {
        let balanced = (right(missed, positives) + right(false_alarms, negatives)) / 2.0;
        (balanced, real::auc(&mut judged.steps().collect::<Vec<_>>()))
    };
    Score { steps, missed, false_alarms, accuracy, balanced, auc }
}

/// The best threshold: the middle of the widest gap between logits that serves the aim best.
pub fn threshold(judged: &Judged, aim: Aim) -> f64 {
    let (positives, negatives) = (judged.of(true).max(1) as f64, judged.of(false).max(1) as f64);
    let (slip_costs, rest_costs) = (1.0 / positives, 1.0 / negatives);
    let false_max = if aim == Aim::Pours { FALSE_MAX * judged.slips.len() as f64 } else { f64::INFINITY };
    let mut false_steps = judged.of(false) as f64;
    let mut order: Vec<(f64, bool)> = judged.steps().collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some(first) = order.first() else { return 0.0 };
    let mut cost = judged.of(false) as f64 * rest_costs;
    let mut best = (f64::INFINITY, f64::INFINITY, first.0 - 1.0);
    if false_steps <= false_max {
        best.0 = cost;
    }
    for (tied, next) in order
        .chunk_by(|a, b| a.0 == b.0)
        .zip(order.chunk_by(|a, b| a.0 == b.0).skip(1).map(Some).chain([None]))
    {
        let slips = tied.iter().filter(|step| step.1).count() as f64;
        cost += slips * slip_costs - (tied.len() as f64 - slips) * rest_costs;
        false_steps -= tied.len() as f64 - slips;
        if false_steps > false_max {
            continue;
        }
        let here = tied[0].0;
        let to = next.map_or(here + 1.0, |next| next[0].0);
        // Among equally good ones the widest gap: it is the one that a new session moves least.
        if cost < best.0 - 1e-12 || (cost < best.0 + 1e-12 && to - here > best.1) {
            best = (cost, to - here, (here + to) / 2.0);
        }
    }
    best.2
}

/// Slope and intercept that make a logit a log-odds (Platt 1999; Newton's method as in Lin, Lin and Weng 2007).
pub fn platt(judged: &Judged) -> (f64, f64) {
    let (positives, negatives) = (judged.of(true) as f64, judged.of(false) as f64);
    let targets = [1.0 / (negatives + 2.0), (positives + 1.0) / (positives + 2.0)];
    let n = judged.logits.len().max(1) as f64;
    let mean = judged.logits.iter().sum::<f64>() / n;
    let spread = (judged.logits.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt().max(1e-12);
    let steps = || judged.steps().map(|(x, slip)| (x / spread, targets[usize::from(slip)]));
    let loss = |slope: f64, intercept: f64| -> f64 {
        let of = |(x, target): (f64, f64)| {
            let z = slope * x + intercept;
            z.max(0.0) - z * target + (-z.abs()).exp().ln_1p()
        };
        steps().map(of).sum()
    };
    let (mut slope, mut intercept) = (1.0, ((positives + 1.0) / (negatives + 1.0)).ln());
    let mut now = loss(slope, intercept);
    for _ in 0..100 {
        let (mut g, mut h) = ([0.0; 2], [1e-9, 0.0, 1e-9]);
        for (x, target) in steps() {
            let p = 1.0 / (1.0 + (-(slope * x + intercept)).exp());
            let (error, weight) = (p - target, p * (1.0 - p));
            g = [g[0] + error * x, g[1] + error];
            h = [h[0] + weight * x * x, h[1] + weight * x, h[2] + weight];
        }
        let det = h[0] * h[2] - h[1] * h[1];
        let step = [(h[2] * g[0] - h[1] * g[1]) / det, (h[0] * g[1] - h[1] * g[0]) / det];
        let mut size = 1.0;
        let (mut to, mut after) = ((slope, intercept), now);
        while size > 1e-6 {
            to = (slope - size * step[0], intercept - size * step[1]);
            after = loss(to.0, to.1);
            if after <= now {
                break;
            }
            size /= 2.0;
        }
        let gained = now - after;
        if !gained.is_finite() || gained < 1e-9 * now.abs() {
            break;
        }
        ((slope, intercept), now) = (to, after);
    }
    (slope / spread, intercept)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(steps: &[(f64, bool)]) -> Judged {
        Judged {
            logits: steps.iter().map(|step| step.0).collect(),
            slips: steps.iter().map(|step| step.1).collect(),
        }
    }

    #[test]
    fn counts_area_and_threshold_are_those_of_a_small_example() {
        let example =
            judged(&[(-3.0, false), (-1.0, false), (0.5, true), (0.5, false), (3.0, true), (9.0, true)]);
        let at_zero = score(&example, 0.0);
        assert_eq!((at_zero.steps, at_zero.missed, at_zero.false_alarms), (6, 0, 1));
        assert!((at_zero.auc - 8.5 / 9.0).abs() < 1e-12);
        // Ten times as many quiet steps: one false alarm in them costs less than a missed step of three.
        let many: Vec<(f64, bool)> = (0..30).map(|n| (-5.0 - f64::from(n), false)).collect();
        let mut unequal = judged(&many);
        unequal.extend(&example);
        assert_eq!(threshold(&unequal, Aim::Balanced), -0.25);
        // One false step of 36 is more than a hundredth.
        assert_eq!(threshold(&unequal, Aim::Pours), 1.75);
    }

    #[test]
    fn platt_finds_the_odds_that_made_the_labels() {
        let steps: Vec<(f64, bool)> = (0..40_000)
            .map(|n| {
                let x = f64::from(n % 200) / 20.0 - 5.0;
                let p = 1.0 / (1.0 + (-(0.8 * x - 0.6)).exp());
                (1e4 * x, (f64::from(n / 200) + 0.5) / 200.0 < p)
            })
            .collect();
        let (slope, intercept) = platt(&judged(&steps));
        assert!((slope * 1e4 - 0.8).abs() < 0.01 && (intercept + 0.6).abs() < 0.02, "{slope} {intercept}");
    }
}
