//! Sensors of the fingertip, and the cameras.

use serde::Deserialize;
use tenax_hal_shim::channel::FSR_COUNT;

use crate::file::quantity::{
    DeadTime, Degrees, Duration, Gain, Hertz, Instant, Lever, Micrometres, Millimetres, Millinewtons,
    Milliseconds, Millivolts, Mu, Part, Speed,
};

/// The PVDF films. Voltages are at the film; the front end multiplies them by `gain`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Pvdf {
    pub gain: Gain,
    pub spread: Part,
    pub film_decades: Part,
    pub film_directions: Part,
    pub high_pass_hz: Hertz,
    pub skin_ms: Milliseconds,
    pub normal_mv_per_n: Gain,
    pub shear_mv_per_n: Gain,
    pub release_mv_per_n: Gain,
    pub texture_mv_per_n: Gain,
    pub texture_half_mm_s: Speed,
    /// Noise of an object settling in the grasp, rms, for 1 N/s of change of the grip force.
    pub adjust_mv_per_n_s: Gain,
    pub motor_mv: Millivolts,
    pub motor_hz: Hertz,
    pub mains_mv: Millivolts,
    pub mains_hz: Hertz,
    /// Broadband noise up to half the frame rate, rms.
    pub noise_mv: Millivolts,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Fsr {
    pub hysteresis: Part,
    pub creep: Part,
    pub creep_s: Duration,
    /// Gains of quadrants A to D.
    pub gains: [Gain; FSR_COUNT],
    /// Where the load lies beside the pad's middle, along the shear and across it.
    pub aside_mm: [Lever; 2],
    /// Noise of a reading, rms, as a part of it.
    pub noise: Part,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Myo {
    /// Rise of the envelope from 10 to 90 %.
    pub rise_ms: Milliseconds,
    pub tone_mv: Millivolts,
    /// Wandering of a relaxed envelope, rms.
    pub noise_mv: Millivolts,
    /// Wandering of a contraction, rms, as a part of it.
    pub ripple: Part,
    pub crosstalk: Part,
    pub mains_mv: Millivolts,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Strain {
    pub normal_mv_per_n: Gain,
    pub shear_mv_per_n: Gain,
    pub spread: Part,
    pub offset_mv: Millivolts,
    pub drift_mv_per_min: Millivolts,
    pub creep: Part,
    pub creep_s: Duration,
    /// Noise of a reading, rms.
    pub noise_mv: Millivolts,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Array {
    pub mv_per_n: Gain,
    pub spread: Part,
    pub offset_mv: Millivolts,
    pub tilt: Part,
    pub slip_part: Part,
    pub rim_part: Part,
    pub renews_um: Micrometres,
    pub uneven: Part,
    pub knock_mn_per_mv: Gain,
    pub motor_part: Part,
    pub place_mm: Lever,
    /// Which array it is: its gains and offsets. The scene's seed decides if it is not said.
    pub specimen: Option<u32>,
    /// Noise of a reading, rms.
    pub noise_mv: Millivolts,
}

/// The camera behind a clear skin, as the summary that its computer sends.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Skin {
    pub rate_hz: Hertz,
    pub delay_ms: DeadTime,
    /// Noise of a marker's force, rms.
    pub force_noise_mn: Millinewtons,
    /// Noise of the object's angle, rms.
    pub angle_noise_deg: Degrees,
    /// Points that move though nothing does, rms, in 1/10,000 of the picture.
    pub speckle_e4: Gain,
    pub wrong_part: Part,
    pub wrong_pictures: Gain,
    pub dark_from_s: Option<Instant>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Camera {
    pub pixel_mm: Millimetres,
    pub rate_hz: Hertz,
    /// Jitter of a mark's place, rms, pixels.
    pub jitter_px: Part,
    pub delay_ms: DeadTime,
    pub teaches: bool,
}

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
