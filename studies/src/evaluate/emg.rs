//! What the wearer wants, scored on recorded envelopes of people: right, wrong way, missed, false and late.
//!
//! A folder holds `personP_dayD_postureQ.csv` at 100 Hz: `t_s`, four electrodes (`ecu`, `edc`, `fcr`, `fcu`, 32767 is 2.8 V), `label`:
//! 1 rest, 3 close, 4 open, others nothing. Scored as `baseline.py` of that data set does, so that figures compare.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::path::Path;

use anyhow::{Context, bail};
use rayon::prelude::*;
use serde::Serialize;
use tenax_hal_shim::words::CalibrationRefusal;
use tenax_logic::emg::calibration::{Calibration, PROMPT_FRAMES, Progress};
use tenax_logic::emg::constants::Fitted;
use tenax_logic::emg::decide::{Decide, Wish};
use tenax_logic::emg::fitted::FITTED;
use tenax_logic::emg::level::level_of;
use tenax_logic::emg::model::EmgModel;
use tenax_logic::emg::trust::Quality;
use tenax_logic::emg::{Emg, Verdict};

/// Rows a second of a recording.
const HZ: f64 = 100.0;
/// Readings of a pair in a slow frame of 12.5 ms, s after its begin, and pairs a second.
const AT_S: [f64; 3] = [0.005, 0.008, 0.011];
const PAIRS_HZ: f64 = 240.0;
/// uV of a count.
const UV: f64 = 2.8e6 / 32_767.0;
const REST: u8 = 1;
const CLOSE: u8 = 3;
const OPEN: u8 = 4;
/// Columns of the flexors and of the extensors: a pair is one of each.
const FLEXORS: [usize; 2] = [2, 3];
const EXTENSORS: [usize; 2] = [0, 1];

/// One recording.
#[derive(Debug)]
pub(super) struct Recording {
    uv: Vec<[f64; 4]>,
    labels: Vec<u8>,
}

impl Recording {
    fn read(path: &Path) -> anyhow::Result<Self> {
        let mut reader = csv::Reader::from_path(path)?;
        let (mut uv, mut labels) = (Vec::new(), Vec::new());
        for row in reader.records() {
            let row = row?;
            let number = |n: usize| -> anyhow::Result<f64> {
                let field =
                    row.get(n).with_context(|| format!("{}: column {n} is missing", path.display()))?;
                field.trim().parse().with_context(|| format!("{}: `{field}` is no number", path.display()))
            };
            uv.push([number(1)? * UV, number(2)? * UV, number(3)? * UV, number(4)? * UV]);
            labels.push(number(5)? as u8);
        }
        Ok(Self { uv, labels })
    }

    /// Rows of each repetition of a label.
    fn repetitions(&self, label: u8) -> Vec<Range<usize>> {
        let mut all: Vec<Range<usize>> = Vec::new();
        for (row, _) in self.labels.iter().enumerate().filter(|(_, own)| **own == label) {
            match all.last_mut() {
                Some(last) if last.end == row => last.end += 1,
                _ => all.push(row..row + 1),
            }
        }
        all
    }

    /// Contractions that are long enough to count.
    fn contractions(&self, label: u8) -> Vec<Range<usize>> {
        self.repetitions(label).into_iter().filter(|rows| rows.len() > 100).collect()
    }

    /// Where the wearer surely rests: from 1 s after the label's start to 0.3 s before its end.
    fn rests(&self) -> Vec<Range<usize>> {
        let inner = |rows: Range<usize>| rows.start + 100..rows.end.saturating_sub(30);
        self.repetitions(REST).into_iter().map(inner).filter(|rows| !rows.is_empty()).collect()
    }

    /// The pair as the board reads it in these rows: time in rows, and uV.
    fn pairs(&self, rows: Range<usize>, sites: [usize; 2]) -> Vec<(f64, [i32; 2])> {
        let mut all = Vec::new();
        for slow in 0.. {
            for at in AT_S {
                let at = rows.start as f64 + (f64::from(slow) / 80.0 + at) * HZ;
                let (row, part) = (at as usize, at.fract());
                if row + 1 >= rows.end {
                    return all;
                }
                let between = |n: usize| self.uv[row][n] * (1.0 - part) + self.uv[row + 1][n] * part;
                all.push((at, sites.map(|n| between(n) as i32)));
            }
        }
        all
    }

