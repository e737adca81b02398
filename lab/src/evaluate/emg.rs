//! Intent recognition, scored on recorded envelopes of people: [sessions](recordings) with labels, and [short ones](two_channel).

pub mod curves;
pub mod faults;
pub mod interval;
pub(super) mod recordings;
pub(super) mod score;
pub(super) mod trial;
pub mod two_channel;

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::bail;
use rayon::prelude::*;
use serde::Serialize;
use tenax_logic::emg::constants::Fitted;
use tenax_logic::emg::fitted::FITTED;

use self::interval::{Interval, Sessions};
use self::recordings::{Days, Recording, numbers};
pub use self::score::Score;
use self::trial::{Kind, Trial, Trials};
use self::two_channel::Session;

/// A value for each calibration that a recording is played with; none where every calibration was refused.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Kinds<T> {
    /// Calibrated in the session that is scored.
    pub same_session: Option<T>,
    /// Calibrated in another posture of the same day.
    pub other_posture: Option<T>,
    /// Calibrated on the first day, scored on the others.
    pub first_day_kept: Option<T>,
    /// Calibrated in that session by three closings and openings at the hand.
    pub short_donning: Option<T>,
}

impl<T> Kinds<T> {
    fn of(value: impl Fn(Kind) -> Option<T>) -> Self {
        Self {
            same_session: value(Kind::SameSession),
            other_posture: value(Kind::OtherPosture),
            first_day_kept: value(Kind::FirstDayKept),
            short_donning: value(Kind::ShortDonning),
        }
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct Person {
    pub person: u32,
    #[serde(flatten)]
    pub scores: Kinds<Score>,
    /// Refused calibrations and their reasons, by day.
    pub refused: BTreeMap<u32, String>,
    /// Short ones, of all days but the first.
    pub not_donned: BTreeMap<u32, String>,
    /// Calibrations that were tried.
    pub sessions: usize,
}

#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Medians over people.
    #[serde(flatten)]
    pub scores: Kinds<Score>,
    /// Part of the calibrations that were refused.
    pub refused_part: f64,
    /// 95 % intervals of the medians: people and their sessions drawn again.
    pub intervals: Kinds<Interval>,
    pub persons: Vec<Person>,
    pub faults: Option<faults::Report>,
    pub two_channel: Vec<two_channel::Report>,
}

impl Report {
    pub(super) fn of(played: Vec<(Person, Sessions)>) -> Self {
        let (persons, sessions): (Vec<_>, Vec<_>) = played.into_iter().unzip();
        let of = |kind: Kind| {
            let scores: Vec<Score> = sessions.iter().filter_map(|own: &Sessions| own.score(kind)).collect();
            Score::quantile(&scores, 0.5)
        };
        let refused: usize = persons.iter().map(|person: &Person| person.refused.len()).sum();
        let calibrated: usize = persons.iter().map(|person| person.sessions).sum();
        Report {
            scores: Kinds::of(of),
            refused_part: refused as f64 / calibrated.max(1) as f64,
            intervals: Kinds::of(|kind| Interval::of(&sessions, kind)),
            persons,
            faults: None,
            two_channel: Vec::new(),
        }
    }
}

/// Recordings of a folder and its own folders.
#[derive(Debug, Default)]
pub(super) struct Recordings {
    pub people: BTreeMap<u32, Days>,
    pub sessions: Vec<Session>,
}

impl Recordings {
    pub fn read(folder: &Path) -> anyhow::Result<Self> {
        let mut all = Self::default();
        let mut short = Vec::new();
        // Sorted by their paths.
        for path in glob::glob(&format!("{}/**/*.csv", glob::Pattern::escape(&folder.to_string_lossy())))? {
            let path = path?;
            let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
            if let Some([person, day, posture]) = numbers(stem) {
                let days = all.people.entry(person).or_default();
                days.entry(day).or_default().insert(posture, Recording::read(&path)?);
            } else if stem.starts_with(two_channel::PREFIX) {
                short.push(path);
            }
        }
        all.sessions = two_channel::sessions(&short)?;
        if all.people.is_empty() && all.sessions.is_empty() {
            bail!(
                "{}: no recording is called personP_dayD_postureQ.csv or {}*.csv",
                folder.display(),
                two_channel::PREFIX
            );
        }
        Ok(all)
    }
}

/// The two-channel sessions of a folder and its own folders. Fails if there is no recording, or one cannot be read.
pub fn sessions(folder: &Path) -> anyhow::Result<Vec<Session>> {
    Ok(Recordings::read(folder)?.sessions)
}

/// Scores these people of a folder, everybody if none is named, and so many faults drawn over them. Fails if there is no recording, or one
/// cannot be read.
pub fn evaluate(folder: &Path, people: &[u32], faults: u32, seed: u64) -> anyhow::Result<Report> {
    let mut all = Recordings::read(folder)?;
    all.people.retain(|person, _| people.is_empty() || people.contains(person));
    let trials: Vec<Trial> = all.people.values().flat_map(|days| Trials::of(days).all).collect();
    let faults =
        (faults > 0).then(|| faults::draw(&FITTED, &trials.iter().collect::<Vec<_>>(), faults, seed));
    let score = |(&number, days)| person(&FITTED, number, days);
    let persons = all.people.par_iter().map(score).collect();
    let two_channel = all.sessions.par_iter().map(|session| session.score(&FITTED)).collect();
    Ok(Report { two_channel, faults, ..Report::of(persons) })
}

pub(super) fn person(fitted: &'static Fitted, number: u32, days: &Days) -> (Person, Sessions) {
    let Trials { all, refused, not_donned } = Trials::of(days);
    let counted = all.iter().map(|trial| (trial.kind, trial.counted(&trial.play(fitted))));
    let sessions = Sessions(counted.collect());
    let scores = Kinds::of(|kind| sessions.score(kind));
    (Person { person: number, scores, refused, not_donned, sessions: days.len() }, sessions)
}

#[cfg(test)]
mod tests {
    use super::recordings::tests::{made_up, swapped};
    use super::score::Count;
    use super::*;

