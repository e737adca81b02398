//! The photoelastic head.

use serde::Deserialize;

use crate::file::quantity::{Degrees, Gain, Millivolts, Mu, Part, Speed};

/// A photoelastic head in the place of PVDF film 12 (Dubey 2006). The board has to be told: `head-photoelastic-flag`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Photoelastic {
    /// Whether the metal strip is glued on. Without it friction does not fall with speed, and slip has no lasting signal.
    pub strip: bool,
    /// Static friction of what slides over the strip.
    pub mu_s: Mu,
    /// Sliding friction at high speed.
    pub mu_d: Mu,
    /// The speed at which 1/e of the difference is left.
    pub stribeck_mm_s: Speed,
    /// How much of the finger's load the head carries.
    pub share: Part,
    /// Angle between the polariser and the normal force.
    pub polariser_deg: Degrees,
    /// Voltage without load.
    pub dark_mv: Millivolts,
    /// What the peak of the curve adds to it.
    pub span_mv: Millivolts,
    /// How much one head's curve, strip and layer differ from the mean one's, as a part.
    pub spread: Part,
    /// How far source and layer may have drifted since the head was made, as a part.
    pub drift: Part,
    /// Ambient light at most.
    pub ambient_mv: Millivolts,
    /// What a knock of 1 mV at a film adds to the load of the head while it rings.
    pub knock_mn_per_mv: Gain,
    /// Noise of a frame's sample, rms.
    pub noise_mv: Millivolts,
}
