//! Untrained networks of any size, to measure cost and agreement of machines.

use super::FEATURES;
use super::detector::{Judgement, Model};
use super::network::{Layer, Mlp};
use super::preprocess::PreprocessorConfig;

pub static MODEL: Model<32, 1, 16> = Model {
    preprocessor: PreprocessorConfig::DEFAULT,
    network: mlp::<FEATURES, 32, 1, 16>(1),
    judgement: Judgement {
        logit_per_nat: 1 << 19,
        on_permille: 700,
        off_permille: 300,
        on_frames: 2,
        off_frames: 3,
    },
};

pub const fn mlp<const I: usize, const H1: usize, const L: usize, const H2: usize>(
    seed: u32,
) -> Mlp<I, H1, L, H2> {
    let mut seed = seed;
    let first = layer(&mut seed);
    let mut second = [const { Layer::<H1, H2>::ZERO }; L];
    let mut frame = 0;
    while frame < L {
        second[frame] = layer(&mut seed);
        frame += 1;
    }
    match Mlp::new(first, second, layer(&mut seed)) {
        Ok(mlp) => mlp,
        Err(_) => panic!("a layer of this size could overflow"),
    }
}

/// Weights within +-128, biases within +-2^20, and a shift that keeps most activations from saturating.
pub const fn layer<const I: usize, const O: usize>(seed: &mut u32) -> Layer<I, O> {
    let mut weights = [[0; I]; O];
    let mut bias = [0; O];
    let mut output = 0;
    while output < O {
        let mut input = 0;
        while input < I {
            weights[output][input] = (next(seed) >> 24) as i16;
            input += 1;
        }
        bias[output] = next(seed) >> 11;
        output += 1;
    }
    match Layer::new(weights, bias, 8) {
        Ok(layer) => layer,
        Err(_) => panic!("a layer of this size could overflow"),
    }
}

const fn next(seed: &mut u32) -> i32 {
    *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    *seed as i32
}
