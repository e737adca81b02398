//! `tenax evaluate`: the shipped network of the force array on recordings that it never saw, step by step and slip by
//! slip; and with the hand around it, in the paper's two tasks and in the scenes where it has to fail.

pub mod draws;
pub mod emg;
pub mod fit;
pub mod online;
pub mod ran;
pub mod report;
pub mod roc;

use tenax_sim::labelled::{Part, Recording};

/// The recordings to be judged by: those that their file calls test, or all if it says nothing of the kind.
pub fn test_split(recordings: Vec<Recording>) -> Vec<Recording> {
    if recordings.iter().all(|recording| recording.part.is_none()) {
        return recordings;
    }
    recordings.into_iter().filter(|recording| recording.part == Some(Part::Test)).collect()
}
