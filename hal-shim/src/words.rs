//! The states, causes and faults that the fingertip, the wire and a person watching call by the same names.
//!
//! New ones are added at the end: their place is their number on the wire.

mod spoken;

use core::cmp::Ordering;

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use crate::detector::DetectorId;

/// What the grip reflex is doing (Prosthesis, figure 9).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum GripMode {
    /// Something that the reflex cannot do without is missing (at boot: not yet seen). It commands nothing; the wearer
    /// still drives the hand.
    #[default]
    Standby,
    /// A myosensor is active, a drive command holds, or a behaviour expects slip and answers it itself: the hand is theirs,
    /// the reflex commands nothing.
    Wearer,
    /// Nobody else drives the hand: vibration and Ft/Fn are watched.
    Watch,
    /// Vibration passed S1: the object slips, the hand closes.
    Slip,
    /// Ft/Fn passed S2: it is about to slip, the hand tightens.
    Incipient,
    /// After closing: the object settles in the grasp, and what the films hear of that is not slip.
    Settle,
}

/// Why the mode changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Cause {
    /// Every sensor that the reflex needs gives readings.
    SensorsReady,
    /// One that it needs does not.
    SensorsLost,
    /// A myosensor became active, a drive command came, or a behaviour answers slip itself.
    TakenOver,
    /// None of that any more.
    Released,
    /// This detector says that the object slips.
    Slip(DetectorId),
    /// This one warns that it is about to.
    Incipient(DetectorId),
    /// The closing pulse is over, or the force ceiling is reached.
    PulseOver,
    /// The object has settled.
    Settled,
}

/// Why a sensor gives no number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Reason {
    /// Below its live zero: a cut wire, a lost supply.
    Dead,
    /// Against the upper end of its range: a short, or loaded beyond what it can tell.
    Saturated,
    /// The same code for longer than the noise of any working sensor allows.
    Stuck,
    /// Loud by itself, again and again, while its neighbours are quiet: hum, a bad contact, a crack.
    Noisy,
    /// A myosensor without contact: no number, far below the wearer's rest, or as restless as a loose electrode.
    NoContact,
    /// A myosensor's envelope stands still and mains is in it.
    Hum,
    /// It climbs or sinks without a cause: a myosensor's envelope, or a quadrant of the force sensor against the other three.
    Creep,
    /// A myosensor's envelope stands still, as none of a muscle does.
    Flat,
    /// A myosensor has been active for longer than anybody keeps up.
    Endless,
}

/// What the fingertip can no longer do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Capability {
    /// Feel vibration: S1.
    Vibration,
    /// Measure force: S2, and the force ceiling.
    Force,
    /// Know that the wearer's muscles are at rest: the whole reflex.
    WearerIntent,
}

/// Who drives the motor in a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum DriveSource {
    /// Nobody: the motor is not driven.
    #[default]
    Nobody,
    /// The wearer's muscles.
    Wearer,
    /// A drive command from the serial line.
    Link,
    /// The slip reflex.
    Reflex,
    /// A behaviour: [`behaviour`](crate::behaviour).
    Behaviour,
}

/// What went wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Fault {
    /// A sensor gives no number any more.
    SensorLost {
        /// Index in [`CHANNELS`](crate::channel::CHANNELS).
        channel: u8,
        /// Why.
        reason: Reason,
    },
    /// A lost sensor gives numbers again.
    SensorBack {
        /// Index in [`CHANNELS`](crate::channel::CHANNELS).
        channel: u8,
    },
    /// Too few sensors are left for this.
    CapabilityLost(Capability),
    /// Enough of them are back.
    CapabilityBack(Capability),
    /// Frames were lost: the converter or its DMA fell behind and was restarted.
    FramesLost {
        /// How many.
        count: u32,
    },
    /// The last run ended with the watchdog's reset.
    WatchdogReset,
    /// The last run ended in a panic.
    PanicReset,
    /// The force sensor was loaded when the hand was switched on. Its readings still count from the calibrated zero,
    /// which is never taken by itself, but whoever relies on them should know.
    PressedAtBoot {
        /// Index in [`CHANNELS`](crate::channel::CHANNELS).
        channel: u8,
    },
    /// The newest record of this is damaged, or power was lost while it was saved. The one before is used, or the default.
    RecordDamaged(Kept),
    /// There is no room to save this. The next start makes room; until then the hand works on and forgets.
    StoreFull(Kept),
    /// The flash did not take this: it is worn, or protected.
    StoreFailed(Kept),
    /// The supply fell below what the chip needs, and it was reset.
    SupplySagged,
    /// The crystal stopped, or does not start: the board runs on the chip's own oscillator, a per cent too fast or too slow. The
    /// serial line may not be understood.
    CrystalLost,
    /// It has restarted too often in a row: nothing moves before it is switched off and on.
    TooManyRestarts,
    /// The hand is surely open, and the force sensor still reads a load that is no offset: nothing is ever known to be unloaded.
    /// What is learned from an empty hand stays unknown, and nobody consents by switching on.
    NeverUnloaded,
}

/// Why the motor is not driven although somebody asks for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum MotorStop {
    /// It stalled as it closed the hand. It may open it.
    ClosingStalled,
    /// It stalled as it opened the hand: at its stop, or the gear is jammed. To be asked for again, it is tried again.
    OpeningStalled,
    /// It has carried too much current for too long: it closes no further before it has cooled. It may open the hand.
    Hot,
    /// The bridge has switched itself off and says so: a short, too hot, or too low a supply of its own.
    BridgeOff,
}

