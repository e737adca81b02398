//! The decisions of one tick, and their four to nine bytes on the line.
//! Twenty-five of these go up 80 times a second, more than everything else together, and each byte costs the core twenty
//! instructions (checksum and framing). So the fields have their places, and those that are usually 0 are left out:
//!
//! | bytes | what | |
//! |---|---|---|
//! | 2 | vibration, 14 bits; bit 14: the drive follows; bit 15: the sets follow; little-endian | always |
//! | 2 | o1, o2 | always |
//! | 2 | duty per mille (bits 9..0), drive (11..10: coast, close, open), source (14..12), little-endian | while driven |
//! | 3 | the detectors that say slip or warn of it, that are believed, that the reflex acts on; a bit each | while any does |

use core::fmt;

use postcard_schema::Schema;
use postcard_schema::schema::NamedType;
use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::NETWORK_OUTPUTS;
use crate::detector::DetectorSet;
use crate::motor::{Duty, MotorDrive};
use crate::words::DriveSource;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TickRecord {
    /// The largest vibration envelope of all films, in samples (14 bits): at most [`TickRecord::VIBRATION_MAX`].
    pub vibration: u16,
    /// Outputs of the Hebbian network without teacher: relative motion (o1) and direction (o2), in 1/128, -128 to 127.
    pub outputs: [i8; NETWORK_OUTPUTS],
    /// The detectors that report slip or warn of it, believed or not.
    pub said: DetectorSet,
    /// The detectors in `said` whose report the plausibility guard believes.
    pub believed: DetectorSet,
    /// The detectors in `believed` for which the reflex closes the hand.
    pub acted: DetectorSet,
    pub drive: MotorDrive,
    pub source: DriveSource,
}

const BYTES_MAX: usize = 9;
const DRIVE_FOLLOWS: u16 = 1 << 14;
const SETS_FOLLOW: u16 = 1 << 15;
const DRIVE_SHIFT: u32 = 10;
const SOURCE_SHIFT: u32 = 12;

impl TickRecord {
    /// The largest `vibration` that fits its field; larger values are sent as this one.
    pub const VIBRATION_MAX: u16 = DRIVE_FOLLOWS - 1;

    fn driven(self) -> u16 {
        let (kind, duty) = match self.drive {
            MotorDrive::Coast => (0, 0),
            MotorDrive::Close(duty) => (1, duty.as_per_mille()),
            MotorDrive::Open(duty) => (2, duty.as_per_mille()),
        };
        duty | kind << DRIVE_SHIFT | (self.source as u16) << SOURCE_SHIFT
    }

    fn sets(self) -> [u8; 3] {
        [self.said.bits(), self.believed.bits(), self.acted.bits()]
    }

    fn of(vibration: u16, outputs: [i8; NETWORK_OUTPUTS], driven: u16, sets: [u8; 3]) -> Option<Self> {
        let permille = driven & ((1 << DRIVE_SHIFT) - 1);
        let duty = Duty::per_mille(permille);
        let drive = match driven >> DRIVE_SHIFT & 3 {
            0 if permille == 0 => MotorDrive::Coast,
            1 if permille == duty.as_per_mille() => MotorDrive::Close(duty),
            2 if permille == duty.as_per_mille() => MotorDrive::Open(duty),
            _ => return None,
        };
        let source = *DriveSource::ALL.get(usize::from(driven >> SOURCE_SHIFT))?;
        let [said, believed, acted] = sets;
        Some(Self {
            vibration,
            outputs,
            said: DetectorSet::from_bits(said)?,
            believed: DetectorSet::from_bits(believed)?,
            acted: DetectorSet::from_bits(acted)?,
            drive,
            source,
        })
    }
}

impl Schema for TickRecord {
    const SCHEMA: &'static NamedType = &NamedType { name: "tick", ty: <[u8; BYTES_MAX]>::SCHEMA.ty };
}

