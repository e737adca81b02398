//! What a fingertip's learning is worth, in figures: for programs the keys of [`Report`], for people all of it.

use std::fmt;

use std::collections::BTreeMap;

use serde::Serialize;

use super::control::Control;
use super::reflex::{JUDGES, Reflexed, Three};
use super::trial::Trial;
use super::{LESSONS, Other, Outcome};

/// Mean, standard deviation and least of a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Standard deviation of the sample.
    pub sd: f64,
    /// The least.
    pub min: f64,
}

impl Spread {
    /// Of these; zeros if there are none.
    #[must_use]
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

/// Held-out trials, scored.
#[derive(Clone, Debug, Default)]
pub struct Score {
    /// How many.
    pub trials: u64,
    /// First said by the network, s after the lift began.
    pub network_s: Vec<f64>,
    /// First said by the camera, likewise.
    pub vision_s: Vec<f64>,
    /// When the first place let go, likewise.
    pub micro_s: Vec<f64>,
    /// When all of it slid, likewise.
    pub macro_s: Vec<f64>,
    /// How much earlier the network was.
    pub lead_s: Vec<f64>,
    /// The same over a camera without delay.
    pub lead_no_delay_s: Vec<f64>,
    /// Trials whose slip the network did not see.
    pub missed: u64,
    /// Slips, up or down, of which o2 said the wrong direction.
    pub direction_wrong: u64,
    /// Trials in which slip was said where nothing slipped.
    pub false_alarms: u64,
}

impl Score {
    /// Of these trials.
    #[must_use]
    pub fn of(trials: &[Trial]) -> Self {
        let mut score = Self { trials: trials.len() as u64, ..Self::default() };
        for trial in trials {
            score.false_alarms += u64::from(trial.false_alarm());
            let Some(up) = trial.slip_up() else {
                score.missed += 1;
                continue;
            };
            score.micro_s.push(up.micro_onset_s - trial.lift_s);
            score.macro_s.push(up.macro_onset_s - trial.lift_s);
            if let Some([up, down]) = trial.both_slips() {
                score.direction_wrong +=
                    u64::from(trial.direction(&up) <= 0.0) + u64::from(trial.direction(&down) >= 0.0);
            }
            let vision_s = trial.vision_s();
            score.vision_s.extend(vision_s.map(|t_s| t_s - trial.lift_s));
            match trial.network_s() {
                Some(network_s) => {
                    score.network_s.push(network_s - trial.lift_s);
                    score.lead_s.extend(vision_s.map(|vision_s| vision_s - network_s));
                    let without_s = trial.vision_without_delay_s();
                    score.lead_no_delay_s.extend(without_s.map(|vision_s| vision_s - network_s));
                }
                None => score.missed += 1,
            }
        }
        score
    }

    /// Of the leads.
    #[must_use]
    pub fn lead(&self) -> Spread {
        Spread::of(&self.lead_s)
    }
}

/// For programs: these keys, and no others (`docs/hebbian.md`).
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Held-out trials.
    pub trials: u64,
    /// First said by the network, s after the lift began, mean.
    pub network_first_s_mean: f64,
    /// First said by the camera's codes, likewise.
    pub vision_first_s_mean: f64,
    /// How much earlier the network was, s.
    pub lead_s: Spread,
    /// The same over a camera without delay.
    pub lead_s_no_delay: Spread,
    /// The same as `lead_s` with equal weights in place of learned ones.
    pub lead_s_equal_weights: Spread,
    /// The mean lead of the worst finger made by chance, s: of those trials in which it saw the slip. Null if there is none.
    pub worst_finger_lead_s: Option<f64>,
    /// Trials whose slip the network did not see.
    pub missed: u64,
    /// False alarms in an hour of holding.
    pub false_per_hour: f64,
    /// How long was held, h.
    pub holding_hours: f64,
    /// Lifts of all fingers with 1.5 to 3 times the needed force.
    pub safe: Safe,
    /// Slips, up or down, of which o2 said the wrong direction.
    pub direction_wrong: u64,
    /// The same learning on fingers made by chance.
    pub fingertips: Fingertips,
}

/// Fingers made by chance.
#[derive(Clone, Debug, Serialize)]
pub struct Fingertips {
    /// How many.
    pub count: u64,
    /// The mean lead of the worst of them, s. Null if one of them missed a slip or told a direction wrongly, or there are
    /// none.
    pub worst_lead_s: Option<f64>,
    /// Trials of theirs whose slip was not seen, and all of them.
    pub missed: [u64; 2],
    /// Where sliding keeps at most 0.75 of static friction.
    pub slippery: Group,
    /// Where it keeps more.
    pub even: Group,
}

