//! A fingertip that teaches itself slip: the bars of `tenax learn`, on the host's logic.

use super::{Bar, Goal};
use tenax_sim::session::Board;
use crate::learn::report::{Score, of_judges};
use crate::learn::{self, LESSONS, Options};

/// How much earlier than vision the network's first word must be on average, s: slip, or a warning of it (Tada 2006: 0.89 s less 0.73 s).
const LEAD_S: f64 = 0.16;
/// The part of vision's slip in the pour that may be left.
const POUR_PART: f64 = 0.5;

/// Minutes of holding, if not the three hours of the goal are asked for: two minutes of CI's fifteen would be theirs.
const MINUTES: u64 = 40;

/// The bars; `whole`: with all minutes of holding. Fails if a scene cannot be made.
pub fn bars(whole: bool) -> anyhow::Result<Vec<Bar>> {
    let defaults = Options { controls: false, ..Options::default() };
    let options = if whole { defaults } else { Options { minutes: MINUTES, ..defaults } };
    let outcome = learn::run(&options, &Board::Host, &|_, _| ())?;
    let (score, lead) = (&outcome.score, outcome.score.first.lead());
    let (slip, holding) = (&score.slip, &outcome.holding);
    let in_3_h = |alarms| 3.0 * holding.per_hour(alarms);
    let [touch_s, vision_s, bound_s] =
        of_judges(&outcome.lifts, |run| run.secured_s).map(|spread| spread.mean);
    let [touch_mm, vision_mm, bound_mm] =
        of_judges(&outcome.pours, |run| run.distance_mm).map(|spread| spread.mean);
    let worst_s = outcome.worst_lead_s().unwrap_or(f64::NAN);
    let sum = |of: fn(&Score) -> u64| outcome.others.iter().map(|other| of(&other.score)).sum::<u64>();
    let (missed, trials) = (sum(|score| score.first.missed), sum(|score| score.trials));
    let wrong = sum(|score| score.direction_wrong);
    Ok(vec![
        Bar::new(
            "learn: before learning the network says nothing",
            format!("largest output {} of 128", outcome.untaught),
            outcome.untaught == 0,
        ),
        Bar::new(
            format!(
                "learn: after {LESSONS} trials the network says slip or warns of it in all of {} others",
                score.trials
            ),
            format!("{} missed, {} with a false alarm", score.first.missed, score.first.false_alarms),
            score.first.missed == 0,
        ),
        Bar::new(
            format!("learn: its first word is at least {LEAD_S} s before vision on average"),
            format!("{:.3} s, sd {:.3}, worst {:.3}", lead.mean, lead.sd, lead.min),
            lead.mean >= LEAD_S,
        ),
        Bar::noted(
            "learn: slip alone, which the films say",
            format!("{:.3} s before vision, {} of {} missed", slip.lead().mean, slip.missed, score.trials),
        ),
        Bar::new(
            "learn: the direction is right in every trial, up and down",
            format!("{} of {} wrong", score.direction_wrong, 2 * score.trials),
            score.direction_wrong == 0,
        ),
        Bar::short_of(
            Goal { what: "learn: false alarms of slip, and of warnings, in three hours of holding", goal: 0.0, held: 1.0 },
            in_3_h(holding.slip).max(in_3_h(holding.warning)),
            format_args!(
                "slip {}, {} of them in micro slip, warnings {}, in {:.2} h with knocks of 50 Hz to 2 kHz, swings, motor noise",
                holding.slip.count, holding.slip.in_micro_slip, holding.warning.count, holding.hours
            ),
        ),
        Bar::noted(
            "learn: what learning is worth over equal weights",
            format!(
                "first word {:.3} s against {:.3} s with equal weights; slip {:.3} s against {:.3} s",
                lead.mean,
                outcome.equal.first.lead().mean,
                slip.lead().mean,
                outcome.equal.slip.lead().mean
            ),
        ),
        Bar::short_of(
            Goal { what: "learn: secured so much earlier than by vision, s", goal: 0.3, held: 0.15 },
            vision_s - touch_s,
            format_args!("{touch_s:.3} s against {vision_s:.3} s; bound {bound_s:.3} s"),
        ),
        Bar::new(
            "learn: in the pour it slips at most half as far as by vision",
            format!("{touch_mm:.2} mm against {vision_mm:.2} mm; bound {bound_mm:.2} mm"),
            touch_mm <= POUR_PART * vision_mm,
        ),
        Bar::short_of(
            Goal { what: "learn: part of the slips of random fingertips in which no word is said", goal: 0.0, held: 0.02 },
            missed as f64 / trials as f64,
            format_args!("{missed} of {trials} missed on {} fingertips", outcome.others.len()),
        ),
        Bar::new(
            format!("learn: on {} random fingertips every direction is right", outcome.others.len()),
            format!("{wrong} directions wrong, worst mean lead {worst_s:.3} s"),
            wrong == 0,
        ),
    ])
}
