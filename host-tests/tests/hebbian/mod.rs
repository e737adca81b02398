//! The Hebbian network (Tada 2006) against `f64`, its theory and its boundaries.
//!
//! `cargo test -p tenax-host-tests --test fingertip hebbian -- --nocapture` prints the figures of `docs/hebbian.md`.

mod failures;
mod long_runs;
mod map;
mod oracle;
mod properties;
mod task;