    /// Calibrates as the hand does: each prompt is answered with what is given, over and over for its 5 s.
    fn calibrate(&self, sites: [usize; 2]) -> Result<EmgModel, CalibrationRefusal> {
        let unrest = |rows: &Range<usize>| {
            let pairs = self.pairs(rows.clone(), sites);
            let mean = |n: usize| {
                pairs.iter().map(|(_, uv)| f64::from(level_of(uv[n]))).sum::<f64>() / pairs.len() as f64
            };
            let deviation = |n: usize| {
                let mean = mean(n);
                pairs.iter().map(|(_, uv)| (f64::from(level_of(uv[n])) - mean).powi(2)).sum::<f64>()
                    / pairs.len() as f64
            };
            mean(0) + mean(1) + deviation(0).sqrt() + deviation(1).sqrt()
        };
        let rests = self.rests();
        let rests = rests.iter().filter(|rows| rows.len() >= 50).take(4);
        let quietest = rests.min_by(|a, b| unrest(a).total_cmp(&unrest(b))).cloned();
        let held = |label: u8| -> Vec<Range<usize>> {
            self.contractions(label).into_iter().take(2).map(|rows| rows.start + 50..rows.end - 20).collect()
        };
        let mut calibration = Calibration::begin(0);
        for (phase, rows) in (0..).zip([quietest.into_iter().collect(), held(CLOSE), held(OPEN)]) {
            let shown: Vec<_> = rows.into_iter().flat_map(|rows| self.pairs(rows, sites)).collect();
            let readings = (f64::from(PROMPT_FRAMES) / 2_000.0 * PAIRS_HZ) as u32;
            for (n, (_, uv)) in (0..readings).zip(shown.iter().cycle()) {
                calibration.take(phase * PROMPT_FRAMES + n * 25 / 3, uv.map(Some));
            }
        }
        match calibration.take(3 * PROMPT_FRAMES, [None; 2]) {
            Progress::Done(result) => result,
            Progress::Asks(..) => unreachable!("three prompts are over"),
        }
    }

    /// By how much the ratio of two electrodes differs between the contractions that a calibration would see.
    fn turn(&self, [flexor, extensor]: [usize; 2]) -> f64 {
        let ratio = |label: u8| {
            let rows =
                self.contractions(label).into_iter().take(2).flat_map(|rows| rows.start + 50..rows.end - 20);
            let levels: Vec<f64> = rows
                .map(|row| {
                    f64::from(level_of(self.uv[row][extensor] as i32) - level_of(self.uv[row][flexor] as i32))
                })
                .collect();
            quantile(&levels, 0.5)
        };
        (ratio(OPEN) - ratio(CLOSE)).abs()
    }

    /// What the hand says in each row.
    fn play(&self, fitted: &'static Fitted, model: &EmgModel, sites: [usize; 2]) -> Vec<Said> {
        let mut emg = Emg::of(Decide::with(fitted, Some(model)));
        let mut said = Vec::with_capacity(self.uv.len());
        let mut last = Said::default();
        for (at, uv) in self.pairs(0..self.uv.len(), sites) {
            while said.len() < at.ceil() as usize {
                said.push(last);
            }
            let Verdict { wish, proven, .. } = emg.take(uv.map(Some));
            // What a spectrum would say names a doubt, and changes none.
            let doubted = (0..2).any(|channel| emg.quality(channel) != Quality::Good);
            last = Said { wish, proven, doubted };
        }
        said.resize(self.uv.len(), last);
        said
    }
}

/// What the hand says in a row.
#[derive(Clone, Copy, Debug, Default)]
struct Said {
    wish: Wish,
    /// The wish moves the hand at its speed, not gently and a little.
    proven: bool,
    doubted: bool,
}

