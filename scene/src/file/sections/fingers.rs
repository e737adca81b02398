//! Several fingertips around one object.

use serde::Deserialize;

use crate::file::quantity::{Direction, Duration, Instant, Milliseconds, Newtons};

/// A hand of two to five fingertips, each with a motor of its own.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fingers {
    /// When whatever the object stands on is taken away, within half a second.
    pub lift_s: Instant,
    pub finger: Vec<Finger>,
    /// The hand turns, so that the object leans on its fingers.
    #[serde(default)]
    pub tilt: Vec<Tilt>,
    /// Somebody pulls the object aside, in the plane of the grip.
    #[serde(default)]
    pub drag: Vec<Drag>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Finger {
    /// Where it stands around the object.
    pub at_deg: Direction,
    /// Whether a `[[wet]]` of the scene is under it.
    #[serde(default)]
    pub wet: bool,
}

/// A turn of the hand.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tilt {
    pub at_s: Instant,
    pub for_s: Duration,
    /// By how much, on top of the turns before. The object leans towards 0 degrees.
    pub by_deg: Direction,
}

/// A pull aside.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    pub at_s: Instant,
    pub for_s: Duration,
    /// How long it takes to come and to go.
    pub ramp_ms: Milliseconds,
    pub force_n: Newtons,
    pub to_deg: Direction,
}
