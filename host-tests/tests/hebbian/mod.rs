//! The Hebbian network (Tada 2006) against `f64`, its theory and its boundaries.

mod failures;
mod long_runs;
mod map;
mod oracle;
mod properties;
mod task;