/// Some of them.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Group {
    /// How many.
    pub count: usize,
    /// Mean lead, s.
    pub lead_s: f64,
    /// The same over a camera without delay.
    pub lead_s_no_delay: f64,
    /// The same as `lead_s` with equal weights.
    pub lead_s_equal_weights: f64,
    /// Trials whose slip was not seen, and with equal weights.
    pub missed: [u64; 2],
    /// Lead, s, and trials whose slip was not seen, of each control.
    pub controls: BTreeMap<&'static str, Controlled>,
}

/// What a control came to.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Controlled {
    /// Mean lead of those trials in which it saw the slip, s.
    pub lead_s: f64,
    /// Trials whose slip it did not see.
    pub missed: u64,
}

/// Lifts with more force than the object needs, in which every verdict is false.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Safe {
    /// How many.
    pub lifts: u64,
    /// In which slip was said.
    pub said: u64,
}

/// Sliding keeps so much of static friction at most in the fingers of the first group.
const SLIPPERY: f64 = 0.75;

impl Group {
    fn of<'a>(others: impl Iterator<Item = &'a Other>) -> Self {
        let others: Vec<&Other> = others.collect();
        let mean = |of: &dyn Fn(&Other) -> &Vec<f64>| {
            let all: Vec<f64> = others.iter().flat_map(|other| of(other).iter().copied()).collect();
            Spread::of(&all).mean
        };
        Self {
            count: others.len(),
            lead_s: mean(&|other| &other.score.lead_s),
            lead_s_no_delay: mean(&|other| &other.score.lead_no_delay_s),
            lead_s_equal_weights: mean(&|other| &other.equal().lead_s),
            missed: [
                others.iter().map(|other| other.score.missed).sum(),
                others.iter().map(|other| other.equal().missed).sum(),
            ],
            controls: Control::ALL
                .into_iter()
                .enumerate()
                .map(|(n, control)| {
                    let lead_s = mean(&|other| &other.controls[n].lead_s);
                    let missed = others.iter().map(|other| other.controls[n].missed).sum();
                    (control.key(), Controlled { lead_s, missed })
                })
                .collect(),
        }
    }
}

impl Report {
    /// Of an outcome.
    #[must_use]
    pub fn of(outcome: &Outcome) -> Self {
        let score = &outcome.score;
        Self {
            trials: score.trials,
            network_first_s_mean: Spread::of(&score.network_s).mean,
            vision_first_s_mean: Spread::of(&score.vision_s).mean,
            lead_s: score.lead(),
            lead_s_no_delay: Spread::of(&score.lead_no_delay_s),
            lead_s_equal_weights: outcome.equal.lead(),
            worst_finger_lead_s: outcome.worst_lead_s(),
            missed: score.missed,
            false_per_hour: outcome.false_per_hour(),
            holding_hours: outcome.holding.hours,
            safe: outcome.safe(),
            direction_wrong: score.direction_wrong,
            fingertips: Fingertips {
                count: outcome.others.len() as u64,
                worst_lead_s: outcome.others_work().then(|| outcome.worst_lead_s()).flatten(),
                missed: [
                    outcome.others.iter().map(|other| other.score.missed).sum(),
                    outcome.others.iter().map(|other| other.score.trials).sum(),
                ],
                slippery: outcome.group(true),
                even: outcome.group(false),
            },
        }
    }
}

impl Outcome {
    /// False alarms in an hour of holding.
    #[must_use]
    pub fn false_per_hour(&self) -> f64 {
        if self.holding.hours > 0.0 { f64::from(self.holding.false_alarms) / self.holding.hours } else { 0.0 }
    }

    /// Lifts with more force than is needed.
    #[must_use]
    pub fn safe(&self) -> Safe {
        self.others.iter().fold(Safe::default(), |all, other| Safe {
            lifts: all.lifts + other.safe.lifts,
            said: all.said + other.safe.said,
        })
    }

    /// Whether every finger made by chance saw every slip and its direction.
    #[must_use]
    pub fn others_work(&self) -> bool {
        self.others.iter().all(|other| other.score.missed == 0 && other.score.direction_wrong == 0)
    }

    /// The mean lead of the worst finger made by chance, s.
    #[must_use]
    pub fn worst_lead_s(&self) -> Option<f64> {
        let seen = self.others.iter().filter(|other| !other.score.lead_s.is_empty());
        seen.map(|other| other.score.lead().mean).min_by(f64::total_cmp)
    }

    /// The fingers made by chance whose sliding keeps at most 0.75 of static friction, or the others.
    #[must_use]
    pub fn group(&self, slippery: bool) -> Group {
        Group::of(self.others.iter().filter(|other| (other.ratio <= SLIPPERY) == slippery))
    }
}

