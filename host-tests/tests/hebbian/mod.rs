//! The Hebbian network (Tada 2006) against `f64`, against its own theory, and where it fails.
//!
//! `cargo test -p tenax-host-tests --test fingertip hebbian -- --nocapture` prints every figure of `docs/hebbian.md`.

mod failures;
mod long_runs;
mod map;
mod oracle;
mod properties;
mod task;
