//! Names of states, causes and faults, the same in the logic, on the wire and for people.
//! New ones are added at the end: their place is their number on the wire.

use core::cmp::Ordering;
use core::fmt;

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use crate::detector::DetectorId;

/// An enum whose variants have a name for people and programs.
#[macro_export]
macro_rules! named {
    ($(#[$own:meta])* pub enum $enum:ident { $($(#[$of:meta])* $variant:ident = $name:literal,)* }) => {
        $(#[$own])*
        pub enum $enum { $($(#[$of])* $variant,)* }

        impl $enum {
            pub const ALL: [Self; [$($enum::$variant,)*].len()] = [$(Self::$variant,)*];

            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }
        }
    };
}

named! {
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
    #[cfg_attr(feature = "defmt", derive(defmt::Format))]
    pub enum GripMode {
        /// A sensor that the reflex needs is missing (at boot: not yet seen). The reflex commands nothing; the wearer still drives the hand.
        #[default]
        Standby = "standby",
        /// A myosensor is active, a drive command holds, or a behaviour answers slip itself: the reflex commands nothing.
        Wearer = "wearer",
        /// No other source drives the hand: the detectors are watched.
        Watch = "watch",
        Slip = "slip",
        /// A detector warns, such as S2: the hand closes a little.
        Incipient = "incipient slip",
        /// After closing: the object settles in the grasp, and reports are not answered.
        Settle = "settle",
    }
}

impl fmt::Display for GripMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Cause {
    SensorsReady,
    SensorsLost,
    /// A myosensor became active, a drive command came, or a behaviour answers slip itself.
    TakenOver,
    Released,
    Slip(DetectorId),
    Incipient(DetectorId),
    PulseOver,
    Settled,
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

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Reason {
    /// Below its live zero: a cut wire, a lost supply.
    Dead,
    /// Above its range: a short, or an overload.
    Saturated,
    /// The same code for longer than the noise of any working sensor allows.
    Stuck,
    /// A film that alone reports vibration again and again: hum, a bad contact, a crack.
    Noisy,
    /// A myosensor without contact: no number, far below the wearer's rest, or as restless as a loose electrode.
    NoContact,
    /// A myosensor's envelope stands still and mains is in it.
    Hum,
    /// Drift of a myosensor's envelope, or of a force sensor's quadrants: one against the others, or all upwards.
    Creep,
    /// A myosensor's envelope stands still, which no muscle's does.
    Flat,
    /// A myosensor has been active for longer than a muscle can be.
    Endless,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Capability {
    /// Feel vibration, for S1.
    Vibration,
    /// Measure force, for S2 and the force ceiling.
    Force,
    /// Know whether the wearer's muscles are at rest; without it the reflex is on standby.
    WearerIntent,
}

named! {
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
    pub enum DriveSource {
        #[default]
        Nobody = "nobody",
        Wearer = "wearer",
        Link = "link",
        Reflex = "reflex",
        Behaviour = "behaviour",
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Fault {
    SensorLost {
        channel: u8,
        reason: Reason,
    },
    SensorBack {
        channel: u8,
    },
    CapabilityLost(Capability),
    CapabilityBack(Capability),
    /// Frames were lost: the converter or its DMA fell behind and was restarted.
    FramesLost {
        count: u32,
    },
    WatchdogReset,
    PanicReset,
    /// The force sensor was loaded when the hand was switched on. Its readings still count from the calibrated zero,
    /// which the board never takes by itself.
    PressedAtBoot {
        channel: u8,
    },
    /// The newest record of this is damaged, or power was lost while it was saved. The one before is used, or the default.
    RecordDamaged(Kept),
    /// There is no room to save this. The next start makes room; until then changes are lost at power-off.
    StoreFull(Kept),
    StoreFailed(Kept),
    /// The supply fell below what the chip needs, and it was reset.
    SupplySagged,
    /// The crystal stopped, or does not start: the board runs on the chip's own oscillator, a per cent too fast or too slow. The
    /// serial line may not be understood.
    CrystalLost,
    /// The board has restarted too often in a row: until it is switched off and on, only its button drives the motor.
    TooManyRestarts,
    /// The hand is surely open, and the force sensor still reads a load that is no offset. So the hand is never known to be empty:
    /// zeros and noise floors are not learned, and there is no power-up consent.
    NeverUnloaded,
    /// The chip's brown-out level is not 3: below 2.83 V nothing resets it. An option byte, which only a probe should program.
    BrownOutLevel,
}

named! {
    /// Reason for which the motor is not driven although a source asks for it.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
    #[cfg_attr(feature = "defmt", derive(defmt::Format))]
    pub enum MotorStop {
        ClosingStalled = "it stalled as it closed",
        /// At its stop, or the gear is jammed. A new opening command is tried again.
        OpeningStalled = "it stalled as it opened",
        /// Too much current for too long: closing is stopped until the motor has cooled. Opening is allowed.
        Hot = "it is hot; it does not close",
        /// The motor bridge reports that it has switched itself off: a short, heat, or a low supply of its own.
        BridgeOff = "its bridge reports a fault",
    }
}

/// A teacher's label for one output of the network (Tada 2006, equations 1 and 2).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Code {
    /// v1: object and hand move against each other, it slips. v2: the hand moves down.
    Minus,
    /// v1: neither moves. v2: the hand does not move.
    #[default]
    Zero,
    /// v1: object and hand move as one. v2: the hand moves up.
    Plus,
}

impl Code {
    pub const fn sign(self) -> i32 {
        match self {
            Self::Minus => -1,
            Self::Zero => 0,
            Self::Plus => 1,
        }
    }

    pub fn from_sign(number: i32) -> Self {
        match number.cmp(&0) {
            Ordering::Less => Self::Minus,
            Ordering::Equal => Self::Zero,
            Ordering::Greater => Self::Plus,
        }
    }
}

/// Relative motion (v1, equation 1) and direction (v2, equation 2).
pub type Codes = [Code; 2];

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum NoLesson {
    /// No teacher, or too few codes yet.
    Absent,
    Late,
    /// The codes were opposite within a short time, or v1 says that nothing moves and v2 that the hand moves.
    Contradicting,
    /// Both codes are 0: neither hand nor object moves.
    NothingMoves,
    NoGrasp,
    /// The receptors are disturbed: the reflex or the wearer moves the hand, or an impact rings.
    Disturbed,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Consent {
    /// Switched on with a finger that is known to hold nothing.
    PowerUp,
    Muscles,
    Button,
}

/// The commands that the serial line may give at the moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Line {
    #[default]
    Reading,
    Armed {
        left_s: u8,
    },
    /// Commands without consent: the setting `line-trusted-flag`.
    Trusted,
}

named! {
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
    #[cfg_attr(feature = "defmt", derive(defmt::Format))]
    pub enum Kept {
        Network = "the network's weights",
        Zero = "the force sensor's zeros",
        Settings = "the settings",
        Emg = "the wearer's calibration",
    }
}

named! {
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
    pub enum Prompt {
        Rest = "let the arm lie and relax",
        Close = "hold the contraction that shall close the hand",
        Open = "hold the contraction that shall open the hand",
    }
}

named! {
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
    pub enum CalibrationRefusal {
        /// An envelope wandered while the wearer should rest: a contraction, a loose electrode, interference.
        RestNotQuiet = "rest was not quiet",
        NoClosing = "closing did not stand out from rest",
        NoOpening = "opening did not stand out from rest",
        SameDirection = "both contractions drive the electrodes alike",
        Overlap = "the contractions fluctuate more than they differ",
        NotAMuscle = "an envelope stood still during a contraction",
        Saturated = "an envelope was at the top of its range",
        SensorLost = "a myosensor gave no number",
        Damaged = "what was kept is not a calibration",
        /// The hand came to hold something, or its force sensor gave no number: the muscles must be able to open it.
        Loaded = "something was held, or may have been",
        Stopped = "the button stopped it",
    }
}

impl fmt::Display for CalibrationRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

named! {
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
    pub enum Fit {
        #[default]
        Fits = "it fits what the electrodes do",
        /// The electrodes have moved, or the wearer contracts differently: a new calibration is needed.
        Moved = "it does not fit what the electrodes do; calibrate anew",
        Exchanged = "the electrodes look exchanged; exchange their plugs, or calibrate anew",
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Calibration {
    Asks(Prompt),
    Done {
        /// The smallest distance of two of the three states, in thousandths of their common standard deviation.
        separation_permille: i32,
    },
    /// The calibration was refused; the one before stays in force.
    Refused(CalibrationRefusal),
    Fit(Fit),
}
