//! The tests of the studies, one program.

mod dataset;
mod emg;
mod learn;
mod photoelastic;
mod table;
mod vision;

/// Heads or sessions of a test: `TENAX_SEEDS`, or these.
fn seeds(few: u64) -> u64 {
    std::env::var("TENAX_SEEDS").map_or(few, |own| own.parse().expect("TENAX_SEEDS is a number"))
}
