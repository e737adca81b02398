//! What the fingertip feels with.

use serde::Deserialize;

use crate::file::quantity::{
    DeadTime, Degrees, Duration, Gain, Hertz, Instant, Lever, Micrometres, Millimetres, Millinewtons,
    Milliseconds, Millivolts, Part, Speed,
};

/// The PVDF films. Voltages are at the film; the front end multiplies them by `gain`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Pvdf {
    /// From film to pin.
    pub gain: Gain,
    /// How much louder or quieter than the mean one film may be: 0.4 is from 0.6 to 1.4.
    pub spread: Part,
    /// Decades over which a film's gain is drawn, beside that, and by itself its noise: both evenly over their logarithm.
    pub film_decades: Part,
    /// How far a film's direction is drawn: 0, all lie alike; 1, each feels pressure and shear in a mixture of its own, as gauges do.
    pub film_directions: Part,
    /// Corner of the charge amplifier's high-pass.
    pub high_pass_hz: Hertz,
    /// Mean time in which the skin passes a deformation on to a film; deeper films take up to 1.5 times as long.
    pub skin_ms: Milliseconds,
    pub normal_mv_per_n: Gain,
    pub shear_mv_per_n: Gain,
    /// For 1 N of shear let go by a contact that begins to slide.
    pub release_mv_per_n: Gain,
    /// Texture tone of fast sliding, for 1 N of difference between sticking and sliding shear.
    pub texture_mv_per_n: Gain,
    /// The speed at which the texture tone has half of that.
    pub texture_half_mm_s: Speed,
    /// Noise of an object settling in the grasp, rms, for 1 N/s of change of the grip force.
    pub adjust_mv_per_n_s: Gain,
    /// Motor and gear at full speed.
    pub motor_mv: Millivolts,
    /// Frequency of the gear's teeth at full speed.
    pub motor_hz: Hertz,
    pub mains_mv: Millivolts,
    pub mains_hz: Hertz,
    /// Broadband noise up to half the frame rate, rms.
    pub noise_mv: Millivolts,
}

/// The force sensor under its tilting element.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Fsr {
    /// Half the width of the gap between loading and unloading, as a part of the force.
    pub hysteresis: Part,
    /// How much more a lasting load reads in the end than at first.
    pub creep: Part,
    pub creep_s: Duration,
}

/// The myoelectric sensors: smoothed envelopes.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Myo {
    /// Rise of the envelope from 10 to 90 %.
    pub rise_ms: Milliseconds,
    /// A relaxed muscle, above rest.
    pub tone_mv: Millivolts,
    /// Wandering of a relaxed envelope, rms.
    pub noise_mv: Millivolts,
    /// Wandering of a contraction, rms, as a part of it.
    pub ripple: Part,
    /// The part of a contraction that the other electrode hears.
    pub crosstalk: Part,
    /// Mains in the envelope (twice its frequency, it is rectified).
    pub mains_mv: Millivolts,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Strain {
    /// For 1 N of normal force, of a gauge that feels nothing else, in the outer layer.
    pub normal_mv_per_n: Gain,
    /// For 1 N of shear, likewise.
    pub shear_mv_per_n: Gain,
    /// How much more or less sensitive than the mean one gauge may be, as a part.
    pub spread: Part,
    /// How far from rest an unloaded gauge may be, either way.
    pub offset_mv: Millivolts,
    /// How far a gauge may drift in a minute, either way.
    pub drift_mv_per_min: Millivolts,
    /// How much more a lasting load reads in the end than at first.
    pub creep: Part,
    pub creep_s: Duration,
    /// Noise of a reading, rms.
    pub noise_mv: Millivolts,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Array {
    /// For 1 N on one element.
    pub mv_per_n: Gain,
    /// How much more or less sensitive than the mean one element may be, as a part.
    pub spread: Part,
    /// How far above rest an unloaded element may be.
    pub offset_mv: Millivolts,
    /// How much of the load a shear (or a torsion over the patch's radius) as large as it moves to the pad's end.
    pub tilt: Part,
    /// How much of the shear that an element lets go of comes off its load.
    pub slip_part: Part,
    /// What leaves one element by sliding goes to the rim of the cover, which nothing senses, by this part, and to the other
    /// elements by the rest.
    pub rim_part: Part,
    /// The way over which the contacts under an element are all new ones: friction's memory.
    pub renews_um: Micrometres,
    /// What the unevenness of a surface that slides over an element adds to its load and takes from it, rms, as a part.
    pub uneven: Part,
    /// What a knock of 1 mV at a film adds to the load of the whole pad while it rings.
    pub knock_mn_per_mv: Gain,
    /// What the gear's teeth add to the load of the whole pad while the motor runs at full speed, as a part.
    pub motor_part: Part,
    /// How far along the pad the object lies off the array's middle.
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
    /// From the instant of a picture until its summary has come over the serial line.
    pub delay_ms: DeadTime,
    /// Noise of a marker's force, rms.
    pub force_noise_mn: Millinewtons,
    /// Noise of the object's angle, rms.
    pub angle_noise_deg: Degrees,
    /// Points that move though nothing does, rms, in 1/10,000 of the picture.
    pub speckle_e4: Gain,
    /// Pictures in which slip is told wrongly: seen where there is none, or missed, as a part.
    pub wrong_part: Part,
    /// How many of them come one after the other, mean.
    pub wrong_pictures: Gain,
    /// When it goes dark: covered, or its cable is pulled.
    pub dark_from_s: Option<Instant>,
}

/// The camera that watches hand and object.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Camera {
    /// One pixel in the world.
    pub pixel_mm: Millimetres,
    pub rate_hz: Hertz,
    /// Jitter of a mark's place, rms, pixels.
    pub jitter_px: Part,
    /// From the instant of an image until its words have come over the serial line.
    pub delay_ms: DeadTime,
    /// Whether its words go to the fingertip.
    pub teaches: bool,
}
