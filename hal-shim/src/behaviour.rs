//! Behaviours: movements that the line can request in addition to the reflex (FingerVision 2017, section II), and the message of
//! the camera behind a clear skin.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use crate::named;

/// A behaviour. It lasts until it ends by itself, by [`Down::End`](crate::wire::Down::End), or because a muscle becomes active.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Behaviour {
    /// The finger is stroked over a surface to measure its friction: slip is expected and not answered.
    Stroke,
    /// Close until the object is felt, and no further (section II-A).
    GentleGrasp,
    /// Close by a small movement whenever the object slips (section II-B).
    Hold,
    /// Let go as soon as the object is pulled (section II-C).
    HandOver,
    /// Turn the object in the hand by loosening and tightening the grasp (section II-D).
    Turn {
        /// By this angle, tenths of a degree, in the camera's picture.
        by_ddeg: i16,
    },
}

impl Behaviour {
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stroke => "stroke",
            Self::GentleGrasp => "gentle grasp",
            Self::Hold => "hold",
            Self::HandOver => "hand over",
            Self::Turn { .. } => "turn",
        }
    }
}

named! {
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
    pub enum Ending {
        Done = "done",
        Stopped = "stopped by command",
        TakenOver = "taken over",
        /// A needed sensor gives no valid reading, or no pictures come.
        SensorLost = "gave up: a sensor that it needs is lost",
        TooLong = "gave up: it took too long",
        Ceiling = "gave up: the force ceiling is reached",
        Dropped = "gave up: nothing is held any more",
        /// The grasp was loosened as far as allowed and nothing slipped; it is as firm as before.
        NoSlip = "gave up: nothing slipped",
        NotArmed = "gave up: the consent is over",
    }
}

pub const MARKERS: usize = 24;
/// The normal force of a marker that is not tracked.
pub const UNTRACKED: u8 = u8::MAX;
/// Resolution of a marker's normal force on the wire, mN.
pub const NORMAL_STEP_MN: i32 = 10;
/// Resolution of a marker's shear on the wire, mN.
pub const SHEAR_STEP_MN: i32 = 20;

/// One picture of the camera behind the skin (FingerVision 2017, sections III and IV).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct CameraView {
    /// Age of the picture when this is sent, ms.
    pub age_ms: u16,
    /// Moving points on the object as a part of the picture's area, 1/10 000 (0 to 10 000).
    pub moving_e4: u16,
    /// The object's angle, tenths of a degree. None while it is not wholly in view.
    pub angle_ddeg: Option<i16>,
    /// Normal force of each marker, in steps of [`NORMAL_STEP_MN`]; [`UNTRACKED`] of those that are not tracked.
    pub normal: [u8; MARKERS],
    /// Shear of each marker along the finger, in steps of [`SHEAR_STEP_MN`].
    pub shear: [i8; MARKERS],
}
