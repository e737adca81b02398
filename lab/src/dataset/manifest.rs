//! What a data set says of itself: enough to make it again, and to know that it is the same.

use std::collections::BTreeMap;

use serde::Serialize;
use sha2::{Digest, Sha256};

use super::collect::Recording;
use super::session::Session;
use super::{Label, Plan};
use tenax_sim::array::material::{HELD_OUT, Material, SEEN};
use tenax_sim::labelled::Part;

/// The manifest, written as TOML beside the data.
#[derive(Clone, Debug, Serialize)]
pub struct Manifest {
    /// The tool and its version.
    pub tool: String,
    /// Of everything that was drawn.
    pub seed: u64,
    /// Sessions to learn from, of each seen material.
    pub sessions: usize,
    pub label: Label,
    /// The data's file, beside this one.
    pub file: String,
    /// Of the data's bytes.
    pub sha256: String,
    pub columns: &'static str,
    pub rate_hz: u32,
    /// The material that only the test has.
    pub held_out: &'static str,
    /// How often the marker agrees with the world, per cent of steps.
    pub marker_agrees_percent: f64,
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

/// A session, with what came of it.
#[derive(Clone, Debug, Serialize)]
pub struct SessionEntry {
    /// How much it gave.
    pub steps: usize,
    pub slip_steps: usize,
    /// Slips that the worlds counted.
    pub slips: usize,
    /// How far the box slid, mm.
    pub slid_mm: f64,
    /// How it was set up.
    pub setup: Session,
}

impl Manifest {
    /// Of data that is `bytes` in `file`.
    pub fn new(plan: &Plan, file: &str, bytes: &[u8], all: &[(Session, Vec<Recording>)]) -> Self {
        let mut split: BTreeMap<Part, Counts> = BTreeMap::new();
        let (mut agree, mut steps) = (0, 0);
        for (session, recordings) in all {
            let counts = split.entry(session.split).or_default();
            counts.sessions += 1;
            for recording in recordings {
                counts.recordings += 1;
                counts.steps += recording.steps.len();
                counts.slip_steps += slip_steps(recording, plan.label);
                counts.slips += recording.slips();
                counts.dropped += usize::from(recording.dropped);
                agree += recording.steps.iter().filter(|step| step.slips == step.marker_slips).count();
                steps += recording.steps.len();
            }
        }
        Self {
            tool: format!("tenax {}", env!("CARGO_PKG_VERSION")),
            seed: plan.seed,
            sessions: plan.sessions,
            label: plan.label,
            file: file.to_owned(),
            sha256: Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect(),
            columns: COLUMNS,
            rate_hz: tenax_hal_shim::channel::SLOW_HZ,
            held_out: HELD_OUT.name,
            marker_agrees_percent: hundredths(100.0 * agree as f64 / steps.max(1) as f64),
            split,
            material: SEEN.into_iter().chain([HELD_OUT]).collect(),
            session: all.iter().map(|(session, recordings)| entry(session, recordings, plan.label)).collect(),
        }
    }
}

fn entry(session: &Session, recordings: &[Recording], label: Label) -> SessionEntry {
    SessionEntry {
        steps: recordings.iter().map(|recording| recording.steps.len()).sum(),
        slip_steps: recordings.iter().map(|recording| slip_steps(recording, label)).sum(),
        slips: recordings.iter().map(Recording::slips).sum(),
        slid_mm: hundredths(recordings.iter().map(|recording| recording.slid_mm).sum()),
        setup: session.clone(),
    }
}

fn slip_steps(recording: &Recording, label: Label) -> usize {
    recording.steps.iter().filter(|step| label.of(step)).count()
}

fn hundredths(value: f64) -> f64 {
    (value * 1e2).round() / 1e2
}
