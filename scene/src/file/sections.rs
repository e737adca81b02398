//! What a scene file is made of: one struct for each kind of table in it.
//!
//! `docs/scenes.md` explains every key to whoever writes one. Sections of the hand and its sensors have defaults, whose
//! sources stand in [`super::defaults`]; the world has none, it is what the scene is about.

use std::num::NonZeroU8;

use serde::Deserialize;
use toml::Spanned;

use super::channel::ChannelName;
use super::quantity::{
    Acceleration, Damping, DeadTime, Duration, Gain, Height, Hertz, Instant, Kilograms, KilogramsAdded,
    Millimetres, Milliseconds, Millivolts, Mu, Newtons, NewtonsMax, Part, Speed, Stiffness, Velocity,
};

/// Friction between pad and surface.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Static friction.
    pub mu_s: Mu,
    /// Dynamic friction, at most `mu_s`.
    pub mu_d: Spanned<Mu>,
    /// How far an object can slip before it leaves the pads.
    pub pad_length_mm: Millimetres,
    /// Distance between two ridges of the skin's grooves or of the surface's texture, whichever is coarser.
    pub pitch_mm: Millimetres,
}

/// A change of friction for a while: water, grease.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wet {
    /// When it begins.
    pub at_s: Spanned<Instant>,
    /// When it begins to go back; never without it.
    pub until_s: Option<Spanned<Instant>>,
    /// How long each change takes.
    pub ramp_ms: Milliseconds,
    /// Static friction while it lasts.
    pub mu_s: Mu,
    /// Dynamic friction while it lasts, at most `mu_s`.
    pub mu_d: Spanned<Mu>,
}

/// Something to grasp.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Object {
    /// Empty.
    pub mass_kg: Kilograms,
    /// Where the fingers take it.
    pub width_mm: Millimetres,
    /// Of pad and object together, a finger.
    pub stiffness_n_per_mm: Stiffness,
}

/// The table it stands on, with its mat.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Table {
    /// Stiffness of the mat.
    pub mat_n_per_mm: Stiffness,
    /// Damping of the mat under the empty object.
    pub damping: Damping,
}

/// Something poured in (or out).
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fill {
    /// When it begins.
    pub at_s: Spanned<Instant>,
    /// How long it takes, evenly.
    pub for_s: Duration,
    /// How much altogether.
    pub add_kg: Spanned<KilogramsAdded>,
}

/// The arm lifts or lowers the hand.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Move {
    /// When it begins.
    pub at_s: Spanned<Instant>,
    /// How long it takes.
    pub for_s: Duration,
    /// To this height over where the hand grasped.
    pub to_mm: Height,
}

/// The arm swings the hand up and down.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Swing {
    /// When it begins.
    pub at_s: Spanned<Instant>,
    /// How many times.
    pub cycles: NonZeroU8,
    /// How often.
    pub rate_hz: Hertz,
    /// Acceleration of the strongest.
    pub peak_m_s2: Acceleration,
}

/// The robot that strokes a probe over a surface.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Robot {
    /// Mass of the probe.
    pub probe_kg: Kilograms,
    /// Compliance of the arm along the stroke.
    pub stiffness_n_per_mm: Stiffness,
    /// Its damping.
    pub damping: Damping,
    /// How long load and speed take to come and to go.
    pub ramp_ms: Milliseconds,
}

/// The robot presses the probe on the surface.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Press {
    /// When the load begins to come.
    pub at_s: Spanned<Instant>,
    /// Until it is gone.
    pub for_s: Duration,
    /// The load.
    pub load_n: Newtons,
}

/// The robot moves its carriage.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// When it begins.
    pub at_s: Spanned<Instant>,
    /// How long it lasts.
    pub for_s: Duration,
    /// How fast; negative is back.
    pub speed_mm_s: Velocity,
}

/// The hand's motor and fingers.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Gripper {
    /// Fastest change of the opening.
    pub speed_mm_s: Speed,
    /// Force at which a finger stalls under the whole supply.
    pub force_n: NewtonsMax,
    /// From drive to motion, and from coast to rest.
    pub dead_time_ms: DeadTime,
    /// The widest opening.
    pub range_mm: Millimetres,
    /// The opening at the start.
    pub opening_mm: Spanned<Millimetres>,
}

