//! Modes and causes as a person reads them.

use core::fmt;

use super::{Cause, GripMode};

impl GripMode {
    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Standby => "standby",
            Self::Wearer => "wearer",
            Self::Watch => "watch",
            Self::Slip => "slip",
            Self::Incipient => "incipient slip",
            Self::Settle => "settle",
        }
    }
}

impl fmt::Display for GripMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::SensorsReady => "every sensor that the reflex needs gives readings",
            Self::SensorsLost => "a sensor that the reflex needs gives none",
            Self::TakenOver => "somebody else moves the hand",
            Self::Released => "nobody else moves the hand any more",
            Self::Slip(id) => return write!(f, "{} reports slip", id.name()),
            Self::Incipient(id) => return write!(f, "{} warns of slip", id.name()),
            Self::PulseOver => "the pulse is over",
            Self::Settled => "the object has settled",
        })
    }
}
