//! What a fingertip's learning is worth, in figures: for programs the keys of [`Report`], for people all of it.

use std::collections::BTreeMap;

use serde::Serialize;

use super::control::Control;
use super::reflex::{JUDGES, Reflexed, Three};
use super::trial::{Trial, Word};
use super::{Other, Outcome};

/// Mean, standard deviation and least of a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    pub mean: f64,
    /// Standard deviation of the sample.
    pub sd: f64,
    /// The least.
    pub min: f64,
}

impl Spread {
    /// Of these; zeros if there are none.
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

/// What was said in held-out trials, of one kind of word.
#[derive(Clone, Debug, Default)]
pub struct Words {
    /// First said in each trial that slipped, s after the lift began. None where it was not.
    pub said_s: Vec<Option<f64>>,
    /// How much earlier than the camera, of each trial in which both spoke.
    pub lead_s: Vec<f64>,
    /// The same over a camera without delay.
    pub lead_no_delay_s: Vec<f64>,
    /// Trials whose slip was not said.
    pub missed: u64,
    /// Trials in which it was said where nothing slipped.
    pub false_alarms: u64,
}

impl Words {
    fn take(&mut self, word: Word, trial: &Trial) {
        self.false_alarms += u64::from(trial.false_alarm(word));
        let said_s = trial.said_s(word);
        self.missed += u64::from(said_s.is_none());
        if trial.slip_up().is_some() {
            self.said_s.push(said_s.map(|t_s| t_s - trial.lift_s));
        }
        let lead = |seen_s: Option<f64>| seen_s.zip(said_s).map(|(seen_s, said_s)| seen_s - said_s);
        self.lead_s.extend(lead(trial.vision_s()));
        self.lead_no_delay_s.extend(lead(trial.vision_without_delay_s()));
    }

    pub fn lead(&self) -> Spread {
        Spread::of(&self.lead_s)
    }

    /// How much earlier than `other` in the same trials, s, of those in which both spoke.
    pub fn sooner_s(&self, other: &Self) -> Vec<f64> {
        let both = self.said_s.iter().zip(&other.said_s);
        both.filter_map(|(own, other)| Some((*other)? - (*own)?)).collect()
    }
}

/// Held-out trials, scored.
#[derive(Clone, Debug, Default)]
pub struct Score {
    pub trials: u64,
    /// First said by the camera, s after the lift began.
    pub vision_s: Vec<f64>,
    /// When the first place let go, likewise.
    pub micro_s: Vec<f64>,
    /// When all of it slid, likewise.
    pub macro_s: Vec<f64>,
    /// The network's first word, slip or a warning of it.
    pub first: Words,
    /// Its word of slip, which the films alone give.
    pub slip: Words,
    /// What a hand made of slip that each judge told it of, in lifts and in pours.
    pub lifts: Vec<Told>,
    pub pours: Vec<Told>,
    /// Slips, up or down, of which o2 said the wrong direction.
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
            score.vision_s.extend(trial.vision_s().map(|t_s| t_s - trial.lift_s));
        }
        score
    }
}

/// For programs: these keys, and no others.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Held-out trials.
    pub trials: u64,
    /// The network's first word, slip or a warning of it, s after the lift began, mean.
    pub network_first_s_mean: f64,
    /// First said by the camera's codes, likewise.
    pub vision_first_s_mean: f64,
    /// When the first place of the contact let go, and when all of it slid, s after the lift began, means.
    pub micro_onset_s_mean: f64,
    pub macro_onset_s_mean: f64,
    /// How much earlier the network's first word was, s: slip, or a warning of it.
    pub lead_s: Spread,
    /// The same over a camera without delay.
    pub lead_s_no_delay: Spread,
    /// The same as `lead_s` with equal weights in place of learned ones.
    pub lead_s_equal_weights: Spread,
    /// The mean of `lead_s` of the worst finger made by chance: of those trials in which it said a word. Null if there is none.
    pub worst_finger_lead_s: Option<f64>,
    /// Trials in whose slip the network said neither.
    pub missed: u64,
    /// False alarms in an hour of holding, of either.
    pub false_per_hour: f64,
    /// Slip alone, which the films give.
    pub slip: Slip,
    /// Warnings alone, which shear gives.
    pub warning: Warning,
    /// How long was held, h.
    pub holding_hours: f64,
    /// Lifts of all fingers with 1.5 to 3 times the needed force.
    pub safe: Safe,
    /// What a hand made of slip that each judge told it of, in lifts and in pours.
    pub lifts: Vec<Told>,
    pub pours: Vec<Told>,
    /// Slips, up or down, of which o2 said the wrong direction.
    pub direction_wrong: u64,
    /// The same learning on fingers made by chance.
    pub fingertips: Fingertips,
}

