//! The array detector (Bamshad 2023) against its equations in wider numbers, for any input.

mod detector;
mod features;
mod network;
mod oracle;
mod structure;

use proptest::prelude::*;
use tenax_hal_shim::channel::SAMPLE_MAX;
use tenax_logic::array::{ELEMENTS, Reading};

fn alive() -> impl Strategy<Value = [u16; ELEMENTS]> {
    // Small changes around a load, which is what a sensor gives, and the converter's extremes.
    let sample = prop_oneof![4 => 2_000..2_040u16, 2 => 0..=SAMPLE_MAX, 1 => Just(0), 1 => Just(SAMPLE_MAX)];
    prop::array::uniform10(sample)
}

fn readings(frames: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Reading>> {
    let element = |sample: u16| prop::option::weighted(0.95, Just(sample));
    let reading = alive().prop_flat_map(move |samples| samples.map(element));
    prop::collection::vec(reading, frames)
}
