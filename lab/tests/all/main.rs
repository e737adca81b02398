//! The tests of the studies, one program: `--test all kernels` runs those of a file.

mod dataset;
mod emg;
mod evaluate;
#[cfg(feature = "emulator")]
mod kernels;
mod learn;
#[cfg(feature = "emulator")]
mod lesson;
mod photoelastic;
mod table;

/// How many heads or sessions a test takes: `TENAX_SEEDS`, which a published figure says with its command, or these.
fn seeds(few: u64) -> u64 {
    std::env::var("TENAX_SEEDS").map_or(few, |own| own.parse().expect("TENAX_SEEDS is a number"))
}
