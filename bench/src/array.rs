//! The force array's network as it is judged: what it says of labelled recordings, step by step and slip by slip.

pub mod adapt;
pub mod edges;
pub mod events;
pub mod material;
pub mod network;
pub mod pour;
pub mod real;
pub mod steps;

use rayon::prelude::*;
use tenax_logic::array::Reading;
use tenax_logic::array::taxels::Taxels;

use crate::labelled::{Recording, Step};

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

pub fn verdicts(mut detector: impl FnMut(&Reading) -> bool, steps: &[Step]) -> Verdicts {
    readings(steps).iter().map(&mut detector).collect()
}

/// What a detector is told of a recording: an element that the fingertip would not believe has no reading.
pub fn readings(steps: &[Step]) -> Vec<Reading> {
    let mut taxels = Taxels::default();
    let read = |step: &Step| {
        for (element, &sample) in step.samples.iter().enumerate() {
            taxels.read(element, sample);
        }
        *taxels.reading()
    };
    steps.iter().map(read).collect()
}
