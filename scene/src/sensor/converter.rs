//! The converter's own noise: no real channel is exactly constant.

use tenax_hal_shim::channel::{
    CHANNELS, CODE_MAX, COUNT, Input, RANK_SWITCH_A, RANK_SWITCH_B, REFERENCE_MV, SCAN_LEN,
};

use crate::random::{Noise, Source};

const LSB_V: f64 = REFERENCE_MV as f64 / 1e3 / (CODE_MAX as f64 + 1.0);
/// Noise, rms, codes (STM32F411 data sheet: an effective resolution of about 10.5 bits; converter and wiring).
const NOISE_LSB: f64 = 1.0;

/// The rank of the scan in which each channel is converted.
const RANKS: [usize; COUNT] = {
    let mut ranks = [0; COUNT];
    let mut channel = 0;
    while channel < COUNT {
        ranks[channel] = match CHANNELS[channel].input {
            Input::Direct { rank } => rank as usize,
            Input::SwitchA { .. } => RANK_SWITCH_A,
            Input::SwitchB { .. } => RANK_SWITCH_B,
        };
        channel += 1;
    }
    ranks
};

/// Adds the noise of one scan: of each conversion its own. What shares a switch shares a conversion, whichever of it is selected.
#[derive(Debug)]
pub(crate) struct Converter(Noise);

impl Converter {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Noise::new(seed, Source::Converter))
    }

    pub(crate) fn step(&mut self, pins_v: &mut [f64; COUNT]) {
        let rank_v: [f64; SCAN_LEN] = self.0.normals().map(|draw| NOISE_LSB * LSB_V * draw);
        for (pin_v, rank) in pins_v.iter_mut().zip(RANKS) {
            *pin_v += rank_v[rank];
        }
    }
}
