//! `tenax dataset`: Bamshad's collection method (section 3.2) as scenes, with the truth of the scenes as labels.
//!
//! A session is a box of one material, an array and a grip as they were set up once; it gives three recordings: balls are
//! poured in until it slips, again and again; it is picked up and placed back; it is disturbed and does not slip. Whole
//! sessions belong to training, validation or test, and one material to the test alone.

pub mod collect;
pub mod manifest;
pub mod marker;
pub mod operator;
pub mod session;
pub mod story;

use rayon::prelude::*;
use serde::Serialize;
use tenax_hal_shim::channel::ARRAY_COUNT;

use collect::{Recording, Step, record};
use manifest::Manifest;
use session::{Session, Sizes, sessions};
use story::Story;

use tenax_sim::jobs::{Jobs, Told};
use tenax_sim::labelled::Part;
use tenax_sim::scorer::onsets;

/// Who says that it slipped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Label {
    /// The world: the box moved over the pads faster than the floor (docs/glossary.md, sample scores)
    #[default]
    Truth,
    /// The marker: the moving averages of its height and pitch moved (Bamshad 2023, section 3.2)
    Marker,
}

impl Label {
    pub const fn of(self, step: &Step) -> bool {
        match self {
            Self::Truth => step.slips,
            Self::Marker => step.marker_slips,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Of everything that is drawn.
    pub seed: u64,
    /// Sessions to learn from, of each seen material; validation and test are in proportion ([`Sizes::of_train`]).
    pub sessions: usize,
    pub label: Label,
}

impl Default for Plan {
    fn default() -> Self {
        Self { seed: 1, sessions: Sizes::DEFAULT_TRAIN, label: Label::default() }
    }
}

#[derive(Clone, Debug)]
pub struct Dataset {
    pub sessions: Vec<(Session, Vec<Recording>)>,
    plan: Plan,
}

impl Dataset {
    /// Makes one, on all cores. `progress` is told the part that is done, 0 to 1. Fails if a drawn number is none that a scene may have.
    pub fn make(plan: Plan, progress: Told) -> anyhow::Result<Self> {
        Self::record(plan, sessions(plan.seed, Sizes::of_train(plan.sessions)), progress)
    }

    /// Makes the sessions of one split only: they are the same as in the whole. Fails as [`make`](Self::make) does.
    pub fn make_split(plan: Plan, split: Part, progress: Told) -> anyhow::Result<Self> {
        let mut all = sessions(plan.seed, Sizes::of_train(plan.sessions));
        all.retain(|session| session.split == split);
        Self::record(plan, all, progress)
    }

    /// Makes sessions in which one quantity at a time lies outside of what was learned, a quarter of `plan.sessions` of each material for
    /// each: see [`session::outside`]. Fails as [`make`](Self::make) does.
    pub fn make_outside(plan: Plan, progress: Told) -> anyhow::Result<Self> {
        Self::record(plan, session::outside(plan.seed, plan.sessions.div_ceil(4)), progress)
    }

    fn record(plan: Plan, all: Vec<Session>, progress: Told) -> anyhow::Result<Self> {
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

    /// The data as CSV.
    ///
    /// # Errors
    /// None that memory does not have.
    pub fn csv(&self) -> anyhow::Result<Vec<u8>> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let elements = (1..=ARRAY_COUNT).map(|n| format!("a{n}"));
        let first =
            ["split", "session", "material", "recording", "task", "t_s", "label", "slips"].map(str::to_owned);
        writer.write_record(first.into_iter().chain(elements))?;
        for (session, recordings) in &self.sessions {
            for recording in recordings {
                let name = format!("{}-{}", session.name, recording.story.name());
                let mut spans = recording.spans.iter().peekable();
                let last_s = recording.steps.last().map_or(0.0, |step| step.t_s);
                for step in &recording.steps {
                    let label = u8::from(self.plan.label.of(step)).to_string();
                    // What begins behind the last step is in it, too: nothing is left out.
                    let until_s = if step.t_s < last_s { step.t_s } else { f64::INFINITY };
                    let begun = std::iter::from_fn(|| spans.next_if(|span| span.micro_onset_s <= until_s));
                    let slips = onsets::text(begun);
                    let first = [
                        session.split.name(),
                        &session.name,
                        session.material,
                        &name,
                        recording.story.name(),
                    ];
                    let fields = first.map(str::to_owned).into_iter();
                    let fields = fields.chain([format!("{:.4}", step.t_s), label, slips]);
                    writer.write_record(fields.chain(step.samples.map(|sample| sample.to_string())))?;
                }
            }
        }
        Ok(writer.into_inner()?)
    }

    /// What it says of itself, once it is `csv` in `file`.
    pub fn manifest(&self, file: &str, csv: &[u8]) -> Manifest {
        Manifest::new(&self.plan, file, csv, &self.sessions)
    }
}
