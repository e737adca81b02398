//! A person's recordings, each with the calibration that it is played with.

use std::collections::BTreeMap;

use tenax_logic::emg::constants::Fitted;
use tenax_logic::emg::decide::{Decide, Electrode};
use tenax_logic::emg::model::EmgModel;
use tenax_logic::emg::trust::Quality;
use tenax_logic::emg::{Emg, Verdict};

use super::recordings::{Days, Recording};
use super::score::{Count, Said};

/// Which calibration a recording is played with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::evaluate) enum Kind {
    SameSession,
    OtherPosture,
    FirstDayKept,
}

/// A recording, and the wearer to whom the hand is calibrated meanwhile.
#[derive(Debug)]
pub(in crate::evaluate) struct Trial<'a> {
    pub kind: Kind,
    pub(super) recording: &'a Recording,
    pub(super) sites: [usize; 2],
    pub(super) model: EmgModel,
}

impl Trial<'_> {
    /// What the hand says in each row.
    pub fn play(&self, fitted: &'static Fitted) -> Vec<Said> {
        let mut emg = Emg::of(Decide::with(fitted, Some(&self.model)));
        let said = self.pairs().map(|uv| {
            let Verdict { wish, proven, .. } = emg.take(uv.map(Some));
            // What a spectrum would say names a doubt, and changes none.
            let doubted = (0..2).any(|channel| emg.quality(channel) != Quality::Good);
            Said { wish, proven, doubted }
        });
        self.recording.by_row(said)
    }

    fn pairs(&self) -> impl Iterator<Item = [i32; 2]> {
        self.recording.pairs(0..self.recording.rows(), self.sites).into_iter().map(|(_, uv)| uv)
    }

    /// Both electrodes as they are decided on. They do not depend on what is fitted.
    pub fn hear(&self) -> Vec<[Electrode; 2]> {
        let mut emg = Emg::new(Some(&self.model));
        let hear = |uv: [i32; 2]| {
            emg.take(uv.map(Some));
            emg.electrodes()
        };
        self.pairs().map(hear).collect()
    }

    /// As [`play`](Self::play), of what was [heard](Self::hear), and without proofs and doubts: to fit.
    pub fn decide(&self, fitted: &'static Fitted, heard: &[[Electrode; 2]]) -> Vec<Said> {
        let mut decide = Decide::with(fitted, Some(&self.model));
        self.recording
            .by_row(heard.iter().map(|electrodes| Said { wish: decide.take(electrodes), ..Said::default() }))
    }

    /// Adds what was said.
    pub fn count(&self, said: &[Said], count: &mut Count) {
        // Less the repetitions that were calibrated from.
        count.add(self.recording, said, if self.kind == Kind::SameSession { 2 } else { 0 });
    }
}

/// All of a person.
#[derive(Debug)]
pub(in crate::evaluate) struct Trials<'a> {
    pub all: Vec<Trial<'a>>,
    /// Calibrations that were refused, and why, by day.
    pub refused: BTreeMap<u32, String>,
}

impl<'a> Trials<'a> {
    /// Calibrates as a wearer would: each day in the first posture, with the electrodes that separated best on the first day.
    pub fn of(days: &'a Days) -> Self {
        let (mut all, mut refused) = (Vec::new(), BTreeMap::new());
        let (mut sites, mut kept) = (None, None);
        for (&day, postures) in days {
            let Some((_, first)) = postures.first_key_value() else { continue };
            let sites = *sites.get_or_insert_with(|| first.best_sites());
            let own = first.calibrate(sites);
            match &own {
                Ok(model) => {
                    all.extend(postures.values().enumerate().map(|(n, recording)| {
                        let kind = if n == 0 { Kind::SameSession } else { Kind::OtherPosture };
                        Trial { kind, recording, sites, model: *model }
                    }));
                }
                Err(refusal) => {
                    refused.insert(day, refusal.to_string());
                }
            }
            if let Some(Ok(model)) = kept {
                all.push(Trial { kind: Kind::FirstDayKept, recording: first, sites, model });
            }
            kept = kept.or(Some(own));
        }
        Self { all, refused }
    }
}

pub fn diagnose(days: &Days, number: u32) {
    for trial in Trials::of(days).all {
        if trial.kind == Kind::FirstDayKept {
            continue;
        }
        let said = trial.play(&tenax_logic::emg::fitted::FITTED);
        let heard = trial.hear();
        let rest = trial.model.rest();
        let site = [trial.model.closing_site(), trial.model.opening_site()];
        let level = |row: usize, n: usize| {
            let k = (row as f64 * 2.4) as usize;
            tenax_logic::emg::level::level_of(heard[k.min(heard.len() - 1)][n].uv.unwrap_or(0))
        };
        let (c, o) = (trial.model.close(), trial.model.open());
        println!(
            "person {number} {:?} rest {:?} close {:?} open {:?} spread {:?} sep {}",
            trial.kind,
            rest,
            [c[site[0]] - rest[site[0]], c[site[1]] - rest[site[1]]],
            [o[site[0]] - rest[site[0]], o[site[1]] - rest[site[1]]],
            trial.model.spread(),
            trial.model.separation_permille()
        );
        let cr = c[site[1]] - c[site[0]];
        let or = o[site[1]] - o[site[0]];
        let show = |row: usize| {
            let l = [level(row, site[0]), level(row, site[1])];
            let sc = (l[0] - rest[site[0]]) * 100 / (c[site[0]] - rest[site[0]]);
            let so = (l[1] - rest[site[1]]) * 100 / (o[site[1]] - rest[site[1]]);
            let p = (l[1] - l[0] - cr) * 100 / (or - cr);
            format!(
                "{}{:?}/{:?}/{:?}",
                match said[row].wish {
                    tenax_logic::emg::decide::Wish::Rest => 'r',
                    tenax_logic::emg::decide::Wish::Close => 'c',
                    _ => 'o',
                },
                sc,
                so,
                p
            )
        };
        for (label, right) in
            [(3u8, tenax_logic::emg::decide::Wish::Close), (4, tenax_logic::emg::decide::Wish::Open)]
        {
            for rows in trial.recording.contractions(label) {
                let good = said[rows.start + 40..rows.end - 10].iter().filter(|s| s.wish == right).count();
                let of = rows.len() - 50;
                if good * 10 < of * 9 {
                    let line: Vec<String> = (rows.start.saturating_sub(60)..rows.end + 40)
                        .step_by(20)
                        .map(|r| {
                            format!(
                                "{}{}",
                                if r < rows.start {
                                    "-"
                                } else if r > rows.end {
                                    "+"
                                } else {
                                    ""
                                },
                                show(r.min(said.len() - 1))
                            )
                        })
                        .collect();
                    println!(
                        "  label {label} at {} {}: {good}/{of} {}",
                        rows.start,
                        rows.len(),
                        line.join(" ")
                    );
                }
            }
        }
        for rows in trial.recording.rests() {
            let mut before = tenax_logic::emg::decide::Wish::Rest;
            for row in rows.clone() {
                let wish = said[row].wish;
                if wish != before && wish != tenax_logic::emg::decide::Wish::Rest {
                    println!(
                        "  FALSE {wish:?} at {row} ({} after its begin, of {}): {}",
                        row - rows.start,
                        rows.len(),
                        (row.saturating_sub(100)..(row + 60).min(said.len()))
                            .step_by(20)
                            .map(show)
                            .collect::<Vec<_>>()
                            .join(" ")
                    );
                }
                before = wish;
            }
        }
    }
}
