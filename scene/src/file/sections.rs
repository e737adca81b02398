//! One struct for each kind of table of a scene file.
//! `docs/scenes.md` explains every key; `defaults.toml` has the defaults with their sources.

use std::num::NonZeroU8;

use serde::Deserialize;
use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::channel::FSR_COUNT;
use tenax_logic::setting::SettingId;
use toml::Spanned;

use super::quantity::{
    Acceleration, ChannelName, Damping, DeadTime, Degrees, Drift, Duration, Gain, Height, Hertz, Instant,
    Kilograms, KilogramsAdded, Lever, Micrometres, Millimetres, Millinewtons, Milliseconds, Millivolts, Mu,
    Newtons, NewtonsMax, Part, Play, Pulling, RingHertz, Speed, Stiffness, Velocity,
};

/// A table's struct refuses keys that it does not have.
macro_rules! tables {
    ($($(#[$own:meta])* pub struct $name:ident { $($fields:tt)* })*) => {$(
        $(#[$own])*
        #[derive(Clone, Debug, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name { $($fields)* }
    )*};
}

tables! {
    pub struct Contact {
        pub level: Level,
        pub mu_s: Mu,
        /// Dynamic friction, at most `mu_s`.
        pub mu_d: Spanned<Mu>,
        pub pad_length_mm: Millimetres,
        pub pitch_mm: Millimetres,
        pub mu_per_decade: Part,
        pub patch_radius_mm: Millimetres,
        /// Stiffness and damping of a patch (`l1`).
        pub skin_n_per_mm: Stiffness,
        pub skin_ms: Milliseconds,
    }

    pub struct Wet {
        pub at_s: Instant,
        pub until_s: Option<Instant>,
        pub ramp_ms: Milliseconds,
        pub mu_s: Mu,
        pub mu_d: Spanned<Mu>,
    }

    pub struct Object {
        pub mass_kg: Kilograms,
        pub width_mm: Millimetres,
        pub stiffness_n_per_mm: Stiffness,
        pub crush_n: Option<Newtons>,
        pub break_n: Option<Newtons>,
    }

    pub struct Pitch {
        pub offset_mm: Lever,
        pub hang_mm: Lever,
        pub gyration_mm: Millimetres,
    }

    pub struct Table {
        pub mat_n_per_mm: Stiffness,
        pub damping: Damping,
    }

    pub struct Fill {
        pub at_s: Instant,
        pub for_s: Duration,
        pub add_kg: Spanned<KilogramsAdded>,
    }

    pub struct Gripper {
        pub speed_mm_s: Speed,
        pub force_n: NewtonsMax,
        pub dead_time_ms: DeadTime,
        pub range_mm: Millimetres,
        pub opening_mm: Spanned<Millimetres>,
        /// The least change of the opening, of a position-controlled gripper; 0 is none.
        pub step_mm: Play,
    }

    pub struct Move {
        pub at_s: Instant,
        pub for_s: Duration,
        pub to_mm: Height,
    }

    pub struct Swing {
        pub at_s: Instant,
        pub cycles: NonZeroU8,
        pub rate_hz: Hertz,
        pub peak_m_s2: Acceleration,
    }

    pub struct Robot {
        pub probe_kg: Kilograms,
        pub stiffness_n_per_mm: Stiffness,
        pub damping: Damping,
        pub ramp_ms: Milliseconds,
    }

    pub struct Press {
        pub at_s: Instant,
        pub for_s: Duration,
        pub load_n: Newtons,
    }

    pub struct Sweep {
        pub at_s: Instant,
        pub for_s: Duration,
        pub speed_mm_s: Velocity,
    }

    pub struct Pull {
        pub at_s: Instant,
        pub for_s: Duration,
        pub force_n: Pulling,
        pub ramp_ms: Milliseconds,
        #[serde(default)]
        pub takes: bool,
    }

    /// The PVDF films. Voltages are at the film; the front end multiplies them by `gain`.
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

    pub struct Myo {
        /// Rise of the envelope from 10 to 90 %.
        pub rise_ms: Milliseconds,
        pub tone_mv: Millivolts,
        pub noise_mv: Millivolts,
        /// Wandering of a contraction, rms, as a part of it.
        pub ripple: Part,
        pub crosstalk: Part,
        pub mains_mv: Millivolts,
    }

    pub struct Strain {
        pub normal_mv_per_n: Gain,
        pub shear_mv_per_n: Gain,
        pub spread: Part,
        pub offset_mv: Millivolts,
        pub drift_mv_per_min: Millivolts,
        pub creep: Part,
        pub creep_s: Duration,
        pub noise_mv: Millivolts,
    }

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
        pub noise_mv: Millivolts,
    }

    /// The camera behind a clear skin, as the summary that its computer sends.
    pub struct Skin {
        pub rate_hz: Hertz,
        pub delay_ms: DeadTime,
        pub force_noise_mn: Millinewtons,
        pub angle_noise_deg: Degrees,
        /// Points that move though nothing does, rms, in 1/10,000 of the picture.
        pub speckle_e4: Gain,
        pub wrong_part: Part,
        pub wrong_pictures: Gain,
        pub dark_from_s: Option<Instant>,
    }

    pub struct Camera {
        pub pixel_mm: Millimetres,
        pub rate_hz: Hertz,
        pub jitter_px: Part,
        pub delay_ms: DeadTime,
        pub teaches: bool,
    }

    /// A photoelastic head in the place of PVDF film 12 (Dubey 2006). The board has to be told: `head-photoelastic-flag`.
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
        pub ambient_mv: Millivolts,
        pub knock_mn_per_mv: Gain,
        pub noise_mv: Millivolts,
    }

    pub struct Muscle {
        pub at_s: Instant,
        pub for_s: Duration,
        pub intent: Intent,
        pub level_mv: Millivolts,
        pub until_grip_n: Option<Newtons>,
    }

    pub struct Command {
        pub at_s: Instant,
        pub kind: Spanned<CommandKind>,
        pub value: Option<Spanned<i32>>,
        pub duty_permille: Option<Spanned<u16>>,
        pub for_s: Option<Duration>,
    }

    pub struct Knock {
        pub at_s: Instant,
        pub peak_mv: Millivolts,
        pub ring_hz: RingHertz,
        pub decay_ms: Milliseconds,
        #[serde(default = "Knock::alike")]
        pub uneven: Part,
    }

    pub struct Hum {
        pub at_s: Instant,
        pub for_s: Duration,
        pub peak_mv: Millivolts,
        pub hum_hz: Hertz,
    }

    /// The motor that tells the wearer by vibrating, and how much of it the films hear. There is none that they hear without this table.
    pub struct Vibrator {
        pub film_mv: Millivolts,
        pub full_hz: Hertz,
        pub spin_ms: Milliseconds,
    }

    /// An electrode lifts off the skin: it hears no muscle, and more mains.
    pub struct ElectrodeLift {
        pub at_s: Instant,
        pub for_s: Duration,
        pub channel: Spanned<ChannelName>,
        pub pickup_mv: Millivolts,
    }

    /// Something between the gear's teeth: the motor is blocked, the fingers stand still.
    pub struct Jam {
        pub at_s: Instant,
        pub for_s: Duration,
    }

    pub struct SensorFault {
        /// 0 is before the hand is switched on.
        pub at_s: Instant,
        pub until_s: Option<Instant>,
        pub channel: Spanned<ChannelName>,
        pub kind: FaultKind,
        pub press_n: Option<Spanned<Newtons>>,
        /// N/s for a quadrant of the force sensor, mV/s at the pin for any other channel.
        pub drift_per_s: Option<Spanned<Drift>>,
        pub with: Option<Spanned<ChannelName>>,
        #[expect(dead_code, reason = "it explains the file to its reader")]
        pub reason: String,
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    L0,
    L1,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Arm {
    Person,
    /// A robot, which goes on; the fingers may slip along an object on the table, and that is slip (Tada 2006, figure 5).
    Robot,
}

impl Arm {
    pub(crate) const fn felt(self, table_part: f64) -> f64 {
        match self {
            Self::Person => table_part,
            Self::Robot => 0.0,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Intent {
    Close,
    Open,
    Both,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub enum CommandKind {
    Begin(Behaviour),
    End,
    Zero,
    Close,
    Open,
    Consent,
    Set(SettingId),
}

impl TryFrom<String> for CommandKind {
    type Error = String;

    fn try_from(kind: String) -> Result<Self, String> {
        let setting = || {
            let name = kind.strip_prefix("set-")?;
            SettingId::by_name(name).map(Self::Set)
        };
        Ok(match kind.as_str() {
            "stroke-begin" => Self::Begin(Behaviour::Stroke),
            "grasp-gently" => Self::Begin(Behaviour::GentleGrasp),
            "hold" => Self::Begin(Behaviour::Hold),
            "hand-over" => Self::Begin(Behaviour::HandOver),
            "turn" => Self::Begin(Behaviour::Turn { by_ddeg: 0 }),
            "stroke-end" | "end" => Self::End,
            "zero" => Self::Zero,
            "close" => Self::Close,
            "open" => Self::Open,
            "consent" => Self::Consent,
            _ => setting().ok_or_else(|| {
                let settings = SettingId::ALL.map(|id| format!("set-{}", id.row().name)).join(", ");
                format!(
                    "kind = \"{kind}\" is no command; allowed: stroke-begin, stroke-end, grasp-gently, hold, \
                     hand-over, turn, end, zero, close, open, consent, {settings}"
                )
            })?,
        })
    }
}

impl Knock {
    const fn alike() -> Part {
        Part::of(0.0)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FaultKind {
    /// 0 V: a lost supply.
    Dead,
    /// Cut wire. Before a switch (100 kohm, 1 uF) the voltage falls; a film's amplifier loses its bias.
    Cut,
    /// Cut wire without the resistor: the switch keeps the charge of the input shown before.
    Open,
    /// Short to the supply.
    Saturated,
    /// The voltage of that instant without noise: an input that latched up.
    Stuck,
    /// `press_n` on a quadrant of the force sensor: a bent finger cover.
    Pressed,
    /// A reading that runs away by `drift_per_s`: a cell that creeps or warms, an amplifier whose offset wanders.
    Drift,
    Swapped,
    Bridged,
}
