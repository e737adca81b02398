//! The one definition of caught, and of a false alarm: `run`, `learn` and `check` score with it.
//!
//! A macro slip is **caught** if a detection begins between its micro onset and 50 ms after its macro onset: `early` if that is before the
//! macro onset. One that begins later is **late**, until 50 ms after the slip's end: a detection may take so long there, too. A verdict
//! that stood before the micro onset is no detection: if nothing begins within the slip, it was **said before**. What begins outside every
//! slip is a **false alarm**, counted by what was going on. What the wearer does on purpose is neither: slips that they meant are left out,
//! and so is what begins in one or while a muscle is active.
//!
//! Micro slip that never became macro slip is no slip to be caught. A detection in it is right about the contact and the reflex
//! may have prevented the slip; it is a false alarm all the same, and `in_micro_slip` says how many are of that kind.

pub mod doing;

use std::collections::BTreeMap;

use serde::Serialize;
use tenax_frames::quantile::not_exceeded;

pub use doing::{Doing, Stretch};

pub const CAUGHT_WITHIN_S: f64 = 0.050;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipSpan {
    pub micro_onset_s: f64,
    /// When all of it did, s. None if it never came to that.
    pub macro_onset_s: Option<f64>,
    /// When everything stuck again, s. Infinite if it never did.
    pub end_s: f64,
    pub distance_mm: f64,
    pub meant: bool,
}

impl SlipSpan {
    pub fn last_s(&self) -> f64 {
        self.end_s + CAUGHT_WITHIN_S
    }

    pub fn owns(&self, t_s: f64) -> bool {
        (self.micro_onset_s..=self.last_s()).contains(&t_s)
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    pub from_s: f64,
    /// It ended, s. Infinite if it never did.
    pub to_s: f64,
    pub by_wearer: bool,
}

impl Verdict {
    pub const fn new(from_s: f64, to_s: f64) -> Self {
        Self { from_s, to_s, by_wearer: false }
    }

