//! The settings: every number of the fingertip that a person may choose, one row each.
//!
//! The table drives the wire (set, get, list), the flash, scene files, the command line and `docs/settings.md`. A new
//! setting is a row here and an arm in `tenax_logic::config::Config`, which the compiler asks for.

use core::ops::RangeInclusive;

/// What a person needs to know of a setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// What it is called on the command line and in scene files. It ends with the unit.
    pub name: &'static str,
    /// A name that it had before and that scene files may still use.
    pub was: Option<&'static str>,
    /// Its unit, for a person.
    pub unit: &'static str,
    /// The lowest value that is accepted.
    pub min: i32,
    /// The highest: no combination of values in this range crushes, opens or deafens.
    pub max: i32,
    /// The highest where the line is trusted, for a laboratory: a detector may be silenced there.
    pub max_if_trusted: i32,
    /// Its value until somebody changes it.
    pub default: i32,
    /// What it does.
    pub meaning: &'static str,
}

impl Row {
    /// The values that are accepted.
    #[must_use]
    pub const fn range(&self) -> RangeInclusive<i32> {
        self.min..=self.max
    }

    /// The values that are accepted where the line is trusted.
    #[must_use]
    pub const fn range_if_trusted(&self) -> RangeInclusive<i32> {
        self.min..=self.max_if_trusted
    }
}

