//! From what was heard to the numbers of a row, with their intervals.

use std::ops::Range;

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use tenax_frames::quantile::not_exceeded;
use tenax_sim::scorer::{CAUGHT_WITHIN_S, Outcome, false_alarms_s, outcome};

use super::heard::{Heard, Kind};

/// Slips that slide at least so far are counted, mm.
pub const SLID_MM: [f64; 3] = [0.1, 1.0, 5.0];
/// Times that fingertips are drawn anew for an interval.
const DRAWS: usize = 1_000;
const TAIL: f64 = 0.025;

/// A part or a rate and where it lies with 95 %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Between {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

/// A slip: whose, how far, and what a row made of it.
#[derive(Clone, Copy, Debug)]
struct Slip {
    finger: u64,
    mm: f64,
    outcome: Outcome,
}

#[derive(Clone, Debug, Default)]
pub struct Scored {
    slips: Vec<Slip>,
    /// False alarms and hours, of each kind.
    alarms: [(u64, f64); 3],
}

impl Scored {
    /// A row whose judges have these places in what was heard: of each slip the first word counts, and words that begin within 50 ms of
    /// each other are one false alarm.
    pub fn of(heard: &[Heard], judges: Range<usize>) -> Self {
        let mut scored = Self::default();
        for own in heard {
            let (from_s, to_s) = own.span_s;
            let inside = |t_s: f64| (from_s..to_s).contains(&t_s);
            let said = || own.said.get(judges.clone()).unwrap_or_default().iter();
            for slip in own.slips.iter().filter(|slip| !slip.meant) {
                let Some(macro_s) = slip.macro_onset_s.filter(|&s| inside(s) && own.kind == Kind::Slips)
                else {
                    continue;
                };
                let outcomes = said().map(|said| outcome(slip, macro_s, said));
                let outcome =
                    outcomes.min_by(|a, b| rank(*a).total_cmp(&rank(*b))).unwrap_or(Outcome::Missed);
                scored.slips.push(Slip { finger: own.finger, mm: slip.distance_mm, outcome });
            }
            let (count, hours) = &mut scored.alarms[own.kind as usize];
            let mut false_s: Vec<f64> =
                said().flat_map(|said| false_alarms_s(&own.slips, said)).filter(|&t_s| inside(t_s)).collect();
            false_s.sort_by(f64::total_cmp);
            false_s.dedup_by(|next, last| *next - *last < CAUGHT_WITHIN_S);
            *count += false_s.len() as u64;
            *hours += (to_s - from_s) / 3_600.0;
        }
        scored
    }

    fn at_least(&self, mm: f64) -> impl Iterator<Item = &Slip> {
        self.slips.iter().filter(move |slip| slip.mm >= mm)
    }

    pub fn count(&self, mm: f64) -> usize {
        self.at_least(mm).count()
    }

    /// The part of the slips that slide so far in which a word began between micro onset and 50 ms after macro onset. The interval draws
    /// fingertips anew, for the slips of one are alike; where that gives a point it is Wilson's. None if there is no such slip.
    pub fn recall(&self, mm: f64) -> Option<Between> {
        let mut fingers: Vec<(u64, f64, f64)> = Vec::new();
        for slip in self.at_least(mm) {
            if fingers.last().is_none_or(|last| last.0 != slip.finger) {
                fingers.push((slip.finger, 0.0, 0.0));
            }
            if let Some((_, caught, all)) = fingers.last_mut() {
                *caught += f64::from(u8::from(matches!(slip.outcome, Outcome::Caught(_))));
                *all += 1.0;
            }
        }
        let sum = |drawn: &mut dyn Iterator<Item = &(u64, f64, f64)>| {
            let (caught, all) = drawn.fold((0.0, 0.0), |sum, own| (sum.0 + own.1, sum.1 + own.2));
            (caught, all)
        };
        let (caught, all) = sum(&mut fingers.iter());
        if all == 0.0 {
            return None;
        }
        let value = caught / all;
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut drawn: Vec<f64> = (0..DRAWS)
            .map(|_| {
                let (caught, all) =
                    sum(&mut (0..fingers.len()).map(|_| &fingers[rng.random_range(0..fingers.len())]));
                caught / all
            })
            .collect();
        drawn.sort_by(f64::total_cmp);
        let at = |part: f64| drawn[((part * DRAWS as f64) as usize).min(DRAWS - 1)];
        let (mut low, mut high) = (at(TAIL), at(1.0 - TAIL));
        if high - low < 1e-9 {
            (low, high) = wilson(caught, all);
        }
        Some(Between { value, low: low.min(value), high: high.max(value) })
    }

