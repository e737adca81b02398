//! `tenax evaluate`: the shipped network of the force array on recordings that it never saw, step by step and slip by
//! slip; and with the hand around it, in the paper's two tasks and in the scenes where it has to fail.

pub mod adapt;
#[cfg(feature = "emulator")]
pub mod core;
pub mod draws;
pub mod edges;
pub mod events;
pub mod failures;
pub mod network;
pub mod online;
pub mod ran;
pub mod real;
pub mod report;
pub mod roc;
pub mod text;

use rayon::prelude::*;
use tenax_logic::array::Reading;
use tenax_logic::elements::Elements;

use crate::labelled::{Part, Recording, Step};

/// What a detector said of a recording, step by step: slip or not.
pub type Verdicts = Vec<bool>;

/// What a detector says of recordings. Each recording is read by a `fresh` one, which knows nothing yet: it is told the
/// readings of one slow frame and says whether the object slips.
pub fn judge<D: FnMut(&Reading) -> bool>(
    fresh: impl Fn() -> D + Sync,
    recordings: &[Recording],
) -> Vec<Verdicts> {
    recordings.par_iter().map(|recording| verdicts(fresh(), &recording.steps)).collect()
}

/// What one detector says.
pub fn verdicts(mut detector: impl FnMut(&Reading) -> bool, steps: &[Step]) -> Verdicts {
    readings(steps).iter().map(&mut detector).collect()
}

/// What a detector is told of a recording: an element that the fingertip would not believe has no reading.
#[must_use]
pub fn readings(steps: &[Step]) -> Vec<Reading> {
    let mut elements = Elements::default();
    let read = |step: &Step| {
        for (element, &sample) in step.samples.iter().enumerate() {
            elements.take(element, sample);
        }
        *elements.reading()
    };
    steps.iter().map(read).collect()
}

/// The recordings to be judged by: those that their file calls test, or all if it says nothing of the kind.
#[must_use]
pub fn test_split(recordings: Vec<Recording>) -> Vec<Recording> {
    if recordings.iter().all(|recording| recording.part.is_none()) {
        return recordings;
    }
    recordings.into_iter().filter(|recording| recording.part == Some(Part::Test)).collect()
}
