//! From what was heard to the numbers of a row, with their intervals.

use std::ops::Range;

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use statrs::distribution::{ChiSquared, ContinuousCDF};
use tenax_frames::quantile::not_exceeded;
use tenax_sim::scorer::{CAUGHT_WITHIN_S, Outcome, SlipSpan, false_alarms_s, outcome};

use super::heard::{Heard, Kind};

/// Slips that slide at least so far are counted, mm.
const SLID_MM: f64 = 1.0;
/// Times that fingertips are drawn anew for an interval.
const DRAWS: usize = 1_000;
const TAIL: f64 = 0.025;

/// A part or a rate, and the ends between which it lies with 95 %.
pub type Between = [f64; 3];

#[derive(Clone, Debug, Default)]
pub struct Scored {
    /// The fingertip of each slip, and the first report less macro onset, s, if it was caught.
    slips: Vec<(u64, Option<f64>)>,
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
            let mut said = own.said.get(judges.clone()).unwrap_or_default().concat();
            said.sort_by(|a, b| a.from_s.total_cmp(&b.from_s));
            let counts =
                |slip: &&SlipSpan| !slip.meant && slip.distance_mm >= SLID_MM && own.kind == Kind::Slips;
            for slip in own.slips.iter().filter(counts) {
                if let Some(macro_s) = slip.macro_onset_s.filter(|&s| inside(s)) {
                    let caught = match outcome(slip, macro_s, &said) {
                        Outcome::Caught(latency_s) => Some(latency_s),
                        _ => None,
                    };
                    scored.slips.push((own.finger, caught));
                }
            }
            let (count, hours) = &mut scored.alarms[own.kind as usize];
            let mut false_s = false_alarms_s(&own.slips, &said);
            false_s.retain(|&t_s| inside(t_s));
            false_s.dedup_by(|next, last| *next - *last < CAUGHT_WITHIN_S);
            *count += false_s.len() as u64;
            *hours += (to_s - from_s) / 3_600.0;
        }
        scored
    }

    pub fn count(&self) -> usize {
        self.slips.len()
    }

    /// The part of the slips in which a word began between micro onset and 50 ms after macro onset. The interval draws fingertips anew,
    /// for the slips of one are alike; where that gives a point it is Wilson's. None if there is no slip.
    pub fn recall(&self) -> Option<Between> {
        let fingers: Vec<_> = self.slips.chunk_by(|a, b| a.0 == b.0).collect();
        if fingers.is_empty() {
            return None;
        }
        let part = |fingers: &[&[(u64, Option<f64>)]]| {
            let slips = fingers.concat();
            slips.iter().filter(|slip| slip.1.is_some()).count() as f64 / slips.len() as f64
        };
        let value = part(&fingers);
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut again = || {
            let drawn: Vec<_> = fingers.iter().map(|_| fingers[rng.random_range(0..fingers.len())]).collect();
            part(&drawn)
        };
        let drawn: Vec<f64> = (0..DRAWS).map(|_| again()).collect();
        let [low, high] = [TAIL, 1.0 - TAIL].map(|part| not_exceeded(drawn.iter().copied(), part));
        let (mut low, mut high) = (low?, high?);
        if high - low < 1e-9 {
            (low, high) = wilson(value, self.count() as f64);
        }
        Some([value, low.min(value), high.max(value)])
    }

    /// False alarms an hour of this kind, as Poisson counts. None if nothing of it was heard.
    pub fn false_per_hour(&self, kind: Kind) -> Option<Between> {
        let (count, hours) = self.alarms[kind as usize];
        (hours > 0.0).then(|| a_unit(count as f64, hours))
    }

    pub fn hours(&self, kind: Kind) -> f64 {
        self.alarms[kind as usize].1
    }

    /// The word less macro onset that this part of those caught does not exceed, ms; negative is early.
    pub fn latency_ms(&self, part: f64) -> Option<f64> {
        not_exceeded(self.slips.iter().filter_map(|slip| Some(1e3 * slip.1?)), part)
    }
}

/// A Poisson count of so many units, for each.
pub fn a_unit(count: f64, units: f64) -> Between {
    let quantile = |freedom: f64, part: f64| match freedom {
        0.0 => 0.0,
        _ => ChiSquared::new(freedom).map_or(0.0, |chi| chi.inverse_cdf(part)),
    };
    let [low, high] = [quantile(2.0 * count, TAIL), quantile(2.0 * count + 2.0, 1.0 - TAIL)];
    [count, low / 2.0, high / 2.0].map(|count| count / units)
}