/// A figure of each judge's runs, in the order of [`JUDGES`].
#[must_use]
pub fn of_judges(runs: &[Three], figure: impl Fn(&Reflexed) -> f64) -> [Spread; 3] {
    [0, 1, 2].map(|judge| Spread::of(&runs.iter().map(|three| figure(&three[judge])).collect::<Vec<_>>()))
}

const _: () = assert!(JUDGES.len() == 3);

/// For people.
#[derive(Clone, Copy, Debug)]
pub struct Text<'a>(pub &'a Outcome);

impl fmt::Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let outcome = self.0;
        let (score, options) = (&outcome.score, &outcome.options);
        let mut line = |what: &str, figure: String| writeln!(f, "  {what:<26}{figure}");
        let seconds = |spread: Spread| format!("{:.3} s, sd {:.3}", spread.mean, spread.sd);
        line("learned", format!("{LESSONS} trials, seed {}, {} board", options.seed, outcome.board))?;
        if let Some(agreement) = &outcome.agreement {
            line("image and host's logic", agreement.to_string())?;
        }
        line("before", format!("largest output {} of 128", outcome.untaught))?;
        line("held-out trials", format!("{}, {} missed", score.trials, score.missed))?;
        line("first said by touch", seconds(Spread::of(&score.network_s)))?;
        line("first said by vision", seconds(Spread::of(&score.vision_s)))?;
        line("first place let go", seconds(Spread::of(&score.micro_s)))?;
        line("all of it slid", seconds(Spread::of(&score.macro_s)))?;
        let lead = score.lead();
        line("touch is earlier by", format!("{}, worst {:.3}", seconds(lead), lead.min))?;
        line("over a camera at once", seconds(Spread::of(&score.lead_no_delay_s)))?;
        line(
            "with equal weights",
            format!("{}, {} missed", seconds(outcome.equal.lead()), outcome.equal.missed),
        )?;
        line("direction wrong", format!("{} of {} slips", score.direction_wrong, 2 * score.trials))?;
        line("false in the trials", format!("{} of {}", score.false_alarms, score.trials))?;
        line(
            "false while holding",
            format!("{} in {:.2} h", outcome.holding.false_alarms, outcome.holding.hours),
        )?;
        let three = |runs: &[Three], unit: &str, figure: fn(&Reflexed) -> f64| {
            let [touch, vision, oracle] = of_judges(runs, figure);
            format!(
                "touch {:.3} {unit} (sd {:.3}), vision {:.3} (sd {:.3}), oracle {:.3} (sd {:.3})",
                touch.mean, touch.sd, vision.mean, vision.sd, oracle.mean, oracle.sd
            )
        };
        line("lift, secured after", three(&outcome.lifts, "s", |run| run.secured_s))?;
        line("lift, slipped", three(&outcome.lifts, "mm", |run| run.distance_mm))?;
        line("pour, slipped", three(&outcome.pours, "mm", |run| run.distance_mm))?;
        for (name, tried) in ["learned", "equal weights"].iter().zip(outcome.crackling.iter().flatten()) {
            let (score, holding) = tried;
            let lead = score.lead().mean;
            line(
                "one film crackles",
                format!(
                    "{name}: lead {lead:.3} s, {} missed, {} of {} trials false, {} false in {:.2} h",
                    score.missed, score.false_alarms, score.trials, holding.false_alarms, holding.hours
                ),
            )?;
        }
        let safe = outcome.safe();
        line("lifts that would hold", format!("slip said in {} of {}", safe.said, safe.lifts))?;
        for (what, slippery) in [("fingers, ratio to 0.75", true), ("fingers, ratio above", false)] {
            let group = outcome.group(slippery);
            let [missed, equal_missed] = group.missed;
            line(
                what,
                format!(
                    "{}: lead {:.3} s, {:.3} over a camera at once, {missed} missed; equal weights {:.3} s, {equal_missed} missed",
                    group.count, group.lead_s, group.lead_s_no_delay, group.lead_s_equal_weights
                ),
            )?;
            for (control, Controlled { lead_s, missed }) in &group.controls {
                line("", format!("{control:<20} lead {lead_s:.3} s, {missed} missed"))?;
            }
        }
        let sum = |of: fn(&Score) -> u64| outcome.others.iter().map(|other| of(&other.score)).sum::<u64>();
        let trials = sum(|score| score.trials);
        line(
            "other fingers",
            format!(
                "{}: {} of {trials} trials missed, {} directions wrong, {} trials with a false alarm, worst mean lead {}",
                outcome.others.len(),
                sum(|score| score.missed),
                sum(|score| score.direction_wrong),
                sum(|score| score.false_alarms),
                outcome.worst_lead_s().map_or("-".to_owned(), |s| format!("{s:.3} s")),
            ),
        )
    }
}
