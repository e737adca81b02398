//! Recorded envelopes of people, as the board reads them: `personP_dayD_postureQ.csv` at 100 Hz: `t_s`, four electrodes (`ecu`, `edc`,
//! `fcr`, `fcu`, 32767 is 2.8 V), `label`: 1 rest, 3 close, 4 open, others nothing.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use anyhow::Context;
use tenax_frames::quantile::between_ranks;
use tenax_hal_shim::words::CalibrationRefusal;
use tenax_logic::emg::calibration::{Calibration, PROMPT_FRAMES, Progress};
use tenax_logic::emg::level::level_of;
use tenax_logic::emg::model::EmgModel;

/// Rows a second of a recording.
pub(super) const HZ: f64 = 100.0;
/// Readings of a pair in a slow frame of 12.5 ms, s after its begin, and pairs a second.
const AT_S: [f64; 3] = [0.005, 0.008, 0.011];
pub(super) const PAIRS_HZ: f64 = 240.0;
/// A short calibration: rest before, and between two contractions, and a contraction from its label's start, s.
const DON_REST_S: [f64; 2] = [2.0, 0.4];
const DON_S: f64 = 1.5;
/// uV of a count.
const UV: f64 = 2.8e6 / 32_767.0;
pub(super) const REST: u8 = 1;
pub(super) const CLOSE: u8 = 3;
pub(super) const OPEN: u8 = 4;
/// The electrodes' columns, and which of them are flexors and extensors: a pair is one of each.
const ELECTRODES: [&str; 4] = ["ecu", "edc", "fcr", "fcu"];
const FLEXORS: [usize; 2] = [2, 3];
const EXTENSORS: [usize; 2] = [0, 1];

/// Recordings of a person, by day and posture.
pub(in crate::evaluate) type Days = BTreeMap<u32, BTreeMap<u32, Recording>>;

/// `personP_dayD_postureQ`: the three numbers.
pub(super) fn numbers(stem: &str) -> Option<[u32; 3]> {
    let rest = stem.strip_prefix("person")?;
    let (person, rest) = rest.split_once("_day")?;
    let (day, posture) = rest.split_once("_posture")?;
    Some([person.parse().ok()?, day.parse().ok()?, posture.parse().ok()?])
}

#[derive(Debug)]
pub(in crate::evaluate) struct Recording {
    uv: Vec<[f64; 4]>,
    labels: Vec<u8>,
}

impl Recording {
    pub(super) fn read(path: &Path) -> anyhow::Result<Self> {
        let parsed = std::fs::File::open(path).map_err(anyhow::Error::from).and_then(Self::parse);
        parsed.with_context(|| path.display().to_string())
    }

    fn parse(source: impl std::io::Read) -> anyhow::Result<Self> {
        let mut reader = csv::Reader::from_reader(source);
        let header = reader.headers()?.clone();
        let place = |name: &str| {
            let found = header.iter().position(|column| column.trim() == name);
            found.with_context(|| format!("line 1: no column `{name}`"))
        };
        let [ecu, edc, fcr, fcu] = ELECTRODES.map(place);
        let places = [ecu?, edc?, fcr?, fcu?];
        let label = place("label")?;
        let (mut uv, mut labels) = (Vec::new(), Vec::new());
        for row in reader.records() {
            let row = row?;
            let line = row.position().map_or(0, csv::Position::line);
            let number = |n: usize| -> anyhow::Result<f64> {
                let field = row.get(n).unwrap_or_default().trim();
                let number = field.parse().ok().filter(|number: &f64| number.is_finite());
                number.with_context(|| format!("line {line}: `{field}` is no number"))
            };
            let [ecu, edc, fcr, fcu] = places.map(|place| number(place).map(|count| count * UV));
            uv.push([ecu?, edc?, fcr?, fcu?]);
            labels.push(number(label)? as u8);
        }
        Ok(Self { uv, labels })
    }

    pub(super) const fn rows(&self) -> usize {
        self.uv.len()
    }

