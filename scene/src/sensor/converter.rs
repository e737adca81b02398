//! The converter's own noise: no real channel is exactly constant.

use tenax_hal_shim::channel::{
    ARRAY, CHANNELS, CODE_MAX, COUNT, Input, PVDF, RANK_SWITCH_A, RANK_SWITCH_B, REFERENCE_MV, SCAN_LEN,
    STRAIN,
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

/// Adds the noise of one scan: of each conversion its own. What shares a switch shares a conversion, whichever of it is
/// selected.
#[derive(Debug)]
pub(crate) struct Converter(Noise);

impl Converter {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Noise::new(seed, Source::Converter))
    }

    pub(crate) fn step(&mut self, pins_v: &mut [f64; COUNT]) {
        const {
            // The ranks of the channels, as the sums below have them.
            let mut channel = 0;
            while channel < COUNT {
                let rank = match channel {
                    PVDF..STRAIN => channel - PVDF,
                    STRAIN..ARRAY => RANK_SWITCH_A,
                    _ => RANK_SWITCH_B,
                };
                assert!(RANKS[channel] == rank);
                channel += 1;
            }
        }
        let rank_v: [f64; SCAN_LEN] = self.0.normals().map(|draw| NOISE_LSB * LSB_V * draw);
        let (films_v, switched_v) = pins_v.split_at_mut(STRAIN);
        films_v.iter_mut().zip(&rank_v).for_each(|(pin_v, noise_v)| *pin_v += noise_v);
        let (a_v, b_v) = switched_v.split_at_mut(ARRAY - STRAIN);
        a_v.iter_mut().for_each(|pin_v| *pin_v += rank_v[RANK_SWITCH_A]);
        b_v.iter_mut().for_each(|pin_v| *pin_v += rank_v[RANK_SWITCH_B]);
    }
}
