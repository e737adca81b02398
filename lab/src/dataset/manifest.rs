//! The manifest of a data set: enough to make it again, and to know that it is the same.

use std::collections::BTreeMap;

use serde::Serialize;
use sha2::{Digest, Sha256};
use tenax_sim::array::material::{HELD_OUT, Material, SEEN};
use tenax_sim::labelled::Part;

use super::Plan;
use super::collect::Recording;
use super::session::Session;

/// Written as TOML beside the data.
#[derive(Clone, Debug, Serialize)]
pub struct Manifest {
    pub tool: String,
    pub seed: u64,
    /// Sessions to learn from, of each seen material.
    pub sessions: usize,
    /// The data's file, beside this one.
    pub file: String,
    pub sha256: String,
    pub columns: &'static str,
    pub rate_hz: u32,
    /// The material of the test alone.
    pub held_out: &'static str,
    pub split: BTreeMap<Part, Counts>,
    pub material: Vec<Material>,
    pub session: Vec<SessionEntry>,
}

const COLUMNS: &str = "split, session, material, recording; task: what is done in it; t_s: when the tenth element was read, s; \
                       label: 1 slipped since the step before; slips: exact onsets of the slips whose micro onset is since the \
                       step before, as micro/macro/end/mm in s and mm, no macro onset where it came to nothing, ! where it was \
                       meant; a1 to a10: the elements' samples, 14 bits, 3300 mV full scale";

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Counts {
    pub sessions: usize,
    pub recordings: usize,
    pub steps: usize,
    pub slip_steps: usize,
    /// Slips that the worlds counted.
    pub slips: usize,
    /// Recordings in which the box fell.
    pub dropped: usize,
}

impl Counts {
    fn add(&mut self, recordings: &[Recording]) {
        self.sessions += 1;
        for recording in recordings {
            self.recordings += 1;
            self.steps += recording.steps.len();
            self.slip_steps += recording.steps.iter().filter(|step| step.slips).count();
            self.slips += recording.slips();
            self.dropped += usize::from(recording.dropped);
        }
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct SessionEntry {
    pub steps: usize,
    pub slip_steps: usize,
    /// Slips that the worlds counted.
    pub slips: usize,
    /// Way of the box over the pads, mm.
    pub slid_mm: f64,
    pub setup: Session,
}

pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

impl Manifest {
    /// The manifest of data that is `bytes` in `file`.
    pub fn new(plan: &Plan, file: &str, bytes: &[u8], all: &[(Session, Vec<Recording>)]) -> Self {
        let mut split: BTreeMap<Part, Counts> = BTreeMap::new();
        all.iter().for_each(|(session, own)| split.entry(session.split).or_default().add(own));
        let entry = |(session, recordings): &(Session, Vec<Recording>)| {
            let mut counts = Counts::default();
            counts.add(recordings);
            let slid_mm: f64 = recordings.iter().map(|recording| recording.slid_mm).sum();
            SessionEntry {
                steps: counts.steps,
                slip_steps: counts.slip_steps,
                slips: counts.slips,
                slid_mm: (slid_mm * 1e2).round() / 1e2,
                setup: session.clone(),
            }
        };
        Self {
            tool: format!("tenax {}", env!("CARGO_PKG_VERSION")),
            seed: plan.seed,
            sessions: plan.sessions,
            file: file.to_owned(),
            sha256: sha256(bytes),
            columns: COLUMNS,
            rate_hz: tenax_hal_shim::channel::SLOW_HZ,
            held_out: HELD_OUT.name,
            split,
            material: SEEN.into_iter().chain([HELD_OUT]).collect(),
            session: all.iter().map(entry).collect(),
        }
    }
}