/// The PVDF films. Voltages are at the film; the front end multiplies them by `gain`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Pvdf {
    /// From film to pin.
    pub gain: Gain,
    /// How much louder or quieter than the mean one film may be: 0.4 is from 0.6 to 1.4.
    pub spread: Part,
    /// Corner of the charge amplifier's high-pass.
    pub high_pass_hz: Hertz,
    /// Mean time in which the skin passes a deformation on to a film; deeper films take up to 1.5 times as long.
    pub skin_ms: Milliseconds,
    /// For 1 N of normal force.
    pub normal_mv_per_n: Gain,
    /// For 1 N of shear.
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
    /// Mains hum.
    pub mains_mv: Millivolts,
    /// Frequency of the mains.
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
    /// How long that takes.
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

/// Something hits the hand or the table: a short ring in every film.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Knock {
    /// When.
    pub at_s: Spanned<Instant>,
    /// First peak, at the film.
    pub peak_mv: Millivolts,
    /// What rings.
    pub ring_hz: Hertz,
    /// Until it has fallen to 1/e.
    pub decay_ms: Milliseconds,
}

/// What the wearer wants of the hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Intent {
    /// Flexor.
    Close,
    /// Extensor.
    Open,
    /// Both at once: co-contraction.
    Both,
}

/// The wearer contracts.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Muscle {
    /// When.
    pub at_s: Spanned<Instant>,
    /// How long at most.
    pub for_s: Duration,
    /// What for.
    pub intent: Intent,
    /// How strongly: envelope above rest.
    pub level_mv: Millivolts,
    /// They let go as soon as each finger presses this much.
    pub until_grip_n: Option<Newtons>,
}

/// An electrode lifts off the skin: it hears no muscle, and more mains.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ElectrodeLift {
    /// When.
    pub at_s: Spanned<Instant>,
    /// How long.
    pub for_s: Duration,
    /// `myo_flexor` or `myo_extensor`.
    pub channel: Spanned<ChannelName>,
    /// What it picks up instead, above rest.
    pub pickup_mv: Millivolts,
}

/// What a broken sensor does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaultKind {
    /// 0 V: a cut wire, a lost supply.
    Dead,
    /// The supply: a short.
    Saturated,
    /// The voltage of that instant, for ever, without noise: a converter input or a switch that latched up.
    Stuck,
    /// A quadrant of the force sensor with `press_n` on it that nobody put there: a bent finger cover.
    Pressed,
}

/// A sensor breaks.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorFault {
    /// When. 0 is before the hand is switched on.
    pub at_s: Spanned<Instant>,
    /// When it works again; never without it.
    pub until_s: Option<Spanned<Instant>>,
    /// Which.
    pub channel: Spanned<ChannelName>,
    /// How.
    pub kind: FaultKind,
    /// The force of `pressed`.
    pub press_n: Option<Spanned<Newtons>>,
    /// The physical reason.
    pub reason: String,
}

/// What somebody types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CommandKind {
    /// A stroke begins.
    StrokeBegin,
    /// A stroke ends.
    StrokeEnd,
    /// The force sensor is zeroed.
    Zero,
    /// The hand is closed with `duty_permille` for `for_s`.
    Close,
    /// The hand is opened, likewise.
    Open,
    /// S1 is set to `value`, mV.
    SetS1Mv,
    /// S2 is set to `value`, per mille.
    SetS2Permille,
    /// The threshold of the myosensors is set to `value`, mV.
    SetMyoOnMv,
    /// The force ceiling is set to `value`, mN.
    SetForceCeilingMn,
}

/// A command over the serial line.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Command {
    /// When.
    pub at_s: Spanned<Instant>,
    /// What.
    pub kind: Spanned<CommandKind>,
    /// Of a setting, in the unit that the kind names.
    pub value: Option<Spanned<u32>>,
    /// Of a drive.
    pub duty_permille: Option<Spanned<u16>>,
    /// Of a drive: how long the key is held.
    pub for_s: Option<Duration>,
}
