//! A person's recordings, each with the calibration that it is played with.

use std::collections::BTreeMap;

use tenax_logic::emg::constants::Fitted;
use tenax_logic::emg::decide::{Decide, Electrode, Wish};
use tenax_logic::emg::model::EmgModel;
use tenax_logic::emg::trust::Quality;
use tenax_logic::emg::{Emg, Verdict};

use super::recordings::{Days, Recording};
use super::score::{Count, Said};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::evaluate) enum Kind {
    SameSession,
    OtherPosture,
    FirstDayKept,
    ShortDonning,
}

#[derive(Debug)]
pub(in crate::evaluate) struct Trial<'a> {
    pub kind: Kind,
    pub(super) recording: &'a Recording,
    pub(super) sites: [usize; 2],
    pub(super) model: EmgModel,
}

impl Trial<'_> {
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

    /// Both electrodes in each slow frame, as they are decided on. They do not depend on what is fitted.
    pub fn hear(&self) -> Vec<[Electrode; 2]> {
        let mut emg = Emg::new(Some(&self.model));
        let hear = |uv: [i32; 2]| {
            emg.take(uv.map(Some));
            emg.is_whole().then(|| emg.electrodes())
        };
        self.pairs().filter_map(hear).collect()
    }

    pub fn decide(&self, fitted: &'static Fitted, heard: &[[Electrode; 2]]) -> Vec<Said> {
        let mut decide = Decide::with(fitted, Some(&self.model));
        let mut wish = Wish::Rest;
        let said = heard.iter().flat_map(|electrodes| {
            let before = std::mem::replace(&mut wish, decide.take(electrodes));
            // It is known with the frame's last pair.
            [before, before, wish]
        });
        self.recording.by_row(said.map(|wish| Said { wish, ..Said::default() }))
    }

    pub fn counted(&self, said: &[Said]) -> Count {
        let mut count = Count::default();
        count.add(
            self.recording,
            said,
            if matches!(self.kind, Kind::SameSession | Kind::ShortDonning) { 2 } else { 0 },
        );
        count
    }
}

#[derive(Debug)]
pub(in crate::evaluate) struct Trials<'a> {
    pub all: Vec<Trial<'a>>,
    /// Calibrations that were refused, and why, by day.
    pub refused: BTreeMap<u32, String>,
    pub not_donned: BTreeMap<u32, String>,
}

impl<'a> Trials<'a> {
    /// Calibrates as a wearer would: each day in the first posture, with the electrodes that separated best on the first day.
    pub fn of(days: &'a Days) -> Self {
        let (mut all, mut refused, mut not_donned) = (Vec::new(), BTreeMap::new(), BTreeMap::new());
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
                match first.don(sites, &model) {
                    Ok(model) => all.push(Trial { kind: Kind::ShortDonning, recording: first, sites, model }),
                    Err(refusal) => {
                        not_donned.insert(day, refusal.to_string());
                    }
                }
            }
            kept = kept.or(Some(own));
        }
        Self { all, refused, not_donned }
    }
}