    #[test]
    fn clear_contractions_are_right_and_swapped_labels_are_not() {
        let days = Days::from([(1, BTreeMap::from([(1, made_up())]))]);
        let trials = Trials::of(&days);
        let [trial] = &trials.all[..] else { panic!("it separates: {:?}", trials.refused) };
        let said = trial.play(&FITTED);
        let wishes = |said: &[score::Said]| said.iter().map(|own| own.wish).collect::<Vec<_>>();
        let fitted = trial.decide(&FITTED, &trial.hear());
        assert_eq!(wishes(&fitted), wishes(&said), "what is fitted is what is played");
        let count = |recording: Recording| {
            let mut count = Count::default();
            count.add(&recording, &said, 2);
            count
        };
        let (good, bad) = (count(made_up()), count(swapped(made_up())));
        let right = good.score().expect("it has rows");
        assert!(right.close_right > 0.95 && right.open_right > 0.95 && right.missed == 0.0, "{right:?}");
        assert!(right.false_per_hour == 0.0 && right.latency_s_p50 < 0.2, "{right:?}");
        let swapped = bad.score().expect("it has rows");
        assert!(swapped.close_wrong_way > 0.95 && swapped.open_right == 0.0, "{swapped:?}");

        // People who are alike leave no doubt of the median, and one who is not does.
        let interval = |counts: [&Count; 3]| {
            let people = counts.map(|count| Sessions(vec![(Kind::SameSession, count.clone())]));
            let interval = Interval::of(&people, Kind::SameSession).expect("they have sessions");
            [interval.low.open_right, interval.high.open_right]
        };
        assert_eq!(interval([&good, &good, &good]), [right.open_right; 2]);
        assert_eq!(interval([&good, &bad, &good]), [0.0, right.open_right]);
        assert!(Interval::of(&[], Kind::SameSession).is_none());
    }
}
