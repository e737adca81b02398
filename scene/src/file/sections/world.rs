//! An object or a surface, the fingers on it, and the arm that carries them.

use std::num::NonZeroU8;

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{
    Acceleration, Damping, DeadTime, Duration, Height, Hertz, Instant, Kilograms, KilogramsAdded, Lever,
    Millimetres, Milliseconds, Mu, Newtons, NewtonsMax, Part, Play, Pulling, Speed, Stiffness, Velocity,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// Rigid Coulomb friction.
    L0,
    /// A patch of bristles.
    L1,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
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

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wet {
    pub at_s: Instant,
    pub until_s: Option<Instant>,
    pub ramp_ms: Milliseconds,
    pub mu_s: Mu,
    /// Dynamic friction while it lasts, at most `mu_s`.
    pub mu_d: Spanned<Mu>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Object {
    pub mass_kg: Kilograms,
    pub width_mm: Millimetres,
    pub stiffness_n_per_mm: Stiffness,
    pub crush_n: Option<Newtons>,
    pub break_n: Option<Newtons>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pitch {
    pub offset_mm: Lever,
    pub hang_mm: Lever,
    pub gyration_mm: Millimetres,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    pub mat_n_per_mm: Stiffness,
    pub damping: Damping,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fill {
    pub at_s: Instant,
    pub for_s: Duration,
    pub add_kg: Spanned<KilogramsAdded>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gripper {
    pub speed_mm_s: Speed,
    pub force_n: NewtonsMax,
    pub dead_time_ms: DeadTime,
    pub range_mm: Millimetres,
    pub opening_mm: Spanned<Millimetres>,
    /// The least change of the opening, of a position-controlled gripper; 0 is none.
    pub step_mm: Play,
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

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Move {
    pub at_s: Instant,
    pub for_s: Duration,
    pub to_mm: Height,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Swing {
    pub at_s: Instant,
    pub cycles: NonZeroU8,
    pub rate_hz: Hertz,
    pub peak_m_s2: Acceleration,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Robot {
    pub probe_kg: Kilograms,
    pub stiffness_n_per_mm: Stiffness,
    pub damping: Damping,
    pub ramp_ms: Milliseconds,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Press {
    pub at_s: Instant,
    pub for_s: Duration,
    pub load_n: Newtons,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    pub at_s: Instant,
    pub for_s: Duration,
    pub speed_mm_s: Velocity,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pull {
    pub at_s: Instant,
    pub for_s: Duration,
    pub force_n: Pulling,
    pub ramp_ms: Milliseconds,
    #[serde(default)]
    pub takes: bool,
}