/// Makes the enum and the table out of the same rows.
macro_rules! settings {
    ($($(#[doc = $meaning:literal])+ $number:literal $id:ident $name:literal $(($was:literal))? $unit:literal
        [$min:literal, $max:literal $(, trusted $trusted:literal)?] = $default:literal;)+) => {
        /// A setting. Its number is what the wire and the flash call it; numbers are never given twice.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u8)]
        pub enum SettingId {
            $($(#[doc = $meaning])+ $id = $number,)+
        }

        impl SettingId {
            /// Every setting, in the order of the table.
            pub const ALL: [Self; [$($number),+].len()] = [$(Self::$id),+];

            /// Its row of the table.
            #[must_use]
            pub const fn row(self) -> Row {
                match self {
                    $(Self::$id => Row {
                        name: $name,
                        was: settings!(@was $($was)?),
                        unit: $unit,
                        min: $min,
                        max: $max,
                        max_if_trusted: settings!(@max $max $(, $trusted)?),
                        default: $default,
                        meaning: concat!($($meaning),+).trim_ascii(),
                    },)+
                }
            }
        }
    };
    (@max $max:literal) => { $max };
    (@max $max:literal, $trusted:literal) => { $trusted };
    (@was) => { None };
    (@was $was:literal) => { Some($was) };
}

settings! {
    /// S1: vibration envelope of a PVDF channel that means slip
    1 S1 "s1-mv" "mV" [20, 250, trusted 1_500] = 100;
    /// S2: Ft/Fn that means incipient slip, until a stroke measures it
    2 S2 "s2-permille" "per mille" [150, 900, trusted 1_500] = 300;
    /// EMG envelope above rest that both muscles have to reach to consent. When a muscle is active, its calibration says
    3 EmgOn "emg-on-mv" ("myo-on-mv") "mV" [80, 400] = 160;
    /// Normal force above which the reflex closes no further
    4 ForceCeiling "force-ceiling-mn" "mN" [3_000, 60_000] = 40_000;
    /// Hebbian: how far below 0 the PVDF part of o1 means slip
    5 HebbianSlip "hebbian-slip-permille" ("network-slip-permille") "per mille" [10, 1_000] = 100;
    /// Vibration above the slip band that a knock has at least
    6 KnockLevel "knock-level-mv" "mV" [10, 300] = 20;
    /// A vibration with more than this part of its envelope above the slip band is a knock
    7 KnockRatio "knock-ratio-permille" "per mille" [300, 3_000] = 500;
    /// A knock is over after this long; what lasts longer is slip
    8 KnockLength "knock-ms" "ms" [5, 100] = 45;
    /// The part of a measured static friction that becomes S2
    9 S2OfMuS "s2-of-mu-s-permille" "per mille" [300, 950] = 800;
    /// Normal force from which the finger counts as loaded
    10 Loaded "loaded-mn" "mN" [300, 2_000] = 600;
    /// Hebbian: how long o1 must mean slip if only some PVDF channels show it
    11 HebbianTime "hebbian-ms" "ms" [1, 100] = 15;
    /// Hebbian: how long if all PVDF channels show it, longer than a knock
    12 HebbianEverywhere "hebbian-everywhere-ms" "ms" [1, 500] = 40;
    /// Hebbian: how long after a knock or a fast run of the motor it is not evaluated
    13 HebbianAfterNoise "hebbian-after-noise-ms" "ms" [0, 1_000] = 100;
    /// Motor duty from which its noise disturbs the Hebbian detector
    14 NoisyDuty "noisy-duty-permille" "per mille" [10, 1_000] = 100;
    /// Age of a teacher's picture beyond which it teaches nothing
    15 TeacherFresh "teacher-fresh-ms" "ms" [40, 1_000] = 120;
    /// Hebbian: learning rate alpha of one update (Tada 2006, equation 5)
    16 HebbianAlpha "hebbian-alpha-ppb" "ppb" [0, 16_000_000] = 50_000;
    /// Hebbian: forgetting rate beta of one update (Tada 2006, equation 5)
    17 HebbianBeta "hebbian-beta-ppb" "ppb" [0, 16_000_000] = 10_000;
    /// Hebbian: weight delta that every connection has for the variable rate (Tada 2006, equation 6)
    18 HebbianDelta "hebbian-delta-ppm" "ppm" [1_000, 8_000_000] = 300_000;
    /// How long a muscle counts as active after its last activity
    20 EmgHold "emg-hold-ms" "ms" [100, 1_000] = 200;
    /// Motor duty that the weakest contraction asks for that moves the hand
    22 EmgSlowest "emg-slowest-permille" "per mille" [200, 1_000] = 300;
    /// Motor duty of the pulse that answers slip
    23 SlipDuty "slip-duty-permille" "per mille" [400, 1_000] = 1_000;
    /// Length of the pulse that answers slip
    24 SlipPulse "slip-pulse-ms" "ms" [10, 60] = 30;
    /// Its length at most while a detector still reports slip
    25 SlipPulseMax "slip-pulse-max-ms" "ms" [10, 200] = 50;
    /// Motor duty of the pulse that answers incipient slip
    26 IncipientDuty "incipient-duty-permille" "per mille" [100, 1_000] = 400;
    /// Length of the pulse that answers incipient slip
    27 IncipientPulse "incipient-pulse-ms" "ms" [5, 50] = 15;
    /// How long the object is given to settle after a pulse, longer than the motor's dead time
    28 Settle "settle-ms" "ms" [40, 150] = 80;
    /// How long the reflex may close altogether while no force is known, until a muscle takes over once
    29 Blind "blind-ms" "ms" [0, 400] = 200;
    /// 1: the serial line moves the hand without consent (a gripper on a robot). Set by muscle or button only
    40 LineTrusted "line-trusted-flag" "flag" [0, 1] = 0;
    /// 1: frames are streamed from the start on, so that a recording can be replayed bit for bit
    41 StreamAtStart "stream-at-start-flag" "flag" [0, 1] = 0;
    /// 1: no wearer, the reflex works without myosensors (a gripper on a robot). Set by muscle or button only
    42 NoWearer "no-wearer-flag" "flag" [0, 1] = 0;
    /// Behaviours: motor duty of their movements
    50 BehaviourDuty "behaviour-duty-permille" "per mille" [50, 300] = 100;
    /// Behaviours: length of a small movement
    51 BehaviourMovement "behaviour-movement-ms" "ms" [2, 50] = 10;
    /// Behaviours: how long one waits after a small movement (FingerVision 2017, section II-D)
    52 BehaviourWait "behaviour-wait-ms" "ms" [20, 500] = 100;
    /// Gentle grasp: the sum of the skin's scores beyond which the object is held (FingerVision 2017, section II-A)
    53 GentleScore "gentle-score-points" "points" [1, 100] = 7;
    /// Hand-over: cells of the skin that must feel another force (FingerVision 2017, section II-C)
    54 ChangedCells "hand-over-cells" "cells" [2, 20] = 5;
    /// Moving points in the camera's picture that are slip, in e4: ten-thousandths of it
    55 MovingPoints "moving-points-e4" "e4" [2, 1_000] = 30;
    /// Turn: how far ahead of the camera a turn is foreseen; 0: not at all, as in FingerVision 2017
    56 TurnLead "turn-lead-ms" "ms" [0, 300] = 90;
    /// 1: a photoelastic head is in the place of PVDF film 12
    60 Head "head-photoelastic-flag" "flag" [0, 1] = 0;
    /// Photoelastic: mean size of the ac part that means slip
    61 HeadSlip "head-slip-mv" "mV" [1, 100] = 2;
    /// Photoelastic calibration: voltage without load
    62 HeadDark "head-dark-mv" "mV" [50, 2_000] = 400;
    /// Photoelastic calibration: voltage at the peak
    63 HeadBright "head-bright-mv" "mV" [200, 3_300] = 2_600;
    /// Photoelastic calibration: force at an eighth of half a turn of phase
    64 HeadForce1 "head-force-1-mn" "mN" [1, 30_000] = 136;
    /// Photoelastic calibration: force at two eighths
    65 HeadForce2 "head-force-2-mn" "mN" [1, 30_000] = 481;
    /// Photoelastic calibration: force at three eighths
    66 HeadForce3 "head-force-3-mn" "mN" [1, 30_000] = 1_007;
    /// Photoelastic calibration: force at four eighths, the peak
    67 HeadForce4 "head-force-4-mn" "mN" [1, 30_000] = 1_700;
    /// Photoelastic calibration: force at five eighths
    68 HeadForce5 "head-force-5-mn" "mN" [1, 30_000] = 2_551;
    /// Photoelastic calibration: force at six eighths
    69 HeadForce6 "head-force-6-mn" "mN" [1, 30_000] = 3_554;
    /// Photoelastic calibration: force at seven eighths
    70 HeadForce7 "head-force-7-mn" "mN" [1, 30_000] = 4_706;
    /// Photoelastic calibration: force at half a turn, where the voltage is back at its first value
    71 HeadForce8 "head-force-8-mn" "mN" [1, 30_000] = 6_000;
    /// Hebbian: how far ahead rising shear is looked at: it warns if Ft/Fn will by then be where the camera saw slip; 0: it never does
    72 HebbianAhead "hebbian-ahead-ms" "ms" [0, 250] = 75;
    /// The mains, whose hum is taken off the PVDF films, is at 60 Hz (1), not at 50 (0)
    73 Mains60Hz "mains-60-hz-flag" "flag" [0, 1] = 0;
}

impl SettingId {
    /// The setting with this number, if there is one.
    #[must_use]
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|id| *id as u8 == number)
    }

    /// The setting with this name, or with one that it had before.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|id| id.row().name == name || id.row().was == Some(name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn numbers_and_names_are_given_once_and_defaults_are_accepted() {
        let mut names = HashSet::new();
        for id in SettingId::ALL {
            let row = id.row();
            assert!(names.insert(row.name) && row.was.is_none_or(|was| names.insert(was)), "{}", row.name);
            assert!(row.range().contains(&row.default) && row.min < row.max, "{}", row.name);
            assert!(row.max <= row.max_if_trusted, "{}", row.name);
            assert!(
                row.min >= 0 && row.max_if_trusted < 1 << 24,
                "{}: a record keeps 24 bits of it",
                row.name
            );
            assert_eq!(SettingId::from_number(id as u8), Some(id));
            assert_eq!(SettingId::by_name(row.name), Some(id));
            assert!(id as u8 != 0, "0 marks a record of the first format");
        }
    }

    #[test]
    fn names_end_with_their_unit() {
        for id in SettingId::ALL {
            let row = id.row();
            let unit = row.unit.replace(' ', "").to_lowercase();
            assert!(row.name.ends_with(&std::format!("-{unit}")), "{} in {}", row.name, row.unit);
        }
    }
}
