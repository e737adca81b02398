//! The channel map: pin, rate and valid voltages of each signal.
//!
//! This table is the only place that knows the wiring. The firmware programs its converter from [`SCAN`], the logic
//! names channels by the index constants, a recording's columns are called [`Channel::name`], and
//! `tenax tables wiring` prints it.

use crate::front_end;

/// Scans in one frame: four 12-bit codes add up to one 14-bit sample (Prosthesis, section 3).
pub const SCANS_PER_FRAME: usize = 4;
/// Rate of the timer that starts each scan, Hz.
pub const SCAN_HZ: u32 = 8_000;
/// Rate of frames, Hz: the rate of every pin that is not behind a switch.
pub const FRAME_HZ: u32 = SCAN_HZ / SCANS_PER_FRAME as u32;
/// Frames in one slow frame: each switched signal is read once in it, myosensors three times.
pub const FRAMES_PER_SLOW_FRAME: u8 = 25;
pub const SLOW_HZ: u32 = FRAME_HZ / FRAMES_PER_SLOW_FRAME as u32;
pub const fn frames(ms: u32) -> u32 {
    ms * FRAME_HZ / 1_000
}

pub const SWITCH_INPUTS: u8 = 16;

pub const HIGH_SELECT: u8 = 14;
pub const LOW_SELECT: u8 = 15;

pub const CODE_MAX: u16 = 4_095;
/// The largest sample: the sum of four largest codes.
pub const SAMPLE_MAX: u16 = CODE_MAX * SCANS_PER_FRAME as u16;
/// The converter's reference, mV.
pub const REFERENCE_MV: u32 = 3_300;

/// The sample (0 to [`SAMPLE_MAX`]) that a steady voltage at the pin gives, rounded to nearest.
pub const fn sample_from_mv(mv: u32) -> u16 {
    let mv = if mv > REFERENCE_MV { REFERENCE_MV } else { mv };
    ((mv * SAMPLE_MAX as u32 + REFERENCE_MV / 2) / REFERENCE_MV) as u16
}

/// The voltage at the pin that a sample stands for, mV, rounded to nearest.
pub const fn mv_from_sample(sample: u16) -> u32 {
    (sample as u32 * REFERENCE_MV + SAMPLE_MAX as u32 / 2) / SAMPLE_MAX as u32
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    Direct {
        rank: u8,
    },
    /// Behind switch A: read while the select lines show `select`.
    SwitchA {
        select: u8,
    },
    SwitchB {
        select: u8,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Its name in recordings, scene files, reports and faults.
    pub name: &'static str,
    pub input: Input,
    /// Voltage at the pin when nothing happens, mV. Never 0: a cut wire must not look like a sensor at rest.
    pub rest_mv: u32,
    /// The lowest voltage that a working sensor can give, mV: below is a cut wire or a lost supply.
    pub low_mv: u32,
    /// The highest voltage that a working sensor can give, mV: above is a short or a sensor pressed out of range.
    pub high_mv: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    Vibration,
    Photoelastic,
    Strain,
    Force,
    Taxel,
    Muscle,
    Hand,
}

impl Role {
    /// The role of a channel (index in [`CHANNELS`]). `head_is_fitted`: a photoelastic head is in the place of film 12.
    pub const fn of(channel: usize, head_is_fitted: bool) -> Self {
        match channel {
            HEAD if head_is_fitted => Self::Photoelastic,
            ..STRAIN => Self::Vibration,
            STRAIN..FSR => Self::Strain,
            FSR..ARRAY => Self::Force,
            ARRAY..MYO_FLEXOR => Self::Taxel,
            MYO_FLEXOR..=MYO_EXTENSOR => Self::Muscle,
            _ => Self::Hand,
        }
    }

    /// The verb for a person who moves such a sensor, as `tenax selftest` asks for it.
    pub const fn verb(self) -> &'static str {
        match self {
            Self::Vibration => "tap",
            Self::Strain => "bend",
            Self::Force | Self::Taxel | Self::Photoelastic => "press",
            Self::Muscle => "contract",
            Self::Hand => "move",
        }
    }
}

pub const PVDF_COUNT: usize = 12;
pub const STRAIN_COUNT: usize = 12;
pub const FSR_COUNT: usize = 4;
pub const ARRAY_COUNT: usize = 10;

pub const PVDF: usize = 0;
/// Index of the film whose place a photoelastic head can take.
pub const HEAD: usize = PVDF + PVDF_COUNT - 1;
pub const STRAIN: usize = PVDF + PVDF_COUNT;
pub const FSR: usize = STRAIN + STRAIN_COUNT;
pub const ARRAY: usize = FSR + FSR_COUNT;
pub const MYO_FLEXOR: usize = ARRAY + ARRAY_COUNT;
pub const MYO_EXTENSOR: usize = MYO_FLEXOR + 1;
pub const OPENING: usize = MYO_EXTENSOR + 1;
pub const MOTOR_CURRENT: usize = OPENING + 1;
pub const COUNT: usize = MOTOR_CURRENT + 1;

/// First select of the FSR quadrants on switch A.
pub const FSR_SELECT: u8 = 12;
/// Select of the flexor's envelope on switch B; the extensor's is the next one.
pub const MYO_SELECT: u8 = 10;

