//! Whether the hand asks for a new calibration where one would help: each recording of a person is played with the calibration of
//! each of their days.
//!
//! The recordings have all repetitions of a movement in a row. They are played in turn, closing and opening, each with the rest around it.

use std::collections::BTreeMap;
use std::ops::Range;

use rayon::prelude::*;
use serde::Serialize;
use tenax_hal_shim::words::Fit;
use tenax_logic::emg::Emg;
use tenax_logic::emg::constants::Fitted;
use tenax_logic::emg::decide::Decide;
use tenax_logic::emg::fit::{CONTRACTIONS, Watch};
use tenax_logic::emg::model::EmgModel;

use super::recordings::{CLOSE, Days, OPEN, PAIRS_HZ, Recording};
use super::score::quantile;
use super::trial::{Kind, Trial};

/// By how much more of the windows a new calibration is right where it is asked for.
const HELPS: f64 = 0.2;
/// Rows before and after a repetition that are played with it.
const AROUND: [usize; 2] = [100, 60];
/// Contractions that are played: three judgements.
const PLAYED: usize = 3 * CONTRACTIONS as usize + 2;

/// Sessions of a kind, and in how many of them the wearer is asked.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Row {
    pub sessions: usize,
    /// After the first judgement, and ever in three.
    pub moved_at_first: usize,
    pub moved: usize,
    pub exchanged_at_first: usize,
    pub exchanged: usize,
    /// Until it is first asked, s of contractions of 3 s and rests of 1.6 s: the median.
    pub s_p50: f64,
}

impl Row {
    fn of<'a>(all: impl Iterator<Item = &'a [(f64, Fit)]>) -> Self {
        let (mut row, mut seconds) = (Self::default(), Vec::new());
        for judged in all {
            let has = |judged: &[(f64, Fit)], fit: Fit| usize::from(judged.iter().any(|own| own.1 == fit));
            let first = &judged[..judged.len().min(1)];
            row.sessions += 1;
            row.moved_at_first += has(first, Fit::Moved);
            row.moved += has(judged, Fit::Moved);
            row.exchanged_at_first += has(first, Fit::Exchanged);
            row.exchanged += has(judged, Fit::Exchanged);
            seconds.extend(judged.iter().find(|own| own.1 != Fit::Fits).map(|own| own.0));
        }
        row.s_p50 = quantile(&seconds, 0.5);
        row
    }
}

/// A person's sessions.
#[derive(Clone, Debug, Serialize)]
pub struct Asked {
    /// A new calibration makes at least a fifth more of the windows right, and less.
    pub helps: Row,
    pub does_not: Row,
    /// With exchanged plugs, on the calibration of the same day.
    pub exchanged: Row,
}

/// A recording on a calibration.
struct Session<'a> {
    recording: &'a Recording,
    sites: [usize; 2],
    model: EmgModel,
    fitted: &'static Fitted,
}

impl Session<'_> {
    /// Judgements, and when, of these rows, with exchanged plugs or not.
    fn judge(&self, pieces: &[Range<usize>], exchanged: bool) -> Vec<(f64, Fit)> {
        let mut emg = Emg::of(Decide::with(self.fitted, Some(&self.model)));
        let (mut watch, mut judged, mut pairs) = (Watch::default(), Vec::new(), 0u32);
        for piece in pieces {
            for (_, [flexor, extensor]) in self.recording.pairs(piece.clone(), self.sites) {
                let uv = if exchanged { [extensor, flexor] } else { [flexor, extensor] };
                let verdict = emg.take(uv.map(Some));
                pairs += 1;
                if pairs.is_multiple_of(3) && watch.take(&self.model, emg.levels(), verdict) {
                    judged.push((f64::from(pairs) / PAIRS_HZ, watch.fit()));
                }
            }
        }
        judged
    }

    /// Repetitions of closing and opening in turn.
    fn in_turn(&self) -> Vec<Range<usize>> {
        let around = |rows: &Range<usize>| {
            rows.start.saturating_sub(AROUND[0])..(rows.end + AROUND[1]).min(self.recording.rows())
        };
        let mut all = [CLOSE, OPEN].map(|label| self.recording.contractions(label)).to_vec();
        all.retain(|own| !own.is_empty());
        let turn = |n: usize| {
            let own = all.get(n % all.len().max(1))?;
            Some(around(&own[n / all.len() % own.len()]))
        };
        (0..PLAYED).filter_map(turn).collect()
    }

    /// Part of the windows that are right.
    fn right(&self, model: EmgModel) -> f64 {
        let Self { recording, sites, fitted, .. } = *self;
        let trial = Trial { kind: Kind::SameSession, recording, sites, model };
        trial
            .counted(&trial.play(fitted))
            .score()
            .map_or(0.0, |score| f64::midpoint(score.close_right, score.open_right))
    }
}

/// All recordings of a person on each calibration of theirs.
pub(super) fn asked(fitted: &'static Fitted, days: &Days) -> Option<Asked> {
    let sites = days.values().next()?.values().next()?.best_sites();
    let recordings: Vec<(u32, u32, &Recording)> = days
        .iter()
        .flat_map(|(&day, postures)| postures.iter().map(move |(&posture, own)| (day, posture, own)))
        .collect();
    let own: BTreeMap<(u32, u32), EmgModel> = recordings
        .iter()
        .filter_map(|(day, posture, own)| Some(((*day, *posture), own.calibrate(sites).ok()?)))
        .collect();
    // A hand is calibrated in the first posture of a day.
    let first = |day: u32| days.get(&day).and_then(|postures| postures.keys().next().copied());
    let kept = own.iter().filter(|((day, posture), _)| first(*day) == Some(*posture));
    let sessions: Vec<_> =
        kept.flat_map(|(from, model)| recordings.iter().map(move |to| (from, model, to))).collect();
    let played: Vec<_> = sessions
        .par_iter()
        .map(|&(&(from, _), &model, &(day, posture, recording))| {
            let session = Session { recording, sites, model, fitted };
            let gain = own.get(&(day, posture)).map(|new| session.right(*new) - session.right(model));
            let turns = session.in_turn();
            let is_own = from == day && first(day) == Some(posture);
            (gain, session.judge(&turns, false), is_own.then(|| session.judge(&turns, true)))
        })
        .collect();
    let by_gain = |helps: bool| {
        let kind = played.iter().filter(|own| own.0.is_some_and(|gain| (gain >= HELPS) == helps));
        Row::of(kind.map(|own| &own.1[..]))
    };
    let exchanged = Row::of(played.iter().filter_map(|own| own.2.as_deref()));
    Some(Asked { helps: by_gain(true), does_not: by_gain(false), exchanged })
}
