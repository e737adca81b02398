//! An object or a surface, the fingers on it, and the arm that carries them.

use std::num::NonZeroU8;

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{
    Acceleration, Damping, DeadTime, Duration, Height, Hertz, Instant, Kilograms, KilogramsAdded, Lever,
    Millimetres, Milliseconds, Mu, Newtons, NewtonsMax, Part, Play, Pulling, Speed, Stiffness, Velocity,
};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// Rigid Coulomb friction.
    #[default]
    L0,
    L1,
    L2,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    #[serde(default)]
    pub level: Level,
    pub mu_s: Mu,
    /// Dynamic friction, at most `mu_s`.
    pub mu_d: Spanned<Mu>,
    pub pad_length_mm: Millimetres,
    pub pitch_mm: Millimetres,
    pub mu_per_decade: Option<Spanned<Part>>,
    #[serde(default = "Contact::default_radius_mm")]
    pub patch_radius_mm: Millimetres,
    pub skin_n_per_mm: Option<Spanned<Stiffness>>,
    pub skin_ms: Option<Spanned<Milliseconds>>,
    pub stribeck_mm_s: Option<Spanned<Speed>>,
}

impl Contact {
    /// Assumed: a thumb's width of flattened rubber.
    const fn default_radius_mm() -> Millimetres {
        Millimetres::of(5.0)
    }

    pub fn skin_n_per_mm(&self) -> Stiffness {
        // The finger on the friction rig has 1.9 N/mm (`scenes/rig.toml`); silicone rubber is taken as the same.
        self.skin_n_per_mm.as_ref().map_or(Stiffness::of(2.0), |skin| *skin.get_ref())
    }

    pub fn skin_ms(&self) -> Milliseconds {
        // Assumed: rubber that rings once.
        self.skin_ms.as_ref().map_or(Milliseconds::of(3.0), |skin| *skin.get_ref())
    }

    pub fn mu_per_decade(&self) -> f64 {
        self.mu_per_decade.as_ref().map_or(0.0, |part| part.get_ref().get())
    }

    pub fn stribeck_mm_s(&self) -> Speed {
        // Assumed, as the strip's in `physics::stribeck`.
        self.stribeck_mm_s.as_ref().map_or(Speed::of(3.0), |speed| *speed.get_ref())
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wet {
    pub at_s: Spanned<Instant>,
    pub until_s: Option<Spanned<Instant>>,
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
#[serde(deny_unknown_fields, default)]
pub struct Table {
    pub mat_n_per_mm: Stiffness,
    pub damping: Damping,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fill {
    pub at_s: Spanned<Instant>,
    pub for_s: Duration,
    pub add_kg: Spanned<KilogramsAdded>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Gripper {
    pub speed_mm_s: Speed,
    pub force_n: NewtonsMax,
    pub dead_time_ms: DeadTime,
    pub range_mm: Millimetres,
    pub opening_mm: Spanned<Millimetres>,
    /// The least change of the opening, of a position-controlled gripper; 0 is none.
    pub step_mm: Play,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Arm {
    #[default]
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
    pub at_s: Spanned<Instant>,
    pub for_s: Duration,
    pub to_mm: Height,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Swing {
    pub at_s: Spanned<Instant>,
    pub cycles: NonZeroU8,
    pub rate_hz: Hertz,
    pub peak_m_s2: Acceleration,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Robot {
    pub probe_kg: Kilograms,
    pub stiffness_n_per_mm: Stiffness,
    pub damping: Damping,
    pub ramp_ms: Milliseconds,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Press {
    pub at_s: Spanned<Instant>,
    pub for_s: Duration,
    pub load_n: Newtons,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    pub at_s: Spanned<Instant>,
    pub for_s: Duration,
    pub speed_mm_s: Velocity,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pull {
    pub at_s: Spanned<Instant>,
    pub for_s: Duration,
    pub force_n: Pulling,
    pub ramp_ms: Milliseconds,
    #[serde(default)]
    pub takes: bool,
}
