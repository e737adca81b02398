//! The shipped detector, from `network.in` as `python -m tenax.train --ship` writes it.

use super::detector::{Judgement, Model};
use super::network::{Layer, Mlp};
use super::preprocess::PreprocessorConfig;

const fn layer<const I: usize, const O: usize>(
    weights: [[i16; I]; O],
    bias: [i32; O],
    shift: u32,
) -> Layer<I, O> {
    match Layer::new(weights, bias, shift) {
        Ok(layer) => layer,
        Err(_) => panic!("a sum could overflow"),
    }
}

pub static MODEL: Model = include!("network.in");
