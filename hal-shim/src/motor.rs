//! Drive of the motor that closes and opens the hand.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

/// The motor's mean voltage over the supply's, 0 to 1000 per mille.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, Schema)]
#[serde(from = "u16", into = "u16")]
pub struct Duty(u16);

impl Duty {
    pub const FULL: Self = Self(1_000);

    /// A duty in per mille of full motor voltage; more than 1000 counts as 1000.
    pub const fn per_mille(value: u16) -> Self {
        Self(if value > 1_000 { 1_000 } else { value })
    }

    pub const fn as_per_mille(self) -> u16 {
        self.0
    }
}

impl From<u16> for Duty {
    fn from(value: u16) -> Self {
        Self::per_mille(value)
    }
}

impl From<Duty> for u16 {
    fn from(duty: Duty) -> Self {
        duty.0
    }
}

/// Drive of the motor for the next 0.5 ms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum MotorDrive {
    /// Not driven. The gear does not run backwards, so the hand keeps what it holds.
    #[default]
    Coast,
    Close(Duty),
    Open(Duty),
}

impl MotorDrive {
    /// 0 to 1000.
    pub const fn permille(self) -> u16 {
        match self {
            Self::Close(duty) | Self::Open(duty) => duty.as_per_mille(),
            Self::Coast => 0,
        }
    }

    /// -1000 (opens) to 1000 (closes).
    pub const fn signed_permille(self) -> i16 {
        if self.opens() { -(self.permille() as i16) } else { self.permille() as i16 }
    }

    pub const fn opens(self) -> bool {
        matches!(self, Self::Open(_))
    }

    pub const fn closes(self) -> bool {
        matches!(self, Self::Close(_))
    }
}

/// A board's motor bridge. An implementation guarantees:
/// - [`drive`](Self::drive) takes effect at once and never blocks; no state between two drives drives another way than either;
/// - the motor's mean voltage is the duty's: between pulses it is short-circuited, not left to coast;
/// - before the first call, after [`MotorDrive::Coast`] or a duty of 0, and after a panic or a reset by the watchdog, neither side
///   is driven.
pub trait MotorBridge {
    fn drive(&mut self, drive: MotorDrive);
}