impl MotorStop {
    /// For a person.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ClosingStalled => "it stalled as it closed",
            Self::OpeningStalled => "it stalled as it opened",
            Self::Hot => "it is hot; it does not close",
            Self::BridgeOff => "its bridge reports a fault",
        }
    }
}

/// What a teacher says about one output of the network (Tada 2006, equations 1 and 2).
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
    /// -1, 0 or 1.
    #[must_use]
    pub const fn sign(self) -> i32 {
        match self {
            Self::Minus => -1,
            Self::Zero => 0,
            Self::Plus => 1,
        }
    }

    /// From any number's sign.
    #[must_use]
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

/// Why the network has nothing to learn at the moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum NoLesson {
    /// No teacher, or it has said less than it takes to believe it.
    Absent,
    /// Its last picture is too old.
    Late,
    /// It has said opposite things in a short time, or that the hand moves while nothing does.
    Contradicting,
    /// It says that neither hand nor object moves.
    NothingMoves,
    /// Nothing is held.
    NoGrasp,
    /// The receptors feel something else: the reflex or the wearer moves the hand, or something strikes it.
    Disturbed,
}

/// How somebody at the hand consents to what the serial line may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Consent {
    /// Switched on with a finger that is known to hold nothing.
    PowerUp,
    /// Both muscles, held for two seconds.
    Muscles,
    /// The blue button.
    Button,
}

/// What the serial line may do at the moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Line {
    /// Read.
    #[default]
    Reading,
    /// Command too, by consent.
    Armed {
        /// For so long still, s.
        left_s: u8,
    },
    /// Command without consent: the setting `line-trusted-flag`.
    Trusted,
}

/// What outlives a power cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Kept {
    /// What the network learned.
    Network,
    /// The force sensor's zero.
    Zero,
    /// What was set from outside, or measured by a stroke.
    Settings,
    /// The wearer's calibration of the myosensors.
    Emg,
}

impl Kept {
    /// Every kind of record, in wire order.
    pub const ALL: [Self; 4] = [Self::Network, Self::Zero, Self::Settings, Self::Emg];
}

/// What the wearer is asked to do during the calibration of the myosensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Prompt {
    /// Relax.
    Rest,
    /// Hold the contraction that shall close the hand.
    Close,
    /// Hold the contraction that shall open it.
    Open,
}

impl Prompt {
    /// What the wearer is told.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rest => "let the arm lie and relax",
            Self::Close => "hold the contraction that shall close the hand",
            Self::Open => "hold the contraction that shall open the hand",
        }
    }
}

/// Why a calibration of the myosensors was not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum CalibrationRefusal {
    /// An envelope wandered while the wearer should rest: a contraction, a loose electrode, interference.
    RestNotQuiet,
    /// Closing did not stand out from rest.
    NoClosing,
    /// Opening did not stand out from rest.
    NoOpening,
    /// Both contractions drive the electrodes in the same proportion.
    SameDirection,
    /// The states differ, but by less than they fluctuate.
    Overlap,
    /// An envelope stood still during a contraction, as none of a muscle does.
    NotAMuscle,
    /// An envelope was at the top of its range.
    Saturated,
    /// A sensor gave no number.
    SensorLost,
    /// The words are not those of a model.
    Damaged,
    /// The hand came to hold something, or its force sensor gave no number, and whoever holds something must be able to let it go.
    Loaded,
    /// Somebody pressed the button again.
    Stopped,
}

impl CalibrationRefusal {
    /// What the wearer is told.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Loaded => "something was held, or may have been",
            Self::Stopped => "the button stopped it",
            Self::RestNotQuiet => "rest was not quiet",
            Self::NoClosing => "closing did not stand out from rest",
            Self::NoOpening => "opening did not stand out from rest",
            Self::SameDirection => "both contractions drive the electrodes alike",
            Self::Overlap => "the contractions fluctuate more than they differ",
            Self::NotAMuscle => "an envelope stood still during a contraction",
            Self::Saturated => "an envelope was at the top of its range",
            Self::SensorLost => "a myosensor gave no number",
            Self::Damaged => "what was kept is not a calibration",
        }
    }
}

impl core::fmt::Display for CalibrationRefusal {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name())
    }
}

/// Whether what the electrodes do still fits the calibration of the myosensors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Fit {
    /// It does, or is not known not to.
    #[default]
    Fits,
    /// It does not: the electrodes have moved, or the wearer contracts otherwise. They shall calibrate anew.
    Moved,
    /// The contractions are those that were calibrated with the electrodes exchanged.
    Exchanged,
}

impl Fit {
    /// For a person.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fits => "it fits what the electrodes do",
            Self::Moved => "it does not fit what the electrodes do; calibrate anew",
            Self::Exchanged => "the electrodes look exchanged; exchange their plugs, or calibrate anew",
        }
    }
}

/// How the calibration of the myosensors goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
pub enum Calibration {
    /// The wearer shall do this for the next 5 s.
    Asks(Prompt),
    /// It is in force.
    Done {
        /// The smallest distance of two of the three states, in thousandths of their common standard deviation.
        separation_permille: i32,
    },
    /// It is not, and what was in force before still is.
    Refused(CalibrationRefusal),
    /// What is in force fits what the electrodes do, or not any more: told when it changes.
    Fit(Fit),
}