/// Means of the runs in which the reflex was told by one judge.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Told {
    pub judge: &'static str,
    /// When the object last moved along the hand, s from the beginning of the lift.
    pub secured_s: f64,
    /// How far it had sunk in the end, mm.
    pub distance_mm: f64,
    /// What each finger pressed with in the end, N.
    pub grip_n: f64,
}

fn told(runs: &[Three]) -> Vec<Told> {
    let secured_s = of_judges(runs, |run| run.secured_s);
    let distance_mm = of_judges(runs, |run| run.distance_mm);
    let grip_n = of_judges(runs, |run| run.grip_n);
    let of = |(n, judge): (usize, &'static str)| Told {
        judge,
        secured_s: secured_s[n].mean,
        distance_mm: distance_mm[n].mean,
        grip_n: grip_n[n].mean,
    };
    ["touch", "vision", "bound"].into_iter().enumerate().map(of).collect()
}

/// What was said of slip, warnings left out.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Slip {
    /// When it was said, s after the lift began, mean.
    pub said_s_mean: f64,
    /// How much earlier than the camera, s, of those trials in which it was said.
    pub lead_s: Spread,
    /// The same over a camera without delay.
    pub lead_s_no_delay: Spread,
    /// Trials in whose slip it was not said.
    pub missed: u64,
    /// False alarms in an hour of holding.
    pub false_per_hour: f64,
    /// The same trials with equal weights.
    pub equal_weights: Against,
}

/// A control beside what was learned, of slip.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Against {
    pub lead_s: f64,
    /// Trials in whose slip it did not say it.
    pub missed: u64,
    /// How much earlier what was learned says it, s, of the trials in which both do.
    pub learned_sooner_s: f64,
}

#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Warning {
    /// False alarms in an hour of holding.
    pub false_per_hour: f64,
}

/// Fingers made by chance.
#[derive(Clone, Debug, Serialize)]
pub struct Fingertips {
    pub count: u64,
    /// The mean lead of the worst of them, s. Null if one of them said neither in a slip or told a direction wrongly, or there are
    /// none.
    pub worst_lead_s: Option<f64>,
    /// Trials of theirs in whose slip neither was said, and all of them.
    pub missed: [u64; 2],
    /// Where sliding keeps at most 0.75 of static friction.
    pub slippery: Group,
    /// Where it keeps more.
    pub even: Group,
    pub all: Group,
}

#[derive(Clone, Debug, Default, Serialize)]
pub struct Group {
    pub count: usize,
    /// Mean lead of the first word, slip or a warning of it, s.
    pub lead_s: f64,
    /// The same over a camera without delay.
    pub lead_s_no_delay: f64,
    /// The same as `lead_s` with equal weights.
    pub lead_s_equal_weights: f64,
    /// Trials in whose slip neither was said, and with equal weights.
    pub missed: [u64; 2],
    /// Slip alone: mean lead, s.
    pub slip_lead_s: f64,
    /// The same over a camera without delay.
    pub slip_lead_s_no_delay: f64,
    /// Trials in whose slip it was not said.
    pub slip_missed: u64,
    pub controls: BTreeMap<&'static str, Controlled>,
}

/// What a control came to.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Controlled {
    /// Mean lead of the first word, s, of those trials in which there was one.
    pub lead_s: f64,
    /// Trials in whose slip neither was said.
    pub missed: u64,
    /// Slip alone.
    pub slip: Against,
}

/// Lifts with more force than the object needs, in which every verdict is false.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Safe {
    pub lifts: u64,
    /// In which slip was said, or warned of.
    pub said: u64,
    /// In which slip was said.
    pub slip: u64,
}

/// Sliding keeps so much of static friction at most in the fingers of the first group.
const SLIPPERY: f64 = 0.75;

impl Group {
    fn of<'a>(others: impl Iterator<Item = &'a Other>) -> Self {
        let others: Vec<&Other> = others.collect();
        let mean = |of: &dyn Fn(&Other) -> Vec<f64>| {
            Spread::of(&others.iter().flat_map(|other| of(other)).collect::<Vec<_>>()).mean
        };
        let sum = |of: &dyn Fn(&Other) -> u64| others.iter().map(|other| of(other)).sum();
        let controlled = |n: usize| Controlled {
            lead_s: mean(&|other| other.controls[n].first.lead_s.clone()),
            missed: sum(&|other| other.controls[n].first.missed),
            slip: Against {
                lead_s: mean(&|other| other.controls[n].slip.lead_s.clone()),
                missed: sum(&|other| other.controls[n].slip.missed),
                learned_sooner_s: mean(&|other| other.apart.slip.sooner_s(&other.controls[n].slip)),
            },
        };
        let equal = controlled(Control::EqualWeights as usize);
        Self {
            count: others.len(),
            lead_s: mean(&|other| other.score.first.lead_s.clone()),
            lead_s_no_delay: mean(&|other| other.score.first.lead_no_delay_s.clone()),
            lead_s_equal_weights: equal.lead_s,
            missed: [sum(&|other| other.score.first.missed), equal.missed],
            slip_lead_s: mean(&|other| other.score.slip.lead_s.clone()),
            slip_lead_s_no_delay: mean(&|other| other.score.slip.lead_no_delay_s.clone()),
            slip_missed: sum(&|other| other.score.slip.missed),
            controls: Control::ALL
                .into_iter()
                .enumerate()
                .map(|(n, control)| (control.key(), controlled(n)))
                .collect(),
        }
    }
}