impl Serialize for TickRecord {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (driven, sets) = (self.driven(), self.sets());
        let mut heard = self.vibration.min(Self::VIBRATION_MAX);
        heard |= if driven == 0 { 0 } else { DRIVE_FOLLOWS };
        heard |= if sets == [0; 3] { 0 } else { SETS_FOLLOW };
        // postcard writes the elements one after the other, and nothing of how many there are.
        let mut bytes = serializer.serialize_tuple(BYTES_MAX)?;
        let mut write = |some: &[u8]| some.iter().try_for_each(|byte| bytes.serialize_element(byte));
        write(&heard.to_le_bytes())?;
        write(&self.outputs.map(|output| output as u8))?;
        if driven != 0 {
            write(&driven.to_le_bytes())?;
        }
        if sets != [0; 3] {
            write(&sets)?;
        }
        bytes.end()
    }
}

impl<'de> Deserialize<'de> for TickRecord {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Bytes;
        impl<'de> Visitor<'de> for Bytes {
            type Value = TickRecord;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "4 to {BYTES_MAX} bytes of a tick")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<TickRecord, A::Error> {
                let mut next = || seq.next_element::<u8>()?.ok_or_else(|| A::Error::invalid_length(0, &self));
                let heard = u16::from_le_bytes([next()?, next()?]);
                let outputs = [next()? as i8, next()? as i8];
                let driven =
                    if heard & DRIVE_FOLLOWS != 0 { u16::from_le_bytes([next()?, next()?]) } else { 0 };
                let sets = if heard & SETS_FOLLOW != 0 { [next()?, next()?, next()?] } else { [0; 3] };
                let record = TickRecord::of(heard & TickRecord::VIBRATION_MAX, outputs, driven, sets);
                // What is left out is 0, so what is there is not: each tick has one way to be written.
                let plain = (heard & DRIVE_FOLLOWS == 0 || driven != 0)
                    && (heard & SETS_FOLLOW == 0 || sets != [0; 3]);
                record.filter(|_| plain).ok_or_else(|| A::Error::custom("no tick has these bytes"))
            }
        }
        deserializer.deserialize_tuple(BYTES_MAX, Bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detector::DetectorId;

    #[test]
    fn every_field_survives_its_bytes_at_its_ends() {
        let [s1, mlp] = [DetectorId::S1, DetectorId::Mlp].map(DetectorSet::only);
        let loudest = TickRecord::VIBRATION_MAX;
        let ends = [
            (0, [0, 0], [DetectorSet::NONE; 3]),
            (1, [-128, 127], [DetectorSet::ALL; 3]),
            (8_191, [127, -128], [s1.or(mlp), mlp, DetectorSet::NONE]),
            (loudest, [-1, 1], [DetectorSet::ALL, s1, s1]),
        ];
        let duties = [0, 1, 999, 1_000].map(Duty::per_mille);
        let driven = duties.into_iter().flat_map(|duty| [MotorDrive::Close(duty), MotorDrive::Open(duty)]);
        for drive in driven.chain([MotorDrive::Coast]) {
            for source in DriveSource::ALL {
                for (vibration, outputs, [said, believed, acted]) in ends {
                    let record = TickRecord { vibration, outputs, said, believed, acted, drive, source };
                    let mut buffer = [0; BYTES_MAX];
                    let bytes = postcard::to_slice(&record, &mut buffer).expect("it fits");
                    assert_eq!(postcard::take_from_bytes(bytes), Ok((record, &[][..])));
                }
            }
        }
    }

    fn read(bytes: &[u8]) -> Option<TickRecord> {
        postcard::from_bytes(bytes).ok()
    }

    #[test]
    fn bytes_that_no_tick_has_are_refused() {
        let driven = |driven: u16| read(&[0, 0x40, 0, 0, driven as u8, (driven >> 8) as u8]);
        assert!(driven(1 << 12).is_some());
        for wrong in [0, 1, 1 << 10 | 1_001, 2 << 10 | 1_023, 3 << 10, 5 << 12, 1 << 15] {
            assert_eq!(driven(wrong), None, "{wrong:#x}");
        }
        assert!(read(&[0, 0x80, 0, 0, 1, 1, 0]).is_some());
        for wrong in [[0, 0, 0], [0x80, 0, 0], [1, 0x80, 0], [1, 1, 0x80]] {
            let [a, b, c] = wrong;
            assert_eq!(read(&[0, 0x80, 0, 0, a, b, c]), None, "{wrong:?}");
        }
        assert_eq!(read(&[0, 0xC0, 0, 0, 0, 0x10]), None, "cut short");
    }
}
