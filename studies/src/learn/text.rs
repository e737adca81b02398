//! What a fingertip's learning is worth, for people.

use std::fmt;

use super::holding::{False, Holding};
use super::reflex::{Reflexed, Three};
use super::report::{Controlled, Score, Spread, Words, of_judges, said_s};
use super::{LESSONS, Outcome};

#[derive(Clone, Copy, Debug)]
pub struct Text<'a>(pub &'a Outcome);

fn seconds(spread: Spread) -> String {
    format!("{:.3} s, sd {:.3}", spread.mean, spread.sd)
}

/// Its lead over the camera with and without delay.
fn lead(words: &Words) -> String {
    let at_once = Spread::of(&words.lead_no_delay_s).mean;
    format!(
        "{}, worst {:.3}; {at_once:.3} s over a camera at once; {} missed",
        seconds(words.lead()),
        words.lead().min,
        words.missed
    )
}

fn held(holding: &Holding) -> String {
    let of = |alarms: False| format!("{}, {} of them in micro slip", alarms.count, alarms.in_micro_slip);
    format!("slip {}; warning {}; in {:.2} h", of(holding.slip), of(holding.warning), holding.hours)
}

impl fmt::Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let outcome = self.0;
        let (score, options) = (&outcome.score, &outcome.options);
        let mut line = |what: &str, figure: String| writeln!(f, "  {what:<26}{figure}");
        line("learned", format!("{LESSONS} trials, seed {}, {} board", options.seed, outcome.board))?;
        if let Some(agreement) = &outcome.agreement {
            line("image and host's logic", agreement.to_string())?;
        }
        line("before", format!("largest output {} of 128", outcome.untaught))?;
        line("held-out trials", score.trials.to_string())?;
        line("first word by touch", seconds(said_s(&score.first)))?;
        line("slip said by touch", seconds(said_s(&score.slip)))?;
        line("first said by vision", seconds(Spread::of(&score.vision_s)))?;
        line("first place let go", seconds(Spread::of(&score.micro_s)))?;
        line("all of it slid", seconds(Spread::of(&score.macro_s)))?;
        line("first word is earlier by", lead(&score.first))?;
        line("  with equal weights", lead(&outcome.equal.first))?;
        line("slip is said earlier by", lead(&score.slip))?;
        line("  with equal weights", lead(&outcome.equal.slip))?;
        let sooner = Spread::of(&score.slip.sooner_s(&outcome.equal.slip));
        line("  learned is sooner by", seconds(sooner))?;
        line("direction wrong", format!("{} of {} slips", score.direction_wrong, 2 * score.trials))?;
        let [any, slip] = [score.first.false_alarms, score.slip.false_alarms];
        line("false in the trials", format!("in {any} of {}, of them slip in {slip}", score.trials))?;
        line("false while holding", held(&outcome.holding))?;
        let three = |runs: &[Three], unit: &str, figure: fn(&Reflexed) -> f64| {
            let [touch, vision, bound] = of_judges(runs, figure);
            format!(
                "touch {:.3} {unit} (sd {:.3}), vision {:.3} (sd {:.3}), bound {:.3} (sd {:.3})",
                touch.mean, touch.sd, vision.mean, vision.sd, bound.mean, bound.sd
            )
        };
        line("lift, secured after", three(&outcome.lifts, "s", |run| run.secured_s))?;
        line("lift, slipped", three(&outcome.lifts, "mm", |run| run.distance_mm))?;
        line("lift, pressed with", three(&outcome.lifts, "N", |run| run.grip_n))?;
        line("pour, slipped", three(&outcome.pours, "mm", |run| run.distance_mm))?;
        line("pour, pressed with", three(&outcome.pours, "N", |run| run.grip_n))?;
        let safe = outcome.safe();
        line(
            "lifts that would hold",
            format!("a word in {} of {}, slip in {}", safe.said, safe.lifts, safe.slip),
        )?;
        for (what, slippery) in [("fingers, ratio to 0.75", true), ("fingers, ratio above", false)] {
            let group = outcome.group(slippery);
            line(
                what,
                format!(
                    "{}: first word {:.3} s, {:.3} over a camera at once, {} missed; slip {:.3} s, {:.3}, {} missed",
                    group.count,
                    group.lead_s,
                    group.lead_s_no_delay,
                    group.missed[0],
                    group.slip_lead_s,
                    group.slip_lead_s_no_delay,
                    group.slip_missed
                ),
            )?;
            let controls = group.controls.iter().filter(|_| options.controls);
            for (control, Controlled { lead_s, missed, slip }) in controls {
                line(
                    "",
                    format!(
                        "{control:<20} first word {lead_s:.3} s, {missed} missed; slip {:.3} s, {} missed, learned {:.3} s sooner",
                        slip.lead_s, slip.missed, slip.learned_sooner_s
                    ),
                )?;
            }
        }
        let apart = |n: usize| {
            Spread::of(&outcome.others.iter().map(|other| other.films_apart[n]).collect::<Vec<_>>()).mean
        };
        line("films unlike, sd/mean", format!("maxima {:.2}, learned weights {:.2}", apart(0), apart(1)))?;
        let sum = |of: fn(&Score) -> u64| outcome.others.iter().map(|other| of(&other.score)).sum::<u64>();
        let trials = sum(|score| score.trials);
        line(
            "other fingers",
            format!(
                "{}: no word in {} of {trials} trials, no slip in {}, {} directions wrong, {} trials with a false alarm, worst mean lead {}",
                outcome.others.len(),
                sum(|score| score.first.missed),
                sum(|score| score.slip.missed),
                sum(|score| score.direction_wrong),
                sum(|score| score.first.false_alarms),
                outcome.worst_lead_s().map_or("-".to_owned(), |s| format!("{s:.3} s")),
            ),
        )
    }
}
