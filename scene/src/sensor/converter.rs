//! The converter's own noise: no real channel is exactly constant.

use tenax_hal_shim::channel::{CODE_MAX, COUNT, REFERENCE_MV};

use crate::random::{Noise, Source};

/// One code, V.
const LSB_V: f64 = REFERENCE_MV as f64 / 1e3 / (CODE_MAX as f64 + 1.0);
/// Noise, rms, codes (STM32F411 data sheet: an effective resolution of about 10.5 bits; converter and wiring).
const NOISE_LSB: f64 = 1.0;

/// Adds noise to every pin.
#[derive(Debug)]
pub(crate) struct Converter(Noise);

impl Converter {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Noise::new(seed, Source::Converter))
    }

    pub(crate) fn step(&mut self, pins_v: &mut [f64; COUNT]) {
        for pin_v in pins_v {
            *pin_v += NOISE_LSB * LSB_V * self.0.normal();
        }
    }
}