    /// The part of the slips that slide so far in which nothing began and a word stood since before. None if there is no such slip.
    pub fn stood_before(&self, mm: f64) -> Option<f64> {
        let stood = self.at_least(mm).filter(|slip| slip.outcome == Outcome::SaidBefore).count();
        (self.count(mm) > 0).then(|| stood as f64 / self.count(mm) as f64)
    }

    /// False alarms an hour of this kind, as Poisson counts. None if nothing of it was heard.
    pub fn false_per_hour(&self, kind: Kind) -> Option<Between> {
        let (count, hours) = self.alarms[kind as usize];
        (hours > 0.0).then(|| {
            let n = count as f64;
            let quantile = |freedom: f64, part: f64| {
                if freedom == 0.0 {
                    0.0
                } else {
                    ChiSquared::new(freedom).map_or(0.0, |chi| chi.inverse_cdf(part))
                }
            };
            Between {
                value: n / hours,
                low: quantile(2.0 * n, TAIL) / 2.0 / hours,
                high: quantile(2.0 * n + 2.0, 1.0 - TAIL) / 2.0 / hours,
            }
        })
    }

    pub fn hours(&self, kind: Kind) -> f64 {
        self.alarms[kind as usize].1
    }

    /// The word less macro onset that this part of those caught does not exceed, ms, of slips of at least 1 mm; negative is early.
    pub fn latency_ms(&self, part: f64) -> Option<f64> {
        let caught = self.at_least(1.0).filter_map(|slip| match slip.outcome {
            Outcome::Caught(s) => Some(1e3 * s),
            _ => None,
        });
        not_exceeded(caught, part)
    }

    /// The median of macro onset less the word of those that came before it, ms.
    pub fn lead_ms(&self) -> Option<f64> {
        let early = self.at_least(1.0).filter_map(|slip| match slip.outcome {
            Outcome::Caught(s) if s < 0.0 => Some(-1e3 * s),
            _ => None,
        });
        not_exceeded(early, 0.5)
    }
}

/// The first word is best, however early; what is caught before what is late, and that before what nobody began to say.
fn rank(outcome: Outcome) -> f64 {
    match outcome {
        Outcome::Caught(s) => s,
        Outcome::Late(s) => 1e6 + s,
        Outcome::SaidBefore => 2e6,
        Outcome::Missed => 3e6,
    }
}