/// Counts of one or more recordings.
#[derive(Clone, Debug, Default)]
struct Count {
    rest_h: f64,
    false_motions: u32,
    /// Of closing and of opening: windows, those right, those the wrong way.
    windows: [[u32; 3]; 2],
    repetitions: u32,
    missed: u32,
    latencies_s: Vec<f64>,
    /// The same to the wish that is proven.
    full_s: Vec<f64>,
    rows: usize,
    doubted: usize,
}

impl Count {
    /// Scores what was said, less the repetitions that were calibrated from.
    fn add(&mut self, recording: &Recording, said: &[Said], skip: usize) {
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

    fn score(&self) -> Option<Score> {
        let part = |n: u32, of: u32| f64::from(n) / f64::from(of.max(1));
        let [close, open] = self.windows;
        (self.rows > 0).then(|| Score {
            close_right: part(close[1], close[0]),
            close_wrong_way: part(close[2], close[0]),
            open_right: part(open[1], open[0]),
            open_wrong_way: part(open[2], open[0]),
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

/// How well the wearer's wish was understood.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Score {
    /// Windows of 0.25 s of held closing that close.
    pub close_right: f64,
    /// And that open.
    pub close_wrong_way: f64,
    /// Windows of held opening that open.
    pub open_right: f64,
    /// And that close.
    pub open_wrong_way: f64,
    /// Repetitions that were never answered.
    pub missed: f64,
    /// Motions that began in an hour of rest.
    pub false_per_hour: f64,
    /// From the label's start to the wish, s: negative where the wearer was earlier.
    pub latency_s_p50: f64,
    /// The same of the slowest 5 %.
    pub latency_s_p95: f64,
    /// From the label's start until the wish moves the hand at its speed, s: until then it moves gently and by little.
    pub full_s_p50: f64,
    /// The same of the slowest 5 %.
    pub full_s_p95: f64,
    /// Part of the time in which a sensor was doubted.
    pub doubted_part: f64,
}

impl Score {
    fn values(&self) -> [f64; 11] {
        let Self { close_right, close_wrong_way, open_right, open_wrong_way, missed, .. } = *self;
        let Self { false_per_hour, latency_s_p50, latency_s_p95, .. } = *self;
        let Self { full_s_p50, full_s_p95, doubted_part, .. } = *self;
        [
            close_right,
            close_wrong_way,
            open_right,
            open_wrong_way,
            missed,
            false_per_hour,
            latency_s_p50,
            latency_s_p95,
            full_s_p50,
            full_s_p95,
            doubted_part,
        ]
    }

    /// The median of each number over people.
    fn median(scores: &[Self]) -> Option<Self> {
        let all: Vec<[f64; 11]> = scores.iter().map(Self::values).collect();
        let median = |n: usize| quantile(&all.iter().map(|values| values[n]).collect::<Vec<_>>(), 0.5);
        (!scores.is_empty()).then(|| Self {
            close_right: median(0),
            close_wrong_way: median(1),
            open_right: median(2),
            open_wrong_way: median(3),
            missed: median(4),
            false_per_hour: median(5),
            latency_s_p50: median(6),
            latency_s_p95: median(7),
            full_s_p50: median(8),
            full_s_p95: median(9),
            doubted_part: median(10),
        })
    }
}

/// One person.
#[derive(Clone, Debug, Serialize)]
pub struct Person {
    /// Its number in the file names.
    pub person: u32,
    /// Calibrated in the session that is scored; none where every calibration was refused.
    pub same_session: Option<Score>,
    /// Calibrated in another posture of the same day.
    pub other_posture: Option<Score>,
    /// Calibrated on the first day, scored on the others.
    pub first_day_kept: Option<Score>,
    /// Calibrations that were refused, and why, by day.
    pub refused: BTreeMap<u32, String>,
    /// Calibrations that were tried.
    pub sessions: usize,
}

/// The whole folder: medians over people.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// See [`Person`].
    pub same_session: Option<Score>,
    /// See [`Person`].
    pub other_posture: Option<Score>,
    /// See [`Person`].
    pub first_day_kept: Option<Score>,
    /// Part of the calibrations that were refused.
    pub refused_part: f64,
    /// Each by itself.
    pub persons: Vec<Person>,
}

impl Report {
    /// The medians of these people.
    #[must_use]
    pub fn of(persons: Vec<Person>) -> Self {
        let of = |kind: fn(&Person) -> Option<Score>| {
            Score::median(&persons.iter().filter_map(kind).collect::<Vec<_>>())
        };
        let refused: usize = persons.iter().map(|person| person.refused.len()).sum();
        let sessions: usize = persons.iter().map(|person| person.sessions).sum();
        Report {
            same_session: of(|person| person.same_session),
            other_posture: of(|person| person.other_posture),
            first_day_kept: of(|person| person.first_day_kept),
            refused_part: refused as f64 / sessions as f64,
            persons,
        }
    }
}

/// Linear between the ranks; 0 of nothing.
fn quantile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = (sorted.len().max(1) - 1) as f64 * part;
    let (low, high) = (sorted.get(at.floor() as usize), sorted.get(at.ceil() as usize));
    low.zip(high).map_or(0.0, |(low, high)| low + (high - low) * at.fract())
}

/// `personP_dayD_postureQ`: the three numbers.
fn numbers(stem: &str) -> Option<[u32; 3]> {
    let rest = stem.strip_prefix("person")?;
    let (person, rest) = rest.split_once("_day")?;
    let (day, posture) = rest.split_once("_posture")?;
    Some([person.parse().ok()?, day.parse().ok()?, posture.parse().ok()?])
}

/// Recordings of a person, by day and posture.
pub(super) type Days = BTreeMap<u32, BTreeMap<u32, Recording>>;

/// Everybody in a folder, or one person.
pub(super) fn people(folder: &Path, only: Option<u32>) -> anyhow::Result<BTreeMap<u32, Days>> {
    let mut people: BTreeMap<u32, Days> = BTreeMap::new();
    for entry in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry?.path();
        let stem = path.file_stem().and_then(|stem| stem.to_str()).and_then(numbers);
        let Some([person, day, posture]) =
            stem.filter(|[person, ..]| only.is_none_or(|only| only == *person))
        else {
            continue;
        };
        let recording = Recording::read(&path)?;
        people.entry(person).or_default().entry(day).or_default().insert(posture, recording);
    }
    if people.is_empty() {
        bail!("{}: no recording is called personP_dayD_postureQ.csv, with P as asked for", folder.display());
    }
    Ok(people)
}

/// Scores everybody in a folder, or one person.
///
/// # Errors
/// If nothing is there or a recording cannot be read.
pub fn evaluate(folder: &Path, only: Option<u32>) -> anyhow::Result<Report> {
    let people = people(folder, only)?;
    let persons: Vec<Person> =
        people.par_iter().map(|(&number, days)| person(&FITTED, number, days)).collect();
    Ok(Report::of(persons))
}

pub(super) fn person(fitted: &'static Fitted, number: u32, days: &Days) -> Person {
    let mut counts: [Count; 3] = Default::default();
    let mut refused = BTreeMap::new();
    let mut first_day = None;
    let mut sites = None;
    for (&day, postures) in days {
        let Some((_, first)) = postures.first_key_value() else { continue };
        let sites = *sites.get_or_insert_with(|| {
            let pairs = FLEXORS.into_iter().flat_map(|flexor| EXTENSORS.map(|extensor| [flexor, extensor]));
            pairs
                .max_by(|a, b| first.turn(*a).total_cmp(&first.turn(*b)))
                .unwrap_or([FLEXORS[0], EXTENSORS[0]])
        });
        let model = first.calibrate(sites);
        match &model {
            Ok(model) => {
                for (n, recording) in postures.values().enumerate() {
                    let said = recording.play(fitted, model, sites);
                    counts[n.min(1)].add(recording, &said, if n == 0 { 2 } else { 0 });
                }
            }
            Err(refusal) => {
                refused.insert(day, refusal.to_string());
            }
        }
        match &first_day {
            None => first_day = Some(model),
            Some(Ok(kept)) => counts[2].add(first, &first.play(fitted, kept, sites), 0),
            Some(Err(_)) => {}
        }
    }
    let [same_session, other_posture, first_day_kept] = counts.map(|count| count.score());
    Person { person: number, same_session, other_posture, first_day_kept, refused, sessions: days.len() }
}

/// A table for people.
#[derive(Debug)]
pub struct Text<'a>(pub &'a Report);

