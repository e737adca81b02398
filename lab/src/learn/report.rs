//! The figures of a fingertip's learning.

use super::Outcome;
use super::reflex::{Reflexed, Three};
use super::trial::{Trial, Word};

/// Mean, standard deviation and least of a sample; zeros of none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    pub mean: f64,
    pub sd: f64,
    pub min: f64,
}

impl Spread {
    pub fn of(values: &[f64]) -> Self {
        let count = values.len() as f64;
        if values.is_empty() {
            return Self::default();
        }
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        let sd = if count > 1.0 { (squares / (count - 1.0)).sqrt() } else { 0.0 };
        Self { mean, sd, min: values.iter().copied().fold(f64::INFINITY, f64::min) }
    }
}

/// Reports of one kind of word in held-out trials.
#[derive(Clone, Debug, Default)]
pub struct Words {
    /// First report in each trial that slipped, s after the lift began. None where there was none.
    pub said_s: Vec<Option<f64>>,
    /// Lead over the camera in each trial in which both reported, s.
    pub lead_s: Vec<f64>,
    /// Trials whose slip was not reported.
    pub missed: u64,
    /// Trials with a report where nothing slipped.
    pub false_alarms: u64,
}

impl Words {
    fn take(&mut self, word: Word, trial: &Trial) {
        self.false_alarms += u64::from(trial.card(word).false_alarms.count > 0);
        let said_s = trial.said_s(word);
        self.missed += u64::from(said_s.is_none());
        if trial.slip_up().is_some() {
            self.said_s.push(said_s.map(|t_s| t_s - trial.lift_s));
        }
        let Some((seen, said_s)) = trial.first_seen().zip(said_s) else { return };
        self.lead_s.push(seen.arrives_s - said_s);
    }

    pub fn lead(&self) -> Spread {
        Spread::of(&self.lead_s)
    }
}

/// Held-out trials, scored.
#[derive(Clone, Debug, Default)]
pub struct Score {
    pub trials: u64,
    /// The first place lets go, and all of it slides, s after the lift began.
    pub micro_s: Vec<f64>,
    pub macro_s: Vec<f64>,
    /// The network's first word, slip or a warning of it.
    pub first: Words,
    pub slip: Words,
    /// Slips, up or down, with the wrong direction of o2.
    pub direction_wrong: u64,
}

impl Score {
    pub fn of(trials: &[Trial]) -> Self {
        let mut score = Self { trials: trials.len() as u64, ..Self::default() };
        for trial in trials {
            score.first.take(Word::Any, trial);
            score.slip.take(Word::Slip, trial);
            let Some(up) = trial.slip_up() else { continue };
            score.micro_s.push(up.micro_onset_s - trial.lift_s);
            score.macro_s.push(up.macro_onset_s - trial.lift_s);
            if let Some([up, down]) = trial.both_slips() {
                score.direction_wrong +=
                    u64::from(trial.direction(&up) <= 0.0) + u64::from(trial.direction(&down) >= 0.0);
            }
        }
        score
    }
}

/// Means of the runs in which each judge triggered the reflex, in the order of [`JUDGES`](super::reflex::JUDGES).
pub fn told(runs: &[Three]) -> Three {
    std::array::from_fn(|n| {
        let mean = |of: fn(&Reflexed) -> f64| {
            Spread::of(&runs.iter().map(|three| of(&three[n])).collect::<Vec<_>>()).mean
        };
        Reflexed { secured_s: mean(|run| run.secured_s), distance_mm: mean(|run| run.distance_mm) }
    })
}

impl Outcome {
    /// The mean lead of the worst random fingertip, s.
    pub fn worst_lead_s(&self) -> Option<f64> {
        let seen = self.others.iter().filter(|other| !other.first.lead_s.is_empty());
        seen.map(|other| other.first.lead().mean).min_by(f64::total_cmp)
    }
}
