//! Settings: one row each beside its field. Number on the wire and in flash, name, range, default, conversion
//! and the line of `tenax tables settings` come from it.

use core::ops::RangeInclusive;

use tenax_hal_shim::channel::{FRAME_HZ, frames, mv_from_sample, sample_from_mv};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    pub id: SettingId,
    pub name: &'static str,
    pub unit: &'static str,
    /// Physically sensible values; what the line may do is limited by consent and by the force ceiling.
    pub min: i32,
    pub max: i32,
    pub default: i32,
    pub meaning: &'static str,
}

impl Row {
    pub const fn range(&self) -> RangeInclusive<i32> {
        self.min..=self.max
    }
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SettingId(u8);

impl SettingId {
    pub(crate) const fn numbered(number: u8) -> Self {
        Self(number)
    }

    pub const fn number(self) -> u8 {
        self.0
    }
}

pub(crate) trait Settings {
    /// None if the setting belongs to another part.
    fn value(&self, id: SettingId) -> Option<i32>;
    fn put(&mut self, id: SettingId, value: i32);
}

pub(crate) trait Unit<Field> {
    /// `value`: 0 to 2^24.
    fn field(value: i32) -> Field;
    fn value(field: Field) -> i32;
}

/// Millivolts, kept as a sample. A 14-bit sample has more steps than there are millivolts.
pub(crate) struct Mv;
pub(crate) struct MvQ4;
pub(crate) struct Ms;
pub(crate) struct Number;
pub(crate) struct Flag;
pub(crate) struct Mask;

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

impl<T: TryFrom<i32> + TryInto<i32> + Default> Unit<T> for Number {
    fn field(value: i32) -> T {
        value.try_into().unwrap_or_default()
    }
    fn value(field: T) -> i32 {
        field.try_into().unwrap_or_default()
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

macro_rules! settings {
    ($config:ident: $($(#[doc = $meaning:literal])+ $number:literal $id:ident $name:literal $unit:literal
        [$min:literal, $max:literal] = $default:literal
        => $kind:ident($($field:tt)+);)+) => {
        impl $crate::setting::SettingId {
            $($(#[doc = $meaning])+ #[allow(non_upper_case_globals, reason = "read as the variants of an enum")]
            pub const $id: Self = Self::numbered($number);)+
        }

        impl $config {
            pub(crate) const ROWS: &'static [$crate::setting::Row] = &[$($crate::setting::Row {
                id: $crate::setting::SettingId::$id,
                name: $name,
                unit: $unit,
                min: $min,
                max: $max,
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
}
pub(crate) use settings;
