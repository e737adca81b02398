//! One more detector, written outside `logic`; and all detectors against the instant at which they say they decided.

mod onset;
mod sensing;
mod toy;
