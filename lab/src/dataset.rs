//! Bamshad's collection method (section 3.2) as scenes, with the truth of the scenes as labels.
//!
//! A session is a box of one material, an array and a grip as they were set up once; it gives three recordings: balls are
//! poured in until it slips, again and again; it is picked up and placed back; it is disturbed and does not slip. Whole
//! sessions belong to training, validation or test, and one material to the test alone.

pub mod collect;
pub mod manifest;
pub mod operator;
pub mod session;
pub mod story;

use rayon::prelude::*;
use tenax_hal_shim::channel::ARRAY_COUNT;
use tenax_sim::jobs::{Jobs, Told};
use tenax_sim::labelled::{self, Part, library};
use tenax_sim::scorer::onsets;

use collect::{Recording, record};
use manifest::Manifest;
use session::{Session, Sizes, sessions};
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
                let (label, slips) = (u8::from(step.slips), onsets::text(slips));
                let first = [session.split.name(), &session.name, session.material, &name, story];
                let fields = first.map(str::to_owned).into_iter();
                let fields = fields.chain([format!("{:.4}", step.t_s), label.to_string(), slips]);
                writer.write_record(fields.chain(step.samples.map(|sample| sample.to_string())))?;
            }
        }
        Ok(writer.into_inner()?)
    }

    /// The recordings as they are read from the CSV.
    pub fn recordings(&self) -> anyhow::Result<Vec<labelled::Recording>> {
        let name = "array_dataset.csv";
        Ok(labelled::parse(self.csv()?.as_slice(), &library::choose(name.as_ref(), None)?, name)?)
    }

    pub fn manifest(&self, file: &str, csv: &[u8]) -> Manifest {
        Manifest::new(&self.plan, file, csv, &self.sessions)
    }
}