/// Wilson's interval at 95 %.
fn wilson(caught: f64, all: f64) -> (f64, f64) {
    const Z: f64 = 1.96;
    let (part, z2) = (caught / all, Z * Z / all);
    let middle = (part + z2 / 2.0) / (1.0 + z2);
    let half = Z / (1.0 + z2) * (part * (1.0 - part) / all + z2 / (4.0 * all)).sqrt();
    ((middle - half).max(0.0), (middle + half).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_sim::scorer::{SlipSpan, Verdict};

    fn heard(finger: u64, kind: Kind, said: Vec<Vec<Verdict>>) -> Heard {
        let slip = |at_s: f64, distance_mm: f64| SlipSpan {
            micro_onset_s: at_s,
            macro_onset_s: Some(at_s + 0.1),
            end_s: at_s + 0.5,
            distance_mm,
            meant: false,
        };
        let slips = if kind == Kind::Slips {
            vec![slip(1.0, 0.05), slip(3.0, 2.0), slip(5.0, 8.0)]
        } else {
            Vec::new()
        };
        Heard { finger, kind, span_s: (0.0, 36.0), slips, said }
    }

    /// One that never says anything, one that never stops, one that begins anew every 10 ms, one that hears the slip of 8 mm 20 ms before
    /// it slides.
    fn words() -> Vec<Vec<Verdict>> {
        let shouting =
            (0..3_600).map(|n| Verdict::new(f64::from(n) * 0.01, f64::from(n) * 0.01 + 0.005)).collect();
        vec![Vec::new(), vec![Verdict::new(0.0, f64::INFINITY)], shouting, vec![Verdict::new(5.08, 5.2)]]
    }

    #[test]
    fn one_that_is_deaf_one_that_never_stops_and_one_that_shouts_are_told_apart() {
        let all: Vec<Heard> = (0..4)
            .flat_map(|finger| {
                [Kind::Slips, Kind::Quiet, Kind::Disturbed].map(|kind| heard(finger, kind, words()))
            })
            .collect();
        let of = |row: usize| Scored::of(&all, row..row + 1);
        let recall = |row: usize, mm: f64| of(row).recall(mm).unwrap().value;
        let per_hour = |row: usize| of(row).false_per_hour(Kind::Quiet).unwrap();
        // Deaf: nothing caught, no false alarm, and no latency.
        assert_eq!(
            (recall(0, 1.0), per_hour(0).value, of(0).latency_ms(0.5), of(0).lead_ms()),
            (0.0, 0.0, None, None)
        );
        // It has been heard for 144 s without an alarm: fewer than 3.7 in that time, with 97.5 %.
        assert!((per_hour(0).high - 3.689 / 0.04).abs() < 0.1, "{:?}", per_hour(0));
        // What stands for ever began once, outside every slip: it has caught nothing.
        assert_eq!((recall(1, 1.0), per_hour(1).value), (0.0, 100.0));
        // What shouts catches everything, and has a false alarm in every 50 ms.
        assert_eq!((recall(2, 1.0), recall(2, 0.1)), (1.0, 1.0));
        assert!((55_000.0..73_000.0).contains(&per_hour(2).value), "{:?}", per_hour(2));
        // Half of the slips of a millimetre and more, all of 5 and more.
        assert_eq!((recall(3, 1.0), recall(3, 5.0), of(3).count(0.1), of(3).count(1.0)), (0.5, 1.0, 8, 8));
        assert_eq!(of(3).lead_ms().map(f64::round), Some(20.0));
        assert_eq!(of(3).latency_ms(0.5).map(f64::round), Some(-20.0));
    }

    #[test]
    fn of_a_pair_the_first_word_counts_and_a_common_false_alarm_is_one() {
        let words = vec![
            vec![Verdict::new(0.5, 5.2)],
            vec![Verdict::new(0.52, 0.6), Verdict::new(5.08, 5.2), Verdict::new(20.0, 20.1)],
        ];
        let own = [heard(1, Kind::Slips, words)];
        let scored = |judges| Scored::of(&own, judges);
        // What stands before hides nothing of the other.
        assert_eq!(scored(0..1).stood_before(1.0), Some(1.0));
        assert_eq!(scored(0..2).recall(5.0).map(|own| own.value), Some(1.0));
        let alarms = |judges| scored(judges).false_per_hour(Kind::Slips).unwrap().value.round();
        assert_eq!((alarms(0..1), alarms(1..2), alarms(0..2)), (100.0, 200.0, 200.0));
    }

    #[test]
    fn intervals_bracket_and_shrink_with_more_fingertips() {
        let some = |fingers: u64| -> Vec<Heard> {
            let said = |finger: u64| {
                if finger.is_multiple_of(3) { Vec::new() } else { vec![Verdict::new(5.08, 5.2)] }
            };
            (0..fingers).map(|finger| heard(finger, Kind::Slips, vec![said(finger)])).collect()
        };
        let recall = |fingers: u64| Scored::of(&some(fingers), 0..1).recall(5.0).unwrap();
        for fingers in [3, 12, 48] {
            let Between { value, low, high } = recall(fingers);
            assert!(
                (value - 2.0 / 3.0).abs() < 1e-9 && low < value && value < high && high <= 1.0,
                "{low} {value} {high}"
            );
        }
        assert!(recall(48).high - recall(48).low < 0.6 * (recall(12).high - recall(12).low));
        // All of them caught is no proof that all will be.
        let Between { value, low, high } =
            Scored::of(&[heard(1, Kind::Slips, words())], 2..3).recall(1.0).unwrap();
        assert!(value == 1.0 && high == 1.0 && low < 0.5, "{low}");
        assert_eq!(Scored::of(&[heard(1, Kind::Quiet, words())], 2..3).recall(1.0), None);
    }
}
