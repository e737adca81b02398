//! `tenax evaluate`: the force array's network on recordings that it never saw; and intent recognition on people.

pub mod emg;
pub mod fit;
pub mod report;

use tenax_sim::labelled::{Part, Recording};

/// The test part, or all recordings where the file names no parts.
pub fn test_split(mut recordings: Vec<Recording>) -> Vec<Recording> {
    if recordings.iter().any(|recording| recording.part.is_some()) {
        recordings.retain(|recording| recording.part == Some(Part::Test));
    }
    recordings
}
