//! The figures of a fingertip's learning: for programs the keys of [`Report`].

use serde::Serialize;

use super::Outcome;
use super::reflex::{Reflexed, Three};
use super::trial::{Trial, Word};

/// Mean, standard deviation and least of a sample; zeros of none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
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
    /// Lead over a camera without delay, s.
    pub lead_no_delay_s: Vec<f64>,
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
        self.lead_no_delay_s.push(seen.t_s - said_s);
    }

    pub fn lead(&self) -> Spread {
        Spread::of(&self.lead_s)
    }
}

/// Held-out trials, scored.
#[derive(Clone, Debug, Default)]
pub struct Score {
    pub trials: u64,
    /// First report of the camera, s after the lift began.
    pub vision_s: Vec<f64>,
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
            score.vision_s.extend(trial.first_seen().map(|seen| seen.arrives_s - trial.lift_s));
        }
        score
    }
}

/// One kind of word of the finger.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Said {
    /// First report, s after the lift began, mean.
    pub said_s_mean: f64,
    /// Lead over the camera, and over one without delay, s.
    pub lead_s: Spread,
    pub lead_s_no_delay: Spread,
    /// Trials whose slip was not reported.
    pub missed: u64,
    /// False alarms an hour of holding.
    pub false_per_hour: f64,
    /// Lead over the camera with equal weights, s, mean.
    pub equal_weights_lead_s: f64,
}

impl Said {
    fn of(words: &Words, equal: &Words, false_per_hour: f64) -> Self {
        Self {
            said_s_mean: Spread::of(&words.said_s.iter().copied().flatten().collect::<Vec<_>>()).mean,
            lead_s: words.lead(),
            lead_s_no_delay: Spread::of(&words.lead_no_delay_s),
            missed: words.missed,
            false_per_hour,
            equal_weights_lead_s: equal.lead().mean,
        }
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Held-out trials.
    pub trials: u64,
    /// First report of the camera, s after the lift began, mean.
    pub vision_first_s_mean: f64,
    /// The first place lets go, and all of it slides, s after the lift began, means.
    pub micro_onset_s_mean: f64,
    pub macro_onset_s_mean: f64,
    /// Slip or a warning, whichever comes first; slip alone, which the films give.
    pub first: Said,
    pub slip: Said,
    /// False warnings, which shear gives, an hour of holding.
    pub warnings_false_per_hour: f64,
    pub holding_hours: f64,
    /// The reflex triggered by each judge, in lifts and in pours.
    pub lifts: [Told; 3],
    pub pours: [Told; 3],
    /// Slips, up or down, with the wrong direction of o2.
    pub direction_wrong: u64,
    pub fingertips: Fingertips,
}

/// Means of the runs in which one judge triggered the reflex.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Told {
    pub judge: &'static str,
    /// The object's last motion along the hand, s from the beginning of the lift.
    pub secured_s: f64,
    /// Sunk in the end, mm.
    pub distance_mm: f64,
    /// Force of each finger in the end, N.
    pub grip_n: f64,
}

/// In the order of [`JUDGES`](super::reflex::JUDGES).
pub fn told(runs: &[Three]) -> [Told; 3] {
    std::array::from_fn(|n| {
        let mean = |of: fn(&Reflexed) -> f64| {
            Spread::of(&runs.iter().map(|three| of(&three[n])).collect::<Vec<_>>()).mean
        };
        Told {
            judge: ["touch", "vision", "bound"][n],
            secured_s: mean(|run| run.secured_s),
            distance_mm: mean(|run| run.distance_mm),
            grip_n: mean(|run| run.grip_n),
        }
    })
}

/// Random fingertips.
#[derive(Clone, Debug, Serialize)]
pub struct Fingertips {
    pub count: usize,
    pub trials: u64,
    /// The mean lead of the worst of them, s. Null if one missed a slip or reported a direction wrongly, or there are none.
    pub worst_lead_s: Option<f64>,
    /// Trials whose slip was not reported.
    pub missed: u64,
}

impl Report {
    pub fn of(outcome: &Outcome) -> Self {
        let Outcome { score, equal, holding, others, .. } = outcome;
        Self {
            trials: score.trials,
            vision_first_s_mean: Spread::of(&score.vision_s).mean,
            micro_onset_s_mean: Spread::of(&score.micro_s).mean,
            macro_onset_s_mean: Spread::of(&score.macro_s).mean,
            first: Said::of(&score.first, &equal.first, holding.any.per_hour),
            slip: Said::of(&score.slip, &equal.slip, holding.slip.per_hour),
            warnings_false_per_hour: holding.warning.per_hour,
            holding_hours: holding.slip.hours,
            lifts: told(&outcome.lifts),
            pours: told(&outcome.pours),
            direction_wrong: score.direction_wrong,
            fingertips: Fingertips {
                count: others.len(),
                trials: others.iter().map(|other| other.trials).sum(),
                worst_lead_s: outcome.others_work().then(|| outcome.worst_lead_s()).flatten(),
                missed: others.iter().map(|other| other.first.missed).sum(),
            },
        }
    }
}

impl Outcome {
    /// Whether every random fingertip reported slip, or warned, in every slip, with its direction.
    pub fn others_work(&self) -> bool {
        self.others.iter().all(|other| other.first.missed == 0 && other.direction_wrong == 0)
    }

    /// The mean lead of the worst random fingertip, s.
    pub fn worst_lead_s(&self) -> Option<f64> {
        let seen = self.others.iter().filter(|other| !other.first.lead_s.is_empty());
        seen.map(|other| other.first.lead().mean).min_by(f64::total_cmp)
    }
}
