//! Bamshad's collection method (section 3.2) as scenes, with the truth of the scenes as labels. Whole sessions belong to training, validation
//! or test, and one material to the test alone.

pub mod collect;
pub mod material;
pub mod operator;
pub mod session;
pub mod story;

use std::collections::BTreeMap;

use rayon::prelude::*;
use serde::Serialize;
use sha2::{Digest, Sha256};
use tenax_hal_shim::channel::{ARRAY_COUNT, SLOW_HZ};
use tenax_sim::jobs::{Jobs, Told};
use tenax_sim::scorer::SlipSpan;

use collect::{Recording, record};
use material::HELD_OUT;
use session::{Part, Session, Sizes, sessions};
use story::Story;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    pub seed: u64,
    /// Sessions to learn from, of each seen material; validation and test are in proportion ([`Sizes::of_train`]).
    pub sessions: usize,
}

#[derive(Clone, Debug)]
pub struct Dataset {
    pub sessions: Vec<(Session, Vec<Recording>)>,
    plan: Plan,
}

impl Dataset {
    /// Makes a data set, or one part of it, on all cores. `progress` gets the part that is done, 0 to 1. Fails if a drawn number is none
    /// that a scene may have.
    pub fn make(plan: Plan, part: Option<Part>, progress: Told) -> anyhow::Result<Self> {
        let mut all = sessions(plan.seed, Sizes::of_train(plan.sessions));
        all.retain(|session| part.is_none_or(|part| session.split == part));
        let jobs = Jobs::new(all.len() * Story::ALL.len(), progress);
        let recorded = all.into_par_iter().map(|session| {
            let recorded = |&story| {
                let _job = jobs.begin();
                record(&session, story)
            };
            let recordings = Story::ALL.iter().map(recorded).collect::<Result<_, _>>()?;
            Ok((session, recordings))
        });
        Ok(Self { sessions: recorded.collect::<anyhow::Result<_>>()?, plan })
    }

    pub fn csv(&self) -> anyhow::Result<Vec<u8>> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let elements = (1..=ARRAY_COUNT).map(|n| format!("a{n}"));
        let first =
            ["split", "session", "material", "recording", "task", "t_s", "label", "slips"].map(str::to_owned);
        writer.write_record(first.into_iter().chain(elements))?;
        let all = self.sessions.iter().flat_map(|(session, all)| all.iter().map(move |own| (session, own)));
        for (session, recording) in all {
            let story = recording.story.name();
            let name = format!("{}-{story}", session.name);
            let mut spans = recording.spans.iter().peekable();
            let last_s = recording.steps.last().map_or(0.0, |step| step.t_s);
            for step in &recording.steps {
                // The last step has the slips that begin after it, too.
                let until_s = if step.t_s < last_s { step.t_s } else { f64::INFINITY };
                let slips = std::iter::from_fn(|| spans.next_if(|span| span.micro_onset_s <= until_s));
                let (label, slips) = (u8::from(step.slips), onsets(slips));
                let first = [session.split.name(), &session.name, session.material, &name, story];
                let fields = first.map(str::to_owned).into_iter();
                let fields = fields.chain([format!("{:.4}", step.t_s), label.to_string(), slips]);
                writer.write_record(fields.chain(step.samples.map(|sample| sample.to_string())))?;
            }
        }
        Ok(writer.into_inner()?)
    }

    pub fn manifest(&self, file: &str, csv: &[u8]) -> Manifest {
        let mut split: BTreeMap<Part, Counts> = BTreeMap::new();
        for (session, recordings) in &self.sessions {
            let counts = split.entry(session.split).or_default();
            counts.sessions += 1;
            for recording in recordings {
                counts.recordings += 1;
                counts.steps += recording.steps.len();
                counts.slip_steps += recording.steps.iter().filter(|step| step.slips).count();
                counts.slips += recording.spans.iter().filter(|span| span.macro_onset_s.is_some()).count();
                counts.dropped += usize::from(recording.dropped);
            }
        }
        Manifest {
            tool: format!("tenax {}", env!("CARGO_PKG_VERSION")),
            seed: self.plan.seed,
            sessions: self.plan.sessions,
            file: file.to_owned(),
            sha256: sha256(csv),
            columns: COLUMNS,
            rate_hz: SLOW_HZ,
            held_out: HELD_OUT.name,
            split,
        }
    }
}

/// Enough to make a data set again, and to know that it is the same; written as TOML beside the data.
#[derive(Clone, Debug, Serialize)]
pub struct Manifest {
    pub tool: String,
    pub seed: u64,
    /// Sessions to learn from, of each seen material.
    pub sessions: usize,
    pub file: String,
    pub sha256: String,
    pub columns: &'static str,
    pub rate_hz: u32,
    pub held_out: &'static str,
    pub split: BTreeMap<Part, Counts>,
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

/// The slips of a step as [`COLUMNS`] has them, joined by `;`. An empty end is never.
fn onsets<'a>(slips: impl Iterator<Item = &'a SlipSpan>) -> String {
    let at = |s: Option<f64>| s.map_or(String::new(), |s| format!("{s:.6}"));
    let one = |slip: &SlipSpan| {
        let (macro_s, end_s) = (at(slip.macro_onset_s), at(Some(slip.end_s).filter(|s| s.is_finite())));
        let meant = if slip.meant { "!" } else { "" };
        format!("{:.6}/{macro_s}/{end_s}/{:.4}{meant}", slip.micro_onset_s, slip.distance_mm)
    };
    slips.map(one).collect::<Vec<_>>().join(";")
}

fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
