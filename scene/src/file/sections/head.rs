//! The photoelastic head.

use serde::Deserialize;

use crate::file::quantity::{Degrees, Gain, Millivolts, Mu, Part, Speed};

/// A photoelastic head in the place of PVDF film 12 (Dubey 2006). The board has to be told: `head-photoelastic-flag`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Photoelastic {
    pub strip: bool,
    pub mu_s: Mu,
    pub mu_d: Mu,
    pub stribeck_mm_s: Speed,
    pub share: Part,
    pub polariser_deg: Degrees,
    pub dark_mv: Millivolts,
    pub span_mv: Millivolts,
    pub spread: Part,
    pub drift: Part,
    /// Ambient light at most.
    pub ambient_mv: Millivolts,
    pub knock_mn_per_mv: Gain,
    /// Noise of a frame's sample, rms.
    pub noise_mv: Millivolts,
}
