//! Scores of a recording, counted as in `baseline.py` of that data set, so that figures compare.

use std::ops::Range;

use serde::Serialize;
use tenax_frames::quantile::between_ranks;
use tenax_logic::emg::decide::Wish;

use super::recordings::{CLOSE, HZ, OPEN, Recording};

/// Rows within which a repetition begins and ends, 0.5 s.
const BEGUN_ROWS: usize = 50;
const ENDED_ROWS: usize = 50;

#[derive(Clone, Copy, Debug, Default)]
pub(in crate::evaluate) struct Said {
    pub wish: Wish,
    /// The wish moves the hand at its speed, not gently and a little.
    pub proven: bool,
    pub doubted: bool,
}

#[derive(Clone, Debug, Default)]
pub(in crate::evaluate) struct Count {
    rest_h: f64,
    false_motions: u32,
    windows: [[u32; 3]; 2],
    repetitions: u32,
    right: u32,
    missed: u32,
    latencies_s: Vec<f64>,
    full_s: Vec<f64>,
    rows: usize,
    doubted: usize,
}

impl Count {
    /// Scores what was said, less the repetitions that were calibrated from.
    pub fn add(&mut self, recording: &Recording, said: &[Said], skip: usize) {
        self.rows += said.len();
        self.doubted += said.iter().filter(|own| own.doubted).count();
        for rows in recording.rests() {
            self.rest_h += rows.len() as f64 / HZ / 3_600.0;
            let mut before = Wish::Rest;
            for &Said { wish, .. } in &said[rows] {
                self.false_motions += u32::from(wish != before && wish != Wish::Rest);
                before = wish;
            }
        }
        let kinds = [(CLOSE, Wish::Close, Wish::Open), (OPEN, Wish::Open, Wish::Close)];
        for (windows, (label, right, wrong)) in self.windows.iter_mut().zip(kinds) {
            for rows in recording.contractions(label).into_iter().skip(skip) {
                let mut from = rows.start + 40;
                while from + 25 <= rows.end - 10 {
                    let most =
                        |wish: Wish| said[from..from + 25].iter().filter(|own| own.wish == wish).count() > 12;
                    windows[0] += 1;
                    windows[1] += u32::from(most(right));
                    windows[2] += u32::from(most(wrong));
                    from += 25;
                }
                self.repetitions += 1;
                self.right += u32::from(is_right(&rows, said, right));
                let begun = rows.start.saturating_sub(20);
                let since = |n: usize| n as f64 / HZ - 0.2;
                let said = &said[begun..rows.end];
                match said.iter().position(|own| own.wish == right) {
                    Some(n) => self.latencies_s.push(since(n)),
                    None => self.missed += 1,
                }
                let full = said.iter().position(|own| own.wish == right && own.proven);
                // Until the contraction is over, at least, if it never was.
                self.full_s.push(since(full.unwrap_or(said.len())));
            }
        }
    }

    pub fn sum<'a>(all: impl IntoIterator<Item = &'a Self>) -> Self {
        let mut sum = Self::default();
        for own in all {
            sum.rest_h += own.rest_h;
            sum.false_motions += own.false_motions;
            for (windows, own) in sum.windows.as_flattened_mut().iter_mut().zip(own.windows.as_flattened()) {
                *windows += own;
            }
            sum.repetitions += own.repetitions;
            sum.right += own.right;
            sum.missed += own.missed;
            sum.latencies_s.extend(&own.latencies_s);
            sum.full_s.extend(&own.full_s);
            sum.rows += own.rows;
            sum.doubted += own.doubted;
        }
        sum
    }

    pub fn score(&self) -> Option<Score> {
        let part = |n: u32, of: u32| f64::from(n) / f64::from(of.max(1));
        let [close, open] = self.windows;
        (self.rows > 0).then(|| Score {
            close_right: part(close[1], close[0]),
            close_wrong_way: part(close[2], close[0]),
            open_right: part(open[1], open[0]),
            open_wrong_way: part(open[2], open[0]),
            repetitions_right: part(self.right, self.repetitions),
            missed: part(self.missed, self.repetitions),
            false_per_hour: f64::from(self.false_motions) / self.rest_h.max(1e-9),
            latency_s_p50: quantile(&self.latencies_s, 0.5),
            latency_s_p95: quantile(&self.latencies_s, 0.95),
            full_s_p50: quantile(&self.full_s, 0.5),
            full_s_p95: quantile(&self.full_s, 0.95),
            doubted_part: self.doubted as f64 / self.rows as f64,
        })
    }
}

/// Whether a repetition was begun, held, and ended as asked.
fn is_right(rows: &Range<usize>, said: &[Said], asked: Wish) -> bool {
    let within = |rows: Range<usize>| {
        said.get(rows.start.min(said.len())..rows.end.min(said.len())).unwrap_or_default()
    };
    let counts = |said: &[Said], wish: Wish| said.iter().filter(|own| own.wish == wish).count();
    let begins = within(rows.start.saturating_sub(20)..rows.start + BEGUN_ROWS);
    let held = within(rows.start + BEGUN_ROWS..rows.end.saturating_sub(10));
    let ends = within(rows.end..rows.end + ENDED_ROWS);
    let other = if asked == Wish::Close { Wish::Open } else { Wish::Close };
    counts(begins, asked) > 0
        && 10 * counts(held, asked) >= 9 * held.len()
        && counts(held, other) == 0
        && (ends.is_empty() || ends.iter().any(|own| own.wish != asked))
}

/// Rates and latencies of intent recognition.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Score {
    /// Windows of 0.25 s of held closing that close.
    pub close_right: f64,
    pub close_wrong_way: f64,
    /// Windows of held opening that open.
    pub open_right: f64,
    pub open_wrong_way: f64,
    /// Repetitions that were answered within 0.5 s of the label's start, were held without a motion the other way, and ended within 0.5 s.
    pub repetitions_right: f64,
    /// Repetitions that were never answered.
    pub missed: f64,
    /// Motions that began in an hour of rest.
    pub false_per_hour: f64,
    /// From the label's start to the wish, s: negative where the wearer was earlier.
    pub latency_s_p50: f64,
    pub latency_s_p95: f64,
    /// From the label's start until the wish moves the hand at its speed, s: until then it moves gently and by little.
    pub full_s_p50: f64,
    pub full_s_p95: f64,
    /// Part of the time in which a sensor was doubted.
    pub doubted_part: f64,
}

impl Score {
    pub(super) fn quantile(scores: &[Self], part: f64) -> Option<Self> {
        if scores.is_empty() {
            return None;
        }
        let of = |value: fn(&Self) -> f64| quantile(&scores.iter().map(value).collect::<Vec<_>>(), part);
        Some(Self {
            close_right: of(|score| score.close_right),
            close_wrong_way: of(|score| score.close_wrong_way),
            open_right: of(|score| score.open_right),
            open_wrong_way: of(|score| score.open_wrong_way),
            repetitions_right: of(|score| score.repetitions_right),
            missed: of(|score| score.missed),
            false_per_hour: of(|score| score.false_per_hour),
            latency_s_p50: of(|score| score.latency_s_p50),
            latency_s_p95: of(|score| score.latency_s_p95),
            full_s_p50: of(|score| score.full_s_p50),
            full_s_p95: of(|score| score.full_s_p95),
            doubted_part: of(|score| score.doubted_part),
        })
    }
}

pub(super) fn quantile(values: &[f64], part: f64) -> f64 {
    between_ranks(values.iter().copied(), part).unwrap_or_default()
}