/// Wilson's interval at 95 %.
pub fn wilson(part: f64, all: f64) -> (f64, f64) {
    const Z: f64 = 1.96;
    let z2 = Z * Z / all;
    let middle = (part + z2 / 2.0) / (1.0 + z2);
    let half = Z / (1.0 + z2) * (part * (1.0 - part) / all + z2 / (4.0 * all)).sqrt();
    ((middle - half).max(0.0), (middle + half).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_sim::scorer::Verdict;

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

    #[test]
    fn one_that_is_deaf_one_that_never_stops_and_one_that_shouts_are_told_apart() {
        let shouting =
            (0..3_600).map(|n| Verdict::new(f64::from(n) * 0.01, f64::from(n) * 0.01 + 0.005)).collect();
        // The last hears the slip of 8 mm 20 ms before it slides.
        let words =
            vec![Vec::new(), vec![Verdict::new(0.0, f64::INFINITY)], shouting, vec![Verdict::new(5.08, 5.2)]];
        let all: Vec<Heard> = (0..4)
            .flat_map(|finger| {
                [Kind::Slips, Kind::Quiet, Kind::Disturbed].map(|kind| heard(finger, kind, words.clone()))
            })
            .collect();
        let of = |row: usize| Scored::of(&all, row..row + 1);
        let recall = |row: usize| of(row).recall().unwrap()[0];
        let [deaf, endless, shouts] = [0, 1, 2].map(|row| of(row).false_per_hour(Kind::Quiet).unwrap());
        // Deaf: nothing caught, no false alarm, and no latency.
        assert_eq!((recall(0), deaf[0], of(0).latency_ms(0.5)), (0.0, 0.0, None));
        // It has been heard for 144 s without an alarm: fewer than 3.7 in that time, with 97.5 %.
        assert!((deaf[2] - 3.689 / 0.04).abs() < 0.1, "{deaf:?}");
        // What stands for ever began once, outside every slip: it has caught nothing.
        assert_eq!((recall(1), endless[0]), (0.0, 100.0));
        // What shouts catches everything, and has a false alarm in every 50 ms.
        assert_eq!(recall(2), 1.0);
        assert!((55_000.0..73_000.0).contains(&shouts[0]), "{shouts:?}");
        // Half of the slips of a millimetre and more; the others do not count.
        assert_eq!((recall(3), of(3).count()), (0.5, 8));
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
        assert_eq!([0..1, 1..2, 0..2].map(|judges| scored(judges).recall().unwrap()[0]), [0.0, 0.5, 0.5]);
        let alarms = |judges| scored(judges).false_per_hour(Kind::Slips).unwrap()[0].round();
        assert_eq!((alarms(0..1), alarms(1..2), alarms(0..2)), (100.0, 200.0, 200.0));
    }

    #[test]
    fn intervals_bracket_and_shrink_with_more_fingertips() {
        let caught = || vec![Verdict::new(3.08, 3.2), Verdict::new(5.08, 5.2)];
        let recall = |fingers: u64| {
            let said = |finger: u64| if finger.is_multiple_of(3) { Vec::new() } else { caught() };
            let some: Vec<_> =
                (0..fingers).map(|finger| heard(finger, Kind::Slips, vec![said(finger)])).collect();
            Scored::of(&some, 0..1).recall().unwrap()
        };
        for [value, low, high] in [3, 12, 48].map(recall) {
            let brackets = low < value && value < high && high <= 1.0;
            assert!((value - 2.0 / 3.0).abs() < 1e-9 && brackets, "{low} {value} {high}");
        }
        let width = |fingers| recall(fingers)[2] - recall(fingers)[1];
        assert!(width(48) < 0.6 * width(12));
        // All of them caught is no proof that all will be.
        let [value, low, high] = Scored::of(&[heard(1, Kind::Slips, vec![caught()])], 0..1).recall().unwrap();
        assert!(value == 1.0 && high == 1.0 && low < 0.5, "{low}");
        assert_eq!(Scored::of(&[heard(1, Kind::Quiet, vec![caught()])], 0..1).recall(), None);
    }
}
