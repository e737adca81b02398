//! What one tick decided, and its nine bytes on the line.
//!
//! Twenty-five of these go up 80 times a second, more than everything else together; numbers of any length would cost the
//! core more to write than the films to condition. So the fields are fixed:
//!
//! | bytes | what |
//! |---|---|
//! | 0, 1 | vibration, 14 bits, little-endian |
//! | 2, 3 | o1, o2 |
//! | 4, 5 | duty per mille (bits 9..0), drive (11..10: coast, close, open), source (13..12), little-endian |
//! | 6, 7, 8 | the detectors that say slip or warn of it, that are believed, that the reflex acts on; a bit each |

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::NETWORK_OUTPUTS;
use crate::detector::DetectorSet;
use crate::motor::{Duty, MotorDrive};
use crate::words::DriveSource;

/// What one tick (0.5 ms) decided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TickRecord {
    /// The largest vibration envelope of all films, in samples (14 bits): at most [`TickRecord::VIBRATION_MAX`].
    pub vibration: u16,
    /// What touch alone makes the Hebbian network say, relative motion (o1) and direction (o2): 128 would be 1.
    pub outputs: [i8; NETWORK_OUTPUTS],
    /// The detectors that say slip, or warn of it, whoever listens.
    pub said: DetectorSet,
    /// Those of them that are believed.
    pub believed: DetectorSet,
    /// Those of them that the reflex closes the hand for.
    pub acted: DetectorSet,
    /// What drives the motor.
    pub drive: MotorDrive,
    /// Who drives it.
    pub source: DriveSource,
}

/// Bytes of a tick on the line.
type Bytes = [u8; 9];

const DRIVE_SHIFT: u32 = 10;
const SOURCE_SHIFT: u32 = 12;

impl TickRecord {
    /// The largest vibration that its field holds; more would go up as this.
    pub const VIBRATION_MAX: u16 = (1 << 14) - 1;

    fn bytes(self) -> Bytes {
        let heard = self.vibration.min(Self::VIBRATION_MAX);
        let (kind, duty) = match self.drive {
            MotorDrive::Coast => (0, 0),
            MotorDrive::Close(duty) => (1, duty.as_per_mille()),
            MotorDrive::Open(duty) => (2, duty.as_per_mille()),
        };
        let driven = duty | kind << DRIVE_SHIFT | (self.source as u16) << SOURCE_SHIFT;
        let ([h0, h1], [o1, o2], [d0, d1]) =
            (heard.to_le_bytes(), self.outputs.map(|output| output as u8), driven.to_le_bytes());
        [h0, h1, o1, o2, d0, d1, self.said.bits(), self.believed.bits(), self.acted.bits()]
    }

    /// None of bytes that no tick has.
    fn from_bytes([h0, h1, o1, o2, d0, d1, said, believed, acted]: Bytes) -> Option<Self> {
        let (heard, driven) = (u16::from_le_bytes([h0, h1]), u16::from_le_bytes([d0, d1]));
        let permille = driven & ((1 << DRIVE_SHIFT) - 1);
        let duty = Duty::per_mille(permille);
        let drive = match driven >> DRIVE_SHIFT & 3 {
            0 if permille == 0 => MotorDrive::Coast,
            1 if permille == duty.as_per_mille() => MotorDrive::Close(duty),
            2 if permille == duty.as_per_mille() => MotorDrive::Open(duty),
            _ => return None,
        };
        let source = match driven >> SOURCE_SHIFT {
            0 => DriveSource::Nobody,
            1 => DriveSource::Wearer,
            2 => DriveSource::Link,
            3 => DriveSource::Reflex,
            _ => return None,
        };
        Some(Self {
            vibration: Some(heard).filter(|&heard| heard <= Self::VIBRATION_MAX)?,
            outputs: [o1 as i8, o2 as i8],
            said: DetectorSet::from_bits(said)?,
            believed: DetectorSet::from_bits(believed)?,
            acted: DetectorSet::from_bits(acted)?,
            drive,
            source,
        })
    }
}

impl Serialize for TickRecord {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.bytes().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for TickRecord {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::from_bytes(Bytes::deserialize(deserializer)?)
            .ok_or_else(|| D::Error::custom("no tick has these bytes"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detector::DetectorId;

    #[test]
    fn every_field_survives_its_bytes_at_its_ends() {
        let drives = [0, 1, 999, 1_000]
            .map(Duty::per_mille)
            .map(|duty| [MotorDrive::Close(duty), MotorDrive::Open(duty)]);
        let drives = drives.into_iter().flatten().chain([MotorDrive::Coast]);
        let sources = [DriveSource::Nobody, DriveSource::Wearer, DriveSource::Link, DriveSource::Reflex];
        for (drive, source) in drives.flat_map(|drive| sources.map(|source| (drive, source))) {
            let [s1, mlp] = [DetectorId::S1, DetectorId::Mlp].map(DetectorSet::only);
            for (vibration, [said, believed, acted]) in
                [0, 1, 8_191, TickRecord::VIBRATION_MAX].into_iter().zip([
                    [DetectorSet::NONE; 3],
                    [DetectorSet::ALL; 3],
                    [s1.or(mlp), mlp, DetectorSet::NONE],
                    [DetectorSet::ALL, s1, s1],
                ])
            {
                for outputs in [[0, 0], [-128, 127], [127, -128], [-1, 1]] {
                    let record = TickRecord { vibration, outputs, said, believed, acted, drive, source };
                    assert_eq!(TickRecord::from_bytes(record.bytes()), Some(record));
                }
            }
        }
    }

    #[test]
    fn bytes_that_no_tick_has_are_refused() {
        let with =
            |driven: u16| TickRecord::from_bytes([0, 0, 0, 0, driven as u8, (driven >> 8) as u8, 0, 0, 0]);
        assert!(with(0).is_some());
        for driven in [1, 1 << 10 | 1_001, 2 << 10 | 1_023, 3 << 10, 1 << 14, 1 << 15] {
            assert_eq!(with(driven), None, "{driven:#x}");
        }
        for place in [1, 6, 7, 8] {
            let mut bytes = [0; 9];
            bytes[place] = 0x80;
            assert_eq!(TickRecord::from_bytes(bytes), None, "byte {place}");
        }
    }
}
