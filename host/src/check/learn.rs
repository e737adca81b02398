//! A fingertip that teaches itself slip: the bars of `tenax learn`, on the host's logic.

use super::Bar;
use crate::learn::report::{Score, of_judges};
use crate::learn::{self, LESSONS, Options};
use crate::session::Board;

/// How much earlier than vision the network's first word must be on average, s: slip, or a warning of it (Tada 2006: 0.89 s less 0.73 s).
const LEAD_S: f64 = 0.16;
/// How much earlier than by vision the object must be secured, s: what is kept on a friction of which sliding keeps 0.65, where
/// vision needs 0.1 s less than on the 0.47 of before (Tada 2006: 0.3).
const SECURED_S: f64 = 0.15;
/// False alarms of slip, and of warnings, in three hours of holding, with knocks of every kind.
const FALSE_IN_3_H: f64 = 1.0;
/// The part of the trials of fingers made by chance in whose slip no word may be said: shear foretells what drowns in the films'
/// noise.
const MISSED_PART: f64 = 0.02;
/// The part of vision's slip in the pour that may be left.
const POUR_PART: f64 = 0.5;

/// The bars.
///
/// # Errors
/// If a scene cannot be made.
pub fn bars() -> anyhow::Result<Vec<Bar>> {
    let options = Options { controls: false, ..Options::default() };
    let outcome = learn::run(&options, &Board::Host, &|_, _| ())?;
    let (score, lead) = (&outcome.score, outcome.score.first.lead());
    let (slip, holding) = (&score.slip, &outcome.holding);
    let in_3_h = |alarms| 3.0 * holding.per_hour(alarms);
    let [touch_s, vision_s, oracle_s] =
        of_judges(&outcome.lifts, |run| run.secured_s).map(|spread| spread.mean);
    let [touch_mm, vision_mm, oracle_mm] =
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
        Bar::new(
            format!(
                "learn: at most {FALSE_IN_3_H} false alarm of slip, and of warnings, in 3 h of holding with knocks of 50 Hz to 2 kHz, swings, motor noise"
            ),
            format!(
                "slip {}, {} of them in micro slip, warnings {}, in {:.2} h",
                holding.slip.count, holding.slip.in_micro_slip, holding.warning.count, holding.hours
            ),
            in_3_h(holding.slip) <= FALSE_IN_3_H && in_3_h(holding.warning) <= FALSE_IN_3_H,
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
        Bar::new(
            format!("learn: secured at least {SECURED_S} s earlier than by vision"),
            format!("{touch_s:.3} s against {vision_s:.3} s; oracle {oracle_s:.3} s"),
            vision_s - touch_s >= SECURED_S,
        ),
        Bar::new(
            "learn: in the pour it slips at most half as far as by vision",
            format!("{touch_mm:.2} mm against {vision_mm:.2} mm; oracle {oracle_mm:.2} mm"),
            touch_mm <= POUR_PART * vision_mm,
        ),
        Bar::new(
            format!(
                "learn: on {} random fingertips in at most {:.0} % of the slips no word is said, and every direction is right",
                outcome.others.len(),
                100.0 * MISSED_PART
            ),
            format!("{missed} of {trials} missed, {wrong} directions wrong, worst mean lead {worst_s:.3} s"),
            missed as f64 <= MISSED_PART * trials as f64 && wrong == 0,
        ),
    ])
}