    pub(super) fn best_sites(&self) -> [usize; 2] {
        let pairs = FLEXORS.into_iter().flat_map(|flexor| EXTENSORS.map(|extensor| [flexor, extensor]));
        pairs.max_by(|a, b| self.turn(*a).total_cmp(&self.turn(*b))).unwrap_or([FLEXORS[0], EXTENSORS[0]])
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
    pub(super) fn contractions(&self, label: u8) -> Vec<Range<usize>> {
        self.repetitions(label).into_iter().filter(|rows| rows.len() > 100).collect()
    }

    /// Rows of certain rest: from 1 s after the label's start to 0.3 s before its end.
    pub(super) fn rests(&self) -> Vec<Range<usize>> {
        let inner = |rows: Range<usize>| rows.start + 100..rows.end.saturating_sub(30);
        self.repetitions(REST).into_iter().map(inner).filter(|rows| !rows.is_empty()).collect()
    }

    /// Two electrodes in each row, uV.
    pub(super) fn site_uv(&self, sites: [usize; 2]) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.uv.iter().map(move |uv| sites.map(|n| uv[n]))
    }

    /// The pair as the board reads it in these rows: time in rows, and uV.
    pub(super) fn pairs(&self, rows: Range<usize>, sites: [usize; 2]) -> Vec<(f64, [i32; 2])> {
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

    pub(super) fn by_row<S: Copy + Default>(&self, mut said: impl Iterator<Item = S>) -> Vec<S> {
        let mut rows = Vec::with_capacity(self.uv.len());
        let mut last = S::default();
        for slow in 0.. {
            for at in AT_S {
                let at = (f64::from(slow) / 80.0 + at) * HZ;
                rows.resize(rows.len().max(at.ceil() as usize), last);
                let Some(next) = said.next() else {
                    rows.resize(self.uv.len(), last);
                    return rows;
                };
                last = next;
            }
        }
        rows
    }

    /// Calibrates as the hand does: each prompt is answered with what is given, over and over for its 5 s.
    pub(super) fn calibrate(&self, sites: [usize; 2]) -> Result<EmgModel, CalibrationRefusal> {
        let held = |label: u8| -> Vec<Range<usize>> { self.shown(label).collect() };
        let phases = [self.quietest(sites).into_iter().collect(), held(CLOSE), held(OPEN)];
        let phases =
            phases.map(|rows| rows.into_iter().flat_map(|rows| self.pairs(rows, sites)).collect::<Vec<_>>());
        let mut calibration = Calibration::begin(0);
        for begin in (0..).step_by(PROMPT_FRAMES as usize) {
            let prompt = match calibration.take(begin, [None; 2]) {
                Progress::Done(result) => return result,
                Progress::Asks(prompt, _) => prompt,
            };
            let readings = (f64::from(PROMPT_FRAMES) / 2_000.0 * PAIRS_HZ) as u32;
            for (n, (_, uv)) in (0..readings).zip(phases[prompt as usize].iter().cycle()) {
                calibration.take(begin + n * 25 / 3, uv.map(Some));
            }
        }
        unreachable!("it ends by itself")
    }

    /// Calibrates at the hand: rest, then three times the begin of a closing and of an opening, with rest between.
    pub(super) fn don(&self, sites: [usize; 2], kept: &EmgModel) -> Result<EmgModel, CalibrationRefusal> {
        let rest: Vec<_> =
            self.quietest(sites).into_iter().flat_map(|rows| self.pairs(rows, sites)).collect();
        let rests = |seconds: f64| rest.iter().cycle().copied().take((seconds * PAIRS_HZ) as usize);
        let mut readings: Vec<_> = rests(DON_REST_S[0]).collect();
        for turn in 0..3 {
            for label in [CLOSE, OPEN] {
                let contractions = self.contractions(label);
                let begin = contractions.get(turn % 2).map_or(0, |rows| rows.start);
                readings.extend(self.pairs(begin..begin + (DON_S * HZ) as usize, sites));
                readings.extend(rests(DON_REST_S[1]));
            }
        }
        let mut calibration = Calibration::short(0, kept);
        let frames = (0..).map(|n| n * 25 / 3);
        for (frame, (_, uv)) in frames.zip(readings) {
            calibration.take(frame, uv.map(Some));
        }
        match calibration.take(3 * PROMPT_FRAMES, [None; 2]) {
            Progress::Done(result) => result,
            Progress::Asks(..) => unreachable!("its time is over"),
        }
    }

    /// Rows of the quietest of the first rests.
    fn quietest(&self, sites: [usize; 2]) -> Option<Range<usize>> {
        let unrest = |rows: &Range<usize>| -> f64 {
            let pairs = self.pairs(rows.clone(), sites);
            let of_site = |n: usize| {
                let levels = || pairs.iter().map(|(_, uv)| f64::from(level_of(uv[n])));
                let mean = levels().sum::<f64>() / pairs.len() as f64;
                let variance = levels().map(|level| (level - mean).powi(2)).sum::<f64>() / pairs.len() as f64;
                mean + variance.sqrt()
            };
            of_site(0) + of_site(1)
        };
        let rests = self.rests();
        let rests = rests.iter().filter(|rows| rows.len() >= 50).take(4);
        rests.min_by(|a, b| unrest(a).total_cmp(&unrest(b))).cloned()
    }

    /// The middles of a label's first two contractions, which a calibration sees.
    fn shown(&self, label: u8) -> impl Iterator<Item = Range<usize>> {
        self.contractions(label).into_iter().take(2).map(|rows| rows.start + 50..rows.end - 20)
    }

    /// By how much the ratio of two electrodes differs between the contractions that a calibration would see.
    fn turn(&self, [flexor, extensor]: [usize; 2]) -> f64 {
        let ratio = |label: u8| {
            let levels = self.shown(label).flatten().map(|row| {
                let [flexor, extensor] = [flexor, extensor].map(|n| level_of(self.uv[row][n] as i32));
                f64::from(extensor - flexor)
            });
            between_ranks(levels, 0.5).unwrap_or_default()
        };
        (ratio(OPEN) - ratio(CLOSE)).abs()
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    #[test]
    fn file_names_say_who_and_when() {
        assert_eq!(numbers("person5_day12_posture3"), Some([5, 12, 3]));
        assert_eq!(numbers("person5_day12"), None);
    }

    #[test]
    fn what_cannot_be_read_is_said_with_its_line() {
        let head = "t_s,ecu,edc,fcr,fcu,label\n0.00,1,2,3,4,1\n";
        for (csv, what) in [
            (format!("{head}0.01,1,2,x,4,1\n"), "line 3: `x` is no number"),
            (format!("{head}0.01,1,2,3,nan,1\n"), "line 3: `nan` is no number"),
            (format!("{head}0.01,1,2,3\n"), "line: 3"),
            ("t_s,ecu,edc,fcr,label\n".to_owned(), "line 1: no column `fcu`"),
        ] {
            let error = Recording::parse(csv.as_bytes()).expect_err("it is wrong");
            assert!(format!("{error:#}").contains(what), "{error:#}");
        }
        let columns_in_another_order = "label,fcu,t_s,ecu,edc,fcr\n3,4,0,1,2,3\n";
        let read = Recording::parse(columns_in_another_order.as_bytes()).expect("it is right");
        assert_eq!((read.uv, read.labels), (vec![[1.0, 2.0, 3.0, 4.0].map(|count| count * UV)], vec![CLOSE]));
    }

    /// A person of made-up envelopes: 3 s of each of three states in turn.
    pub fn made_up() -> Recording {
        let (mut uv, mut labels) = (Vec::new(), Vec::new());
        for turn in 0..12 {
            for (label, mv) in
                [(REST, [50.0, 50.0]), (CLOSE, [90.0, 800.0]), (REST, [50.0, 50.0]), (OPEN, [700.0, 80.0])]
            {
                for row in 0..300 {
                    let lively = |n: u32| {
                        1.0 + 0.25 * (f64::from(row + 300 * turn) * (0.13 + 0.04 * f64::from(n))).sin()
                    };
                    uv.push([mv[0] * 1e3 * lively(0), 0.0, mv[1] * 1e3 * lively(1), 0.0]);
                    labels.push(label);
                }
            }
        }
        Recording { uv, labels }
    }

    pub fn swapped(mut recording: Recording) -> Recording {
        for label in &mut recording.labels {
            *label = match *label {
                CLOSE => OPEN,
                OPEN => CLOSE,
                other => other,
            };
        }
        recording
    }
}