    pub fn go_on(all: &mut Vec<Self>, t_s: f64, stands: bool) {
        let open = all.last_mut().filter(|last| last.to_s == f64::INFINITY);
        match (open, stands) {
            (None, true) => all.push(Self::new(t_s, f64::INFINITY)),
            (Some(open), false) => open.to_s = t_s,
            _ => {}
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// A detection began in time, so long after macro onset, s: negative is early.
    Caught(f64),
    /// The first detection began so long after macro onset, s.
    Late(f64),
    SaidBefore,
    Missed,
}

/// **The definition of caught.** `macro_onset_s` is the slip's.
pub fn outcome(slip: &SlipSpan, macro_onset_s: f64, verdicts: &[Verdict]) -> Outcome {
    let own = || verdicts.iter().filter(|verdict| !verdict.by_wearer);
    let first = own().map(|verdict| verdict.from_s).find(|&from_s| slip.owns(from_s));
    match first {
        Some(at_s) if at_s <= macro_onset_s + CAUGHT_WITHIN_S => Outcome::Caught(at_s - macro_onset_s),
        Some(at_s) => Outcome::Late(at_s - macro_onset_s),
        None if own().any(|stood| stood.from_s < slip.micro_onset_s && stood.to_s > slip.micro_onset_s) => {
            Outcome::SaidBefore
        }
        None => Outcome::Missed,
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Alarms {
    pub hours: f64,
    pub count: usize,
    pub in_micro_slip: usize,
    pub per_hour: f64,
}

impl Alarms {
    fn add(&mut self, other: Self) {
        self.hours += other.hours;
        self.count += other.count;
        self.in_micro_slip += other.in_micro_slip;
        self.per_hour = if self.hours > 0.0 { self.count as f64 / self.hours } else { 0.0 };
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    pub count: usize,
    /// Those that a detection began in between micro onset and 50 ms after macro onset.
    pub caught: usize,
    pub early: usize,
    pub late: usize,
    pub said_before: usize,
    pub missed: usize,
}

impl Counts {
    fn take(&mut self, outcome: Outcome) {
        self.count += 1;
        match outcome {
            Outcome::Caught(latency_s) => {
                self.caught += 1;
                self.early += usize::from(latency_s < 0.0);
            }
            Outcome::Late(_) => self.late += 1,
            Outcome::SaidBefore => self.said_before += 1,
            Outcome::Missed => self.missed += 1,
        }
    }

    fn add(&mut self, other: Self) {
        self.count += other.count;
        self.caught += other.caught;
        self.early += other.early;
        self.late += other.late;
        self.said_before += other.said_before;
        self.missed += other.missed;
    }
}

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Card {
    #[serde(flatten)]
    pub slips: Counts,
    /// Detection less macro onset of those caught, ms, in their order.
    #[serde(skip)]
    pub latencies_ms: Vec<f64>,
    pub false_alarms: Alarms,
    pub false_by: BTreeMap<Doing, Alarms>,
}

impl Card {
    pub fn of(slips: &[SlipSpan], verdicts: &[Verdict], doing: &[Stretch]) -> Self {
        let mut card = Self::default();
        for slip in slips.iter().filter(|slip| !slip.meant) {
            let Some(macro_onset_s) = slip.macro_onset_s else { continue };
            let outcome = outcome(slip, macro_onset_s, verdicts);
            card.slips.take(outcome);
            if let Outcome::Caught(latency_s) = outcome {
                card.latencies_ms.push(latency_s * 1e3);
            }
        }
        let alarms_s = false_alarms_s(slips, verdicts);
        let in_micro_slip =
            |t_s: f64| slips.iter().any(|slip| slip.macro_onset_s.is_none() && slip.owns(t_s));
        for stretch in doing {
            let hours = (stretch.to_s - stretch.from_s) / 3_600.0;
            let own = || alarms_s.iter().filter(|t_s| (stretch.from_s..stretch.to_s).contains(t_s));
            let in_micro_slip = own().filter(|&&t_s| in_micro_slip(t_s)).count();
            let alarms = Alarms { hours, count: own().count(), in_micro_slip, per_hour: 0.0 };
            card.false_by.entry(stretch.doing).or_default().add(alarms);
            card.false_alarms.add(alarms);
        }
        card
    }

    pub fn add(&mut self, other: &Self) {
        self.slips.add(other.slips);
        self.latencies_ms.extend(&other.latencies_ms);
        self.false_alarms.add(other.false_alarms);
        for (&doing, alarms) in &other.false_by {
            self.false_by.entry(doing).or_default().add(*alarms);
        }
    }

    /// The latency that this part of those caught do not exceed, ms. None if none was caught.
    pub fn latency_ms(&self, part: f64) -> Option<f64> {
        not_exceeded(self.latencies_ms.iter().copied(), part)
    }
}

pub fn false_alarms_s(slips: &[SlipSpan], verdicts: &[Verdict]) -> Vec<f64> {
    let is_slip = |t_s: f64| slips.iter().any(|slip| slip.macro_onset_s.is_some() && slip.owns(t_s));
    verdicts
        .iter()
        .filter(|verdict| !verdict.by_wearer && !is_slip(verdict.from_s))
        .map(|verdict| verdict.from_s)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLIP: SlipSpan =
        SlipSpan { micro_onset_s: 1.0, macro_onset_s: Some(1.1), end_s: 1.3, distance_mm: 1.0, meant: false };
    const MICRO: SlipSpan =
        SlipSpan { micro_onset_s: 2.0, macro_onset_s: None, end_s: 2.1, distance_mm: 0.0, ..SLIP };

    fn whole() -> [Stretch; 1] {
        [Stretch { from_s: 0.0, to_s: 3.6, doing: Doing::Pour }]
    }

    fn verdicts(spans: &[(f64, f64)]) -> Vec<Verdict> {
        spans.iter().map(|&(from_s, to_s)| Verdict::new(from_s, to_s)).collect()
    }

    fn card(spans: &[(f64, f64)]) -> Card {
        Card::of(&[SLIP, MICRO], &verdicts(spans), &whole())
    }

    #[test]
    fn caught_is_from_micro_onset_to_50_ms_after_macro_onset_and_must_begin_there() {
        for (spans, expected) in [
            (&[(1.0, 1.2)][..], Outcome::Caught(-0.1)),
            (&[(1.149, 1.2)], Outcome::Caught(0.049)),
            (&[(1.16, 1.2)], Outcome::Late(0.06)),
            (&[(0.9, 1.2)], Outcome::SaidBefore),
            // It stood before, fell silent, and began anew in time.
            (&[(0.9, 1.05), (1.12, 1.2)], Outcome::Caught(0.02)),
            (&[(0.5, 0.9)], Outcome::Missed),
            (&[(1.34, 1.4)], Outcome::Late(0.24)),
            (&[(1.36, 1.4)], Outcome::Missed),
            (&[], Outcome::Missed),
        ] {
            let found = outcome(&SLIP, 1.1, &verdicts(spans));
            let near = match (found, expected) {
                (Outcome::Caught(a), Outcome::Caught(b)) | (Outcome::Late(a), Outcome::Late(b)) => {
                    (a - b).abs() < 1e-9
                }
                (a, b) => a == b,
            };
            assert!(near, "{spans:?}: {found:?} for {expected:?}");
        }
    }

    #[test]
    fn every_slip_is_one_of_four_and_every_other_detection_is_false() {
        let scored = card(&[(0.2, 0.3), (0.95, 1.05), (1.12, 1.2), (1.25, 1.28), (2.05, 2.06), (3.0, 3.1)]);
        let slips = scored.slips;
        assert_eq!((slips.count, slips.caught, slips.early), (1, 1, 0));
        assert_eq!(slips.count, slips.caught + slips.late + slips.said_before + slips.missed);
        let alarms = scored.false_by[&Doing::Pour];
        assert_eq!((alarms.count, alarms.in_micro_slip), (4, 1));
        assert!((alarms.per_hour - 4_000.0).abs() < 1e-6 && scored.false_alarms == alarms);
    }

    #[test]
    fn what_the_wearer_does_is_neither_caught_nor_false() {
        let meant = SlipSpan { meant: true, ..SLIP };
        let mut verdicts = [Verdict::new(1.12, 1.2), Verdict::new(3.0, 3.1)];
        let without = Card::of(&[meant], &verdicts, &whole());
        assert_eq!((without.slips.count, without.false_alarms.count), (0, 1));
        verdicts[1].by_wearer = true;
        assert_eq!(Card::of(&[meant], &verdicts, &whole()).false_alarms.count, 0);
        // The control: what begins by a muscle catches nothing either.
        verdicts[0].by_wearer = true;
        assert_eq!(Card::of(&[SLIP], &verdicts, &whole()).slips.missed, 1);
    }
}
