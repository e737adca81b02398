//! Who carries the hand: the wearer's arm, or a robot's.

use std::num::NonZeroU8;

use serde::Deserialize;
use toml::Spanned;

use crate::file::quantity::{
    Acceleration, Damping, Duration, Height, Hertz, Instant, Kilograms, Milliseconds, Newtons, Stiffness,
    Velocity,
};

/// Who carries the hand over an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Arm {
    /// A person, who slows as they feel the table carry the object; sliding over what still stands there is no slip.
    #[default]
    Person,
    /// A robot, which goes on; the fingers may slip along an object on the table, and that is slip (Tada 2006, figure 5).
    Robot,
}

impl Arm {
    /// The part of the object's weight on the table that it feels.
    pub(crate) const fn felt(self, table_part: f64) -> f64 {
        match self {
            Self::Person => table_part,
            Self::Robot => 0.0,
        }
    }
}

/// The arm lifts or lowers the hand.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Move {
    pub at_s: Spanned<Instant>,
    pub for_s: Duration,
    /// To this height over where the hand grasped.
    pub to_mm: Height,
}

/// The arm swings the hand up and down.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Swing {
    pub at_s: Spanned<Instant>,
    pub cycles: NonZeroU8,
    pub rate_hz: Hertz,
    /// Acceleration of the strongest.
    pub peak_m_s2: Acceleration,
}

/// The robot that strokes a probe over a surface.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Robot {
    pub probe_kg: Kilograms,
    /// Compliance of the arm along the stroke.
    pub stiffness_n_per_mm: Stiffness,
    pub damping: Damping,
    /// How long load and speed take to come and to go.
    pub ramp_ms: Milliseconds,
}

/// The robot presses the probe on the surface.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Press {
    pub at_s: Spanned<Instant>,
    /// Until it is gone.
    pub for_s: Duration,
    pub load_n: Newtons,
}

/// The robot moves its carriage.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    pub at_s: Spanned<Instant>,
    pub for_s: Duration,
    /// How fast; negative is back.
    pub speed_mm_s: Velocity,
}