impl fmt::Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(report) = self;
        writeln!(
            f,
            "{:28} {:>17} {:>17} {:>7} {:>8} {:>15} {:>15} {:>8}",
            "",
            "closes right/wrong",
            "opens right/wrong",
            "missed",
            "false/h",
            "late p50, p95 s",
            "full p50, p95 s",
            "doubted"
        )?;
        let row = |f: &mut fmt::Formatter<'_>, name: &str, score: Option<Score>| {
            let Some(s) = score else { return writeln!(f, "{name:28} {:>17}", "-") };
            writeln!(
                f,
                "{name:28} {:>10.3} {:.3} {:>11.3} {:.3} {:>8.3} {:>8.1} {:>8.3} {:>6.3} {:>8.3} {:>6.3} {:>8.4}",
                s.close_right,
                s.close_wrong_way,
                s.open_right,
                s.open_wrong_way,
                s.missed,
                s.false_per_hour,
                s.latency_s_p50,
                s.latency_s_p95,
                s.full_s_p50,
                s.full_s_p95,
                s.doubted_part
            )
        };
        for person in &report.persons {
            let name = |what: &str| format!("person {}, {what}", person.person);
            row(f, &name("same session"), person.same_session)?;
            row(f, &name("other posture"), person.other_posture)?;
            row(f, &name("first day kept"), person.first_day_kept)?;
            for (day, why) in &person.refused {
                writeln!(f, "  day {day}'s calibration is refused: {why}")?;
            }
        }
        row(f, "median, same session", report.same_session)?;
        row(f, "median, other posture", report.other_posture)?;
        row(f, "median, first day kept", report.first_day_kept)?;
        writeln!(f, "{:.1} % of the calibrations are refused", 100.0 * report.refused_part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_names_say_who_and_when() {
        assert_eq!(numbers("person5_day12_posture3"), Some([5, 12, 3]));
        assert_eq!(numbers("person5_day12"), None);
    }

    /// A person of made-up envelopes: 3 s of each of three states in turn.
    fn made_up() -> Recording {
        let (mut uv, mut labels) = (Vec::new(), Vec::new());
        for turn in 0..12 {
            for (label, mv) in
                [(REST, [50.0, 50.0]), (CLOSE, [90.0, 800.0]), (REST, [50.0, 50.0]), (OPEN, [700.0, 80.0])]
            {
                for row in 0..300 {
                    let lively = |n: u32| {
                        1.0 + 0.1 * (f64::from(row + 300 * turn) * (0.13 + 0.04 * f64::from(n))).sin()
                    };
                    uv.push([mv[0] * 1e3 * lively(0), 0.0, mv[1] * 1e3 * lively(1), 0.0]);
                    labels.push(label);
                }
            }
        }
        Recording { uv, labels }
    }

    #[test]
    fn clear_contractions_are_right_and_swapped_labels_are_not() {
        let mut recording = made_up();
        let model = recording.calibrate([2, 0]).expect("it separates");
        let said = recording.play(&FITTED, &model, [2, 0]);
        let score = |recording: &Recording| {
            let mut count = Count::default();
            count.add(recording, &said, 2);
            count.score().expect("it has rows")
        };
        let right = score(&recording);
        assert!(right.close_right > 0.95 && right.open_right > 0.95 && right.missed == 0.0, "{right:?}");
        assert!(right.false_per_hour == 0.0 && right.latency_s_p50 < 0.2, "{right:?}");
        for label in &mut recording.labels {
            *label = match *label {
                CLOSE => OPEN,
                OPEN => CLOSE,
                other => other,
            };
        }
        let swapped = score(&recording);
        assert!(swapped.close_wrong_way > 0.95 && swapped.open_right == 0.0, "{swapped:?}");
    }
}
