//! Names and reports of the detectors. A detector **says** slip: its own report. The report is **believed** unless the plausibility guard
//! ignores it. It is **acted** on while the reflex closes because of it.

use postcard_schema::Schema;
use serde::{Deserialize, Serialize};

use crate::named;

named! {
    /// A detector. Its number is its bit in a [`DetectorSet`]; new ones are added at the end.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, Schema)]
    #[cfg_attr(feature = "defmt", derive(defmt::Format))]
    #[repr(u8)]
    pub enum DetectorId {
        /// S1: vibration of the PVDF film (Prosthesis, section 5).
        S1 = "s1",
        /// S2: Ft/Fn, which warns of slip before it happens (Prosthesis, section 5).
        S2 = "s2",
        /// The Hebbian network that a camera teaches (Tada 2006).
        Hebbian = "hebbian",
        /// The multilayer perceptron on normal forces (Bamshad 2023).
        Mlp = "mlp",
        /// Reports from outside: of a scene that knows whether it slips.
        Injected = "injected",
        /// The flicker of a photoelastic head (Dubey 2006).
        Photoelastic = "photoelastic",
    }
}

impl DetectorId {
    pub const COUNT: usize = Self::ALL.len();

    pub const fn title(self) -> &'static str {
        match self {
            Self::S1 => "S1 vibration",
            Self::S2 => "S2 Ft/Fn",
            Self::Hebbian => "Hebbian",
            Self::Mlp => "MLP",
            Self::Injected | Self::Photoelastic => self.name(),
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct DetectorSet(u8);

impl DetectorSet {
    pub const NONE: Self = Self(0);
    pub const ALL: Self = Self(((1u16 << DetectorId::COUNT) - 1) as u8);

    pub const fn only(id: DetectorId) -> Self {
        Self(1 << id as u8)
    }

    pub const fn with(self, id: DetectorId, is_in: bool) -> Self {
        let bit = 1 << id as u8;
        Self(if is_in { self.0 | bit } else { self.0 & !bit })
    }

    pub const fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    pub const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    pub const fn contains(self, id: DetectorId) -> bool {
        self.0 & 1 << id as u8 != 0
    }

    /// The detector with the lowest number, None if the set is empty.
    pub const fn first(self) -> Option<DetectorId> {
        // Asked in every tick, and nearly always of none.
        if self.0 == 0 {
            None
        } else {
            Some(DetectorId::ALL[self.0.trailing_zeros() as usize % DetectorId::COUNT])
        }
    }

    /// One bit for each detector, in the order of [`DetectorId`].
    pub const fn bits(self) -> u8 {
        self.0
    }

    /// The set with these bits. None if one of them is no detector's.
    pub const fn from_bits(bits: u8) -> Option<Self> {
        if bits & !Self::ALL.0 == 0 { Some(Self(bits)) } else { None }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum Direction {
    #[default]
    Unknown,
    Down,
    Up,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub enum DetectorHealth {
    /// The detector does not work yet: its windows fill, or it has not seen the finger unloaded.
    #[default]
    Starting,
    Working,
    Blind,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Schema)]
pub struct Evidence {
    pub slip: bool,
    pub incipient: bool,
    /// Confidence, 0 to 1000 per mille; 500 at the threshold.
    pub confidence_permille: u16,
    pub direction: Direction,
    pub decided_at: u32,
    pub health: DetectorHealth,
    /// The number that is compared with the threshold: the envelope (S1, 14-bit samples), Ft/Fn (S2, per mille), the
    /// PVDF part of o1 (Hebbian, per mille), the logit (MLP), the rate of slip (photoelastic, um/s).
    pub raw: i32,
}

impl Evidence {
    pub const fn says(&self) -> bool {
        self.slip || self.incipient
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_detectors_number_is_its_place() {
        for (n, id) in DetectorId::ALL.into_iter().enumerate() {
            assert_eq!(id as usize, n);
            let only = DetectorSet::only(id);
            assert_eq!((only.first(), DetectorSet::from_bits(only.bits())), (Some(id), Some(only)));
            assert!(DetectorSet::ALL.without(only).with(id, true) == DetectorSet::ALL);
        }
        assert_eq!(DetectorSet::NONE.first(), None);
        assert_eq!(DetectorSet::from_bits(1 << DetectorId::COUNT), None);
    }
}
