//! A detector written outside `logic`, and the onsets of all detectors beside their evidence.

mod onset;
mod toy;
