//! Who carries the hand: the wearer's arm, or a robot's.

use std::num::NonZeroU8;

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{
    Acceleration, Damping, Duration, Height, Hertz, Instant, Kilograms, Milliseconds, Newtons, Stiffness,
    Velocity,
};

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