pub const CHANNELS: [Channel; COUNT] = [
    pvdf("pvdf_1", 0),
    pvdf("pvdf_2", 1),
    pvdf("pvdf_3", 2),
    pvdf("pvdf_4", 3),
    pvdf("pvdf_5", 4),
    pvdf("pvdf_6", 5),
    pvdf("pvdf_7", 6),
    pvdf("pvdf_8", 7),
    pvdf("pvdf_9", 8),
    pvdf("pvdf_10", 9),
    pvdf("pvdf_11", 10),
    pvdf("pvdf_12", 11),
    strain("strain_1", 0),
    strain("strain_2", 1),
    strain("strain_3", 2),
    strain("strain_4", 3),
    strain("strain_5", 4),
    strain("strain_6", 5),
    strain("strain_7", 6),
    strain("strain_8", 7),
    strain("strain_9", 8),
    strain("strain_10", 9),
    strain("strain_11", 10),
    strain("strain_12", 11),
    fsr("fsr_a", FSR_SELECT),
    fsr("fsr_b", FSR_SELECT + 1),
    fsr("fsr_c", FSR_SELECT + 2),
    fsr("fsr_d", FSR_SELECT + 3),
    element("array_1", 0),
    element("array_2", 1),
    element("array_3", 2),
    element("array_4", 3),
    element("array_5", 4),
    element("array_6", 5),
    element("array_7", 6),
    element("array_8", 7),
    element("array_9", 8),
    element("array_10", 9),
    slow("myo_flexor", MYO_SELECT, front_end::MYO_REST_MV),
    slow("myo_extensor", MYO_SELECT + 1, front_end::MYO_REST_MV),
    slow("opening", 12, 300),
    slow("motor_current", 13, 300),
];

const fn pvdf(name: &'static str, rank: u8) -> Channel {
    Channel {
        name,
        input: Input::Direct { rank },
        rest_mv: front_end::PVDF_REST_MV,
        low_mv: 0,
        high_mv: REFERENCE_MV,
    }
}

const fn strain(name: &'static str, select: u8) -> Channel {
    Channel { name, input: Input::SwitchA { select }, rest_mv: 1_650, low_mv: 50, high_mv: 3_250 }
}

const fn fsr(name: &'static str, select: u8) -> Channel {
    Channel {
        name,
        input: Input::SwitchA { select },
        rest_mv: front_end::FSR_REST_MV,
        low_mv: 100,
        high_mv: 3_250,
    }
}

/// Its amplifier clips at 3.2 V: an element that is pressed out of range must not look like one that is held still.
const fn element(name: &'static str, select: u8) -> Channel {
    Channel { name, input: Input::SwitchB { select }, rest_mv: 200, low_mv: 100, high_mv: 3_150 }
}

const fn slow(name: &'static str, select: u8, rest_mv: u32) -> Channel {
    Channel { name, input: Input::SwitchB { select }, rest_mv, low_mv: 100, high_mv: 3_250 }
}

pub fn by_name(name: &str) -> Option<usize> {
    CHANNELS.iter().position(|channel| channel.name == name)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rank {
    pub pin: &'static str,
    pub adc: u8,
}

pub const SCAN_LEN: usize = 14;
/// The rank of switch A's output. The switches come last, so they have had a whole scan to settle.
pub const RANK_SWITCH_A: usize = 12;
pub const RANK_SWITCH_B: usize = 13;

/// Inputs of one scan in order: the twelve PVDF pins, then the outputs of switches A and B.
pub const SCAN: [Rank; SCAN_LEN] = [
    Rank { pin: "PA0", adc: 0 },
    Rank { pin: "PA1", adc: 1 },
    Rank { pin: "PA4", adc: 4 },
    Rank { pin: "PA5", adc: 5 },
    Rank { pin: "PA6", adc: 6 },
    Rank { pin: "PA7", adc: 7 },
    Rank { pin: "PB0", adc: 8 },
    Rank { pin: "PB1", adc: 9 },
    Rank { pin: "PC0", adc: 10 },
    Rank { pin: "PC1", adc: 11 },
    Rank { pin: "PC2", adc: 12 },
    Rank { pin: "PC3", adc: 13 },
    Rank { pin: "PC4", adc: 14 },
    Rank { pin: "PC5", adc: 15 },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_names_and_roles_agree() {
        for (first, count, prefix, role) in [
            (PVDF, PVDF_COUNT, "pvdf_", Role::Vibration),
            (STRAIN, STRAIN_COUNT, "strain_", Role::Strain),
            (FSR, FSR_COUNT, "fsr_", Role::Force),
            (ARRAY, ARRAY_COUNT, "array_", Role::Taxel),
            (MYO_FLEXOR, 1, "myo_flexor", Role::Muscle),
            (MYO_EXTENSOR, 1, "myo_extensor", Role::Muscle),
            (OPENING, 1, "opening", Role::Hand),
            (MOTOR_CURRENT, 1, "motor_current", Role::Hand),
        ] {
            for (n, channel) in CHANNELS.iter().enumerate().skip(first).take(count) {
                let name = channel.name;
                assert!(name.starts_with(prefix) && by_name(name) == Some(n), "{name}");
                let fitted = if name == "pvdf_12" { Role::Photoelastic } else { role };
                assert_eq!((Role::of(n, false), Role::of(n, true)), (role, fitted), "{name}");
            }
        }
        assert_eq!(by_name("pvdf_13"), None);
    }

    #[test]
    fn no_two_channels_share_an_input_and_every_rest_is_honest() {
        for (i, a) in CHANNELS.iter().enumerate() {
            assert!(a.low_mv <= a.rest_mv && a.rest_mv <= a.high_mv, "{}", a.name);
            for b in &CHANNELS[i + 1..] {
                assert_ne!(a.input, b.input, "{} and {}", a.name, b.name);
                assert_ne!(a.name, b.name);
            }
        }
    }

    #[test]
    fn millivolts_survive_the_converter() {
        for mv in 0..=REFERENCE_MV {
            assert_eq!(mv_from_sample(sample_from_mv(mv)), mv);
        }
        assert_eq!(sample_from_mv(9_999), SAMPLE_MAX);
    }
}
