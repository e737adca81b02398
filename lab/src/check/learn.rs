//! A fingertip that teaches itself slip: the bars of `tenax learn`, on the host's logic.

use super::{Bar, Goal, Verdict};
use crate::learn::report::{Score, told};
use crate::learn::{self, LESSONS, Options, Progress};

/// Lead of the network's first word (slip, or a warning of it) over vision, s, mean (Tada 2006: 0.89 s less 0.73 s).
const LEAD_S: f64 = 0.16;
/// Slip in the pour, as a part of vision's.
const POUR_PART: f64 = 0.5;
/// In `check`, minutes of holding: the goal's three hours would take two of CI's fifteen minutes.
pub const MINUTES: u64 = 40;

/// Fails if a scene cannot be made.
pub fn bars(options: &Options, progress: Progress) -> anyhow::Result<Vec<Bar>> {
    let outcome = learn::run(options, progress)?;
    let (score, lead) = (&outcome.score, outcome.score.first.lead());
    let (slip, holding) = (&score.slip, &outcome.holding);
    let in_3_h = 3.0 * holding.slip.per_hour.max(holding.warning.per_hour);
    let [touch_s, vision_s, bound_s] = told(&outcome.lifts).map(|own| own.secured_s);
    let [touch_mm, vision_mm, bound_mm] = told(&outcome.pours).map(|own| own.distance_mm);
    let worst_s = outcome.worst_lead_s().unwrap_or(f64::NAN);
    let sum = |of: fn(&Score) -> u64| outcome.others.iter().map(of).sum::<u64>();
    let (missed, trials) = (sum(|score| score.first.missed), sum(|score| score.trials));
    let wrong = sum(|score| score.direction_wrong);
    let goal = |what, goal, held| Goal { what, goal, held };
    Ok(vec![
        Bar::new(
            "learn: largest output before learning, of 128",
            outcome.untaught.to_string(),
            "0",
            outcome.untaught == 0,
        ),
        Bar::new(
            format!(
                "learn: slip or a warning in every one of {} trials after {LESSONS} lessons",
                score.trials
            ),
            format!("{} missed, {} with a false alarm", score.first.missed, score.first.false_alarms),
            "none missed",
            score.first.missed == 0,
        ),
        Bar::new(
            "learn: lead of the first word over vision, s, mean",
            format!("{:.3}, sd {:.3}, worst {:.3}", lead.mean, lead.sd, lead.min),
            LEAD_S.to_string(),
            lead.mean >= LEAD_S,
        ),
        Bar::unjudged(
            "learn: lead of slip alone, which the films report, s",
            format!("{:.3}, {} of {} missed", slip.lead().mean, slip.missed, score.trials),
            Verdict::Noted,
        ),
        Bar::new(
            "learn: directions, up and down",
            format!("{} of {} wrong", score.direction_wrong, 2 * score.trials),
            "none wrong",
            score.direction_wrong == 0,
        ),
        Bar::short_of(
            goal("learn: false alarms of slip, and of warnings, in three hours of holding", 0.0, 1.0),
            in_3_h,
            format_args!(
                "slip {}, {} of them in micro slip, warnings {}, in {:.2} h with disturbances",
                holding.slip.count, holding.slip.in_micro_slip, holding.warning.count, holding.slip.hours
            ),
        ),
        Bar::unjudged(
            "learn: learned weights against equal ones, lead, s",
            format!(
                "first word {:.3} against {:.3}; slip {:.3} against {:.3}",
                lead.mean,
                outcome.equal.first.lead().mean,
                slip.lead().mean,
                outcome.equal.slip.lead().mean
            ),
            Verdict::Noted,
        ),
        Bar::short_of(
            goal("learn: secured earlier than by vision, s", 0.3, 0.15),
            vision_s - touch_s,
            format_args!("{touch_s:.3} s against {vision_s:.3} s; bound {bound_s:.3} s"),
        ),
        Bar::new(
            "learn: slid in the pour, mm",
            format!("{touch_mm:.2} against {vision_mm:.2} by vision; bound {bound_mm:.2}"),
            "half of vision's",
            touch_mm <= POUR_PART * vision_mm,
        ),
        Bar::short_of(
            goal("learn: part of the slips of random fingertips without a word", 0.0, 0.02),
            missed as f64 / trials as f64,
            format_args!("{missed} of {trials} missed on {} fingertips", outcome.others.len()),
        ),
        Bar::new(
            format!("learn: directions on {} random fingertips", outcome.others.len()),
            format!("{wrong} wrong, worst mean lead {worst_s:.3} s"),
            "none wrong",
            wrong == 0,
        ),
    ])
}
