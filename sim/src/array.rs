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

pub type Verdicts = Vec<bool>;

pub fn verdicts(mut detector: impl FnMut(&Reading) -> bool, steps: &[Step]) -> Verdicts {
    readings(steps).iter().map(&mut detector).collect()
}

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
