//! The force array's network as it is judged: what it says of labelled recordings, step by step and slip by slip.

pub mod adapt;
pub mod edges;
pub mod events;
pub mod material;
pub mod network;
pub mod pour;
pub mod real;
pub mod steps;

use tenax_logic::array::Reading;
use tenax_logic::array::taxels::Taxels;

use crate::labelled::Step;

/// What a detector said of a recording, step by step: slip or not.
pub type Verdicts = Vec<bool>;

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
