//! Settings: every number of the fingertip that a person may choose, one row each.
//!
//! A row stands beside the field that it fills, in the `settings.rs` of its sense. From it come the setting's number on the wire
//! and in flash, its name, range and default, how the field's unit is converted, and its line in `docs/settings.md`. One
//! more setting is a field with its row, and the page printed again.

use core::ops::RangeInclusive;

use tenax_hal_shim::channel::{FRAME_HZ, frames, mv_from_sample, sample_from_mv};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};

/// Description of a setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// The setting.
    pub id: SettingId,
    /// Its name on the command line and in scene files. It ends with the unit.
    pub name: &'static str,
    /// Its unit, for a person.
    pub unit: &'static str,
    /// The lowest value that is accepted.
    pub min: i32,
    /// The highest value. No mix within these ranges drops or crushes an object or disables detection (`bench/tests/mixes.rs`).
    pub max: i32,
    /// The lowest value on a trusted line.
    pub min_if_trusted: i32,
    /// The highest value on a trusted line: it may disable a detector.
    pub max_if_trusted: i32,
    /// Its default.
    pub default: i32,
    /// Its meaning, for people.
    pub meaning: &'static str,
}

impl Row {
    /// The values that are accepted on a line that is not trusted.
    pub const fn range(&self) -> RangeInclusive<i32> {
        self.min..=self.max
    }

    /// The values that are accepted, by whether the line is trusted.
    #[must_use]
    pub const fn range_in_force(&self, line_trusted: bool) -> RangeInclusive<i32> {
        if line_trusted { self.min_if_trusted..=self.max_if_trusted } else { self.range() }
    }
}

/// A setting, by its number on the wire and in flash. Numbers are never given twice.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SettingId(u8);

impl SettingId {
    /// For a row.
    pub(crate) const fn numbered(number: u8) -> Self {
        Self(number)
    }

    /// Its number on the wire and in flash.
    #[must_use]
    pub const fn number(self) -> u8 {
        self.0
    }
}

/// A part of the configuration that has settings.
pub(crate) trait Settings {
    /// The value of a setting, in its unit; None if it belongs to another part.
    fn value(&self, id: SettingId) -> Option<i32>;
    /// Changes a setting; does nothing if it belongs to another part.
    fn put(&mut self, id: SettingId, value: i32);
}

/// How a setting's value becomes a field, and back.
pub(crate) trait Unit<Field> {
    /// The field from an accepted value, 0 to 2^24.
    fn field(value: i32) -> Field;
    /// The setting's value from a field, as it was set.
    fn value(field: Field) -> i32;
}

/// Millivolts, kept as a sample. A 14-bit sample has more steps than there are millivolts.
pub(crate) struct Mv;
/// Millivolts, kept as a mean in 1/16 of a sample.
pub(crate) struct MvQ4;
/// Milliseconds, kept as frames.
pub(crate) struct Ms;
/// A plain number: setting and field have the same unit.
pub(crate) struct Number;
/// 0 or 1.
pub(crate) struct Flag;
/// A set of detectors, a bit each in the order of [`MASKED`].
pub(crate) struct Mask;

/// The detectors of a [`Mask`], the lowest bit first. Where the line is not trusted only the first three can be named: a worn hand is
/// never deaf.
const MASKED: [DetectorId; 5] =
    [DetectorId::Hebbian, DetectorId::Mlp, DetectorId::Photoelastic, DetectorId::S2, DetectorId::S1];

impl Unit<DetectorSet> for Mask {
    fn field(value: i32) -> DetectorSet {
        let bits = (0..).zip(MASKED);
        bits.fold(DetectorSet::NONE, |set, (bit, id)| set.with(id, value >> bit & 1 == 1))
    }
    fn value(field: DetectorSet) -> i32 {
        (0..).zip(MASKED).map(|(bit, id)| i32::from(field.contains(id)) << bit).sum()
    }
}

impl Unit<u16> for Mv {
    fn field(value: i32) -> u16 {
        sample_from_mv(value.unsigned_abs())
    }
    fn value(field: u16) -> i32 {
        mv_from_sample(field) as i32
    }
}

impl Unit<i32> for MvQ4 {
    fn field(value: i32) -> i32 {
        i32::from(Mv::field(value)) << 4
    }
    fn value(field: i32) -> i32 {
        Mv::value((field >> 4) as u16)
    }
}

impl Unit<u32> for Ms {
    fn field(value: i32) -> u32 {
        frames(value.unsigned_abs())
    }
    fn value(field: u32) -> i32 {
        (field * 1_000 / FRAME_HZ) as i32
    }
}

impl Unit<u16> for Number {
    fn field(value: i32) -> u16 {
        value.clamp(0, u16::MAX.into()) as u16
    }
    fn value(field: u16) -> i32 {
        field.into()
    }
}

impl Unit<u32> for Number {
    fn field(value: i32) -> u32 {
        value.unsigned_abs()
    }
    fn value(field: u32) -> i32 {
        field as i32
    }
}

impl Unit<i32> for Number {
    fn field(value: i32) -> i32 {
        value
    }
    fn value(field: i32) -> i32 {
        field
    }
}

impl Unit<bool> for Flag {
    fn field(value: i32) -> bool {
        value > 0
    }
    fn value(field: bool) -> i32 {
        field.into()
    }
}

/// Makes the rows of a part of the configuration, and each setting's way into its field and back.
macro_rules! settings {
    ($config:ident: $($(#[doc = $meaning:literal])+ $number:literal $id:ident $name:literal $unit:literal
        [$min:literal, $max:literal $(, trusted $low:literal, $high:literal)?] = $default:literal
        => $kind:ident($($field:tt)+);)+) => {
        impl $crate::setting::SettingId {
            $($(#[doc = $meaning])+ #[allow(non_upper_case_globals, reason = "read as the variants of an enum")]
            pub const $id: Self = Self::numbered($number);)+
        }

        impl $config {
            /// The rows of its settings.
            pub(crate) const ROWS: &'static [$crate::setting::Row] = &[$($crate::setting::Row {
                id: $crate::setting::SettingId::$id,
                name: $name,
                unit: $unit,
                min: $min,
                max: $max,
                min_if_trusted: $crate::setting::settings!(@trusted $min $(, $low)?),
                max_if_trusted: $crate::setting::settings!(@trusted $max $(, $high)?),
                default: $default,
                meaning: concat!($($meaning),+).trim_ascii(),
            }),+];
        }

        impl $crate::setting::Settings for $config {
            fn value(&self, id: $crate::setting::SettingId) -> Option<i32> {
                use $crate::setting::{SettingId, Unit};
                Some(match id {
                    $(SettingId::$id => $crate::setting::$kind::value(self.$($field)+),)+
                    _ => return None,
                })
            }

            fn put(&mut self, id: $crate::setting::SettingId, value: i32) {
                use $crate::setting::{SettingId, Unit};
                match id {
                    $(SettingId::$id => self.$($field)+ = $crate::setting::$kind::field(value),)+
                    _ => {}
                }
            }
        }
    };
    (@trusted $end:literal) => { $end };
    (@trusted $end:literal, $trusted:literal) => { $trusted };
}
pub(crate) use settings;
