//! What a fingertip says on a classic CAN bus, 80 times a second: its evidence of slip, and the margin of its grip.
//!
//! Two data frames a slow frame, evidence first. A fingertip hears nothing there, so nothing on that bus moves a hand. Who speaks is in
//! the identifier: 24 bits of a hash of the chip's number, so that nobody has to give an address.

use tenax_hal_shim::detector::DetectorSet;
use tenax_hal_shim::wire::Forces;

use crate::bus::Chip;

/// Bits of the identifier that say who speaks. Above them stands what is said: of two frames, the evidence wins the bus.
const WHO_BITS: u32 = 24;
const WHO_MASK: u32 = (1 << WHO_BITS) - 1;
/// What the identifiers say is said.
const EVIDENCE: u32 = 0;
const MARGIN: u32 = 1;
/// Stands for a force that is not known, and for a margin.
const NO_FORCE: u16 = u16::MAX;
const NO_MARGIN: i16 = i16::MIN;
const WEARER: u8 = 1;

/// A data frame of eight bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// 29 bits: the extended format.
    pub identifier: u32,
    /// What it carries.
    pub bytes: [u8; 8],
}

/// What is said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Word {
    /// First in a slow frame.
    Evidence(Evidence),
    /// Then this.
    Margin(Margin),
}

/// What the detectors said in a slow frame, believed or not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Evidence {
    /// Sequence number of its last frame.
    pub frame: u32,
    /// Detectors that said slip in one of its ticks.
    pub slip: DetectorSet,
    /// Those that warned of it.
    pub incipient: DetectorSet,
    /// A muscle is active, its hold time included.
    pub wearer: bool,
}

/// The forces at the end of a slow frame. What does not fit is the nearest that does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Margin {
    /// The shear that the grip could still carry, mN ([`Forces::margin_mn`]). None while nothing is held.
    pub margin_mn: Option<i16>,
    /// The load, mN. None while the force sensor gives no number.
    pub load_mn: Option<u16>,
    /// The shear, mN.
    pub shear_mn: Option<u16>,
    /// What friction is at least, per mille: the finger's S2.
    pub friction_permille: u16,
}

impl Margin {
    /// Of a slow frame's forces.
    #[must_use]
    pub fn of(forces: Option<Forces>, friction_permille: u16) -> Self {
        let force = |mn: i32| mn.clamp(0, i32::from(NO_FORCE) - 1) as u16;
        let margin = |mn: i32| mn.clamp(i32::from(NO_MARGIN) + 1, i16::MAX.into()) as i16;
        Self {
            margin_mn: forces.and_then(|forces| forces.margin_mn(friction_permille)).map(margin),
            load_mn: forces.map(|forces| force(forces.load_mn)),
            shear_mn: forces.map(|forces| force(forces.ft_mn)),
            friction_permille,
        }
    }
}

/// The part of an identifier that says who speaks: a hash of the chip's number. Two of five fingertips share theirs once in a million
/// hands.
#[must_use]
pub fn who(chip: Chip) -> u32 {
    let mixed = chip.iter().fold(0, |all: u32, &part| (all ^ part).wrapping_mul(0x9E37_79B9).rotate_left(13));
    (mixed ^ mixed >> WHO_BITS) & WHO_MASK
}

/// Says a word as `who`.
#[must_use]
pub fn pack(who: u32, word: &Word) -> Frame {
    let (kind, bytes) = match *word {
        Word::Evidence(Evidence { frame, slip, incipient, wearer }) => {
            let [a, b, c, d] = frame.to_le_bytes();
            (EVIDENCE, [a, b, c, d, slip.bits(), incipient.bits(), if wearer { WEARER } else { 0 }, 0])
        }
        Word::Margin(Margin { margin_mn, load_mn, shear_mn, friction_permille }) => {
            let [a, b] = margin_mn.unwrap_or(NO_MARGIN).to_le_bytes();
            let [c, d] = load_mn.unwrap_or(NO_FORCE).to_le_bytes();
            let [e, f] = shear_mn.unwrap_or(NO_FORCE).to_le_bytes();
            let [g, h] = friction_permille.to_le_bytes();
            (MARGIN, [a, b, c, d, e, f, g, h])
        }
    };
    Frame { identifier: kind << WHO_BITS | who & WHO_MASK, bytes }
}

/// Who said what. None: no fingertip says this.
#[must_use]
pub fn unpack(frame: &Frame) -> Option<(u32, Word)> {
    let [a, b, c, d, e, f, g, h] = frame.bytes;
    let word = match frame.identifier >> WHO_BITS {
        EVIDENCE => {
            let [slip, incipient] = [DetectorSet::from_bits(e)?, DetectorSet::from_bits(f)?];
            let frame = u32::from_le_bytes([a, b, c, d]);
            Word::Evidence(Evidence { frame, slip, incipient, wearer: g & WEARER != 0 })
        }
        MARGIN => Word::Margin(Margin {
            margin_mn: Some(i16::from_le_bytes([a, b])).filter(|&mn| mn != NO_MARGIN),
            load_mn: Some(u16::from_le_bytes([c, d])).filter(|&mn| mn != NO_FORCE),
            shear_mn: Some(u16::from_le_bytes([e, f])).filter(|&mn| mn != NO_FORCE),
            friction_permille: u16::from_le_bytes([g, h]),
        }),
        _ => return None,
    };
    Some((frame.identifier & WHO_MASK, word))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn evidence() -> impl Strategy<Value = Word> {
        let set = || (0..=DetectorSet::ALL.bits()).prop_map(|bits| DetectorSet::from_bits(bits).unwrap());
        (any::<u32>(), set(), set(), any::<bool>()).prop_map(|(frame, slip, incipient, wearer)| {
            Word::Evidence(Evidence { frame, slip, incipient, wearer })
        })
    }

    fn margin() -> impl Strategy<Value = Word> {
        // Every number that a force can be, and others.
        let force = || -200_000..200_000;
        let forces = (force(), force(), force(), any::<Option<u16>>());
        let forces = forces.prop_map(|(fn_mn, load_mn, ft_mn, ratio_permille)| Forces {
            fn_mn,
            load_mn,
            ft_mn,
            ratio_permille,
            ..Forces::default()
        });
        (prop::option::of(forces), 0..2_000u16)
            .prop_map(|(forces, friction)| Word::Margin(Margin::of(forces, friction)))
    }

    proptest! {
        #[test]
        fn what_is_said_is_what_is_heard(chip: Chip, words in (evidence(), margin())) {
            let words: [Word; 2] = words.into();
            let who = who(chip);
            let frames = words.map(|word| pack(who, &word));
            prop_assert!(frames[0].identifier < frames[1].identifier && frames[1].identifier < 1 << 29);
            for (word, frame) in words.iter().zip(&frames) {
                prop_assert_eq!(unpack(frame), Some((who, *word)));
            }
        }

        #[test]
        fn what_no_fingertip_says_is_nobodys(identifier in 2 << WHO_BITS..1u32 << 29, bytes: [u8; 8]) {
            prop_assert_eq!(unpack(&Frame { identifier, bytes }), None);
        }
    }

    #[test]
    fn chips_of_one_wafer_have_names_of_their_own() {
        let chips = (0..40).flat_map(|x| (0..40).map(move |y| [x << 16 | y, 0x3236_5108, 0x3030_3337]));
        let names: std::collections::BTreeSet<_> = chips.map(who).collect();
        assert!(names.len() >= 1_599, "{} names of 1600 chips", names.len());
    }
}