impl Report {
    pub fn of(outcome: &Outcome) -> Self {
        let (score, equal) = (&outcome.score, &outcome.equal);
        let holding = &outcome.holding;
        Self {
            trials: score.trials,
            network_first_s_mean: said_s(&score.first).mean,
            vision_first_s_mean: Spread::of(&score.vision_s).mean,
            micro_onset_s_mean: Spread::of(&score.micro_s).mean,
            macro_onset_s_mean: Spread::of(&score.macro_s).mean,
            lead_s: score.first.lead(),
            lead_s_no_delay: Spread::of(&score.first.lead_no_delay_s),
            lead_s_equal_weights: equal.first.lead(),
            worst_finger_lead_s: outcome.worst_lead_s(),
            missed: score.first.missed,
            false_per_hour: holding.per_hour(holding.any),
            slip: Slip {
                said_s_mean: said_s(&score.slip).mean,
                lead_s: score.slip.lead(),
                lead_s_no_delay: Spread::of(&score.slip.lead_no_delay_s),
                missed: score.slip.missed,
                false_per_hour: holding.per_hour(holding.slip),
                equal_weights: Against {
                    lead_s: equal.slip.lead().mean,
                    missed: equal.slip.missed,
                    learned_sooner_s: Spread::of(&score.slip.sooner_s(&equal.slip)).mean,
                },
            },
            warning: Warning { false_per_hour: holding.per_hour(holding.warning) },
            holding_hours: outcome.holding.hours,
            safe: outcome.safe(),
            lifts: told(&outcome.lifts),
            pours: told(&outcome.pours),
            direction_wrong: score.direction_wrong,
            fingertips: Fingertips {
                count: outcome.others.len() as u64,
                worst_lead_s: outcome.others_work().then(|| outcome.worst_lead_s()).flatten(),
                missed: [
                    outcome.others.iter().map(|other| other.score.first.missed).sum(),
                    outcome.others.iter().map(|other| other.score.trials).sum(),
                ],
                slippery: outcome.group(|ratio| ratio <= SLIPPERY),
                even: outcome.group(|ratio| ratio > SLIPPERY),
                all: outcome.group(|_| true),
            },
        }
    }
}

impl Outcome {
    /// Lifts with more force than is needed.
    pub fn safe(&self) -> Safe {
        self.others.iter().fold(Safe::default(), |all, other| Safe {
            lifts: all.lifts + other.safe.lifts,
            said: all.said + other.safe.said,
            slip: all.slip + other.safe.slip,
        })
    }

    /// Whether every finger made by chance said slip, or warned, in every slip, and told its direction.
    pub fn others_work(&self) -> bool {
        self.others.iter().all(|other| other.score.first.missed == 0 && other.score.direction_wrong == 0)
    }

    /// The mean lead of the worst finger made by chance, s.
    pub fn worst_lead_s(&self) -> Option<f64> {
        let seen = self.others.iter().filter(|other| !other.score.first.lead_s.is_empty());
        seen.map(|other| other.score.first.lead().mean).min_by(f64::total_cmp)
    }

    /// The fingers made by chance of which this accepts the part of static friction that sliding keeps.
    fn group(&self, accepts: impl Fn(f64) -> bool) -> Group {
        Group::of(self.others.iter().filter(|other| accepts(other.ratio)))
    }
}

/// When a word was said, s from the beginning of the lift.
pub(super) fn said_s(words: &Words) -> Spread {
    Spread::of(&words.said_s.iter().copied().flatten().collect::<Vec<_>>())
}

/// A figure of each judge's runs, in the order of [`JUDGES`].
pub fn of_judges(runs: &[Three], figure: impl Fn(&Reflexed) -> f64) -> [Spread; 3] {
    [0, 1, 2].map(|judge| Spread::of(&runs.iter().map(|three| figure(&three[judge])).collect::<Vec<_>>()))
}

const _: () = assert!(JUDGES.len() == 3);
