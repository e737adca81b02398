//! The payload of the settings' and the zero's records: words, so that a later version may append more.

use crate::setting::SettingId;
use heapless::Vec;
use tenax_hal_shim::channel::FSR_COUNT;

use crate::config::Config;
use crate::emg::model::{EmgModel, MODEL_WORDS};
use crate::force::sensor::ZERO_LIMIT_UV;

/// Bits of a settings word that hold the value; the setting's number is above them.
const VALUE_BITS: u32 = 24;
/// The settings of a record of the first format, by their place: its words have no number.
const FIRST_FORMAT: [SettingId; 5] =
    [SettingId::S1, SettingId::S2, SettingId::EmgOn, SettingId::ForceCeiling, SettingId::HebbianSlip];

/// The settings' record: a word for each one that is not at its default.
pub type SettingsBytes = Vec<u8, { 4 * SettingId::ALL.len() }>;
/// The zero's record: a word for each quadrant, uV above rest.
pub type ZeroBytes = [u8; 4 * FSR_COUNT];

/// The record of the wearer's calibration: the words of the model.
pub type EmgBytes = [u8; 4 * MODEL_WORDS];

/// The record of a wearer's calibration.
#[must_use]
pub fn of_emg(model: &EmgModel) -> EmgBytes {
    let mut bytes = [0; 4 * MODEL_WORDS];
    let (slots, _) = bytes.as_chunks_mut::<4>();
    for (slot, word) in slots.iter_mut().zip(model.to_words()) {
        *slot = word.to_le_bytes();
    }
    bytes
}

/// The calibration in a record. None if it is not a valid one.
#[must_use]
pub fn emg(bytes: &[u8]) -> Option<EmgModel> {
    let mut model = [0; MODEL_WORDS];
    let mut given = words(bytes);
    for word in &mut model {
        *word = given.next()?.cast_signed();
    }
    EmgModel::from_words(model).ok()
}

/// The record of the settings in `config`.
#[must_use]
pub fn of_settings(config: &Config) -> SettingsBytes {
    let mut bytes = Vec::new();
    for id in SettingId::ALL {
        let value = config.get(id);
        if value != id.row().default {
            let word = u32::from(id.number()) << VALUE_BITS | value.unsigned_abs();
            // It has room for all of them.
            let _fits = bytes.extend_from_slice(&word.to_le_bytes());
        }
    }
    bytes
}

/// Puts a record's settings into `config`. False if one is unknown, or its value not accepted: of what a trusted line may
/// choose the nearest is taken, for an older image had wider ranges; anything else leaves the default.
#[must_use]
pub fn restore_settings(config: &mut Config, bytes: &[u8]) -> bool {
    let mut all = true;
    // It decides which values of the others are accepted.
    let trusted = u32::from(SettingId::LineTrusted.number()) << VALUE_BITS | 1;
    config.line_trusted |= words(bytes).any(|word| word == trusted);
    for (place, word) in words(bytes).enumerate() {
        let value = (word & ((1 << VALUE_BITS) - 1)).cast_signed();
        let id = match (word >> VALUE_BITS) as u8 {
            0 => FIRST_FORMAT.get(place).copied(),
            number => SettingId::from_number(number),
        };
        // S2 may be what a stroke has measured.
        all &= id.is_some_and(|id| match config.set(id, value) {
            Ok(()) => true,
            Err(_) if id == SettingId::S2 && config.measured(value) => true,
            Err(range) => {
                // A flag is no size, and what no image accepted is damaged.
                if id.row().unit != "flag" && id.row().range_in_force(true).contains(&value) {
                    let _accepted = config.set(id, value.max(*range.start()).min(*range.end()));
                }
                false
            }
        });
    }
    all
}

/// The record of the force sensor's zero.
#[must_use]
pub fn of_zero(zero_uv: &[i32; FSR_COUNT]) -> ZeroBytes {
    let mut bytes = [0; 4 * FSR_COUNT];
    let (slots, _) = bytes.as_chunks_mut::<4>();
    for (slot, uv) in slots.iter_mut().zip(zero_uv) {
        *slot = uv.to_le_bytes();
    }
    bytes
}

/// The zeros in a record, uV above rest. None if one is no offset of a working sensor.
#[must_use]
pub fn zero(bytes: &[u8]) -> Option<[i32; FSR_COUNT]> {
    let mut zero_uv = [0; FSR_COUNT];
    let mut given = words(bytes);
    for slot in &mut zero_uv {
        *slot = given.next()?.cast_signed();
    }
    let allowed = zero_uv.iter().all(|uv| uv.unsigned_abs() <= ZERO_LIMIT_UV.unsigned_abs());
    allowed.then_some(zero_uv)
}

/// The whole words of `bytes`.
fn words(bytes: &[u8]) -> impl Iterator<Item = u32> {
    bytes.as_chunks::<4>().0.iter().map(|chunk| u32::from_le_bytes(*chunk))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    fn word(number: u8, value: u32) -> [u8; 4] {
        (u32::from(number) << 24 | value).to_le_bytes()
    }

    #[test]
    fn every_accepted_setting_comes_back() {
        let mut changed = Config::default();
        for id in SettingId::ALL {
            let row = id.row();
            for value in [row.min, row.max] {
                assert!(changed.set(id, value).is_ok());
                let mut back = Config::default();
                assert!(restore_settings(&mut back, &of_settings(&changed)));
                assert_eq!(back, changed, "{} = {value}", row.name);
            }
        }
        assert_eq!(
            of_settings(&Config::default()).len(),
            0,
            "a default is not kept: a later image may know better"
        );
    }

    // Shows B5.
    #[test]
    fn a_value_that_is_not_accepted_and_a_setting_that_is_unknown_leave_the_others() {
        let mut config = Config::default();
        let bytes = [word(1, 140), word(2, 99_999), word(250, 1), word(10, 700)].concat();
        assert!(!restore_settings(&mut config, &bytes));
        let mut expected = Config::default();
        assert!(expected.set(SettingId::S1, 140).is_ok() && expected.set(SettingId::Loaded, 700).is_ok());
        assert_eq!(config, expected);
    }

    #[test]
    fn a_trusted_lines_values_come_back_with_it_and_not_without() {
        let mut config = Config::default();
        assert!(!restore_settings(&mut config, &word(1, 1_500)));
        assert!(restore_settings(&mut config, &[word(1, 1_500), word(40, 1)].concat()));
        assert_eq!((config.get(SettingId::S1), config.line_trusted), (1_500, true));
    }

    #[test]
    fn a_value_of_an_older_images_range_comes_back_as_the_nearest() {
        let mut config = Config::default();
        assert!(!restore_settings(&mut config, &[word(4, 5_000), word(42, 7)].concat()));
        assert_eq!((config.get(SettingId::ForceCeiling), config.no_wearer), (20_000, false));
    }

    #[test]
    fn a_surface_that_was_stroked_comes_back_where_a_person_may_not_choose_it() {
        let mut config = Config::default();
        assert!(config.measured(640) && !Config::default().measured(901));
        assert_eq!(config.set(SettingId::S2, 630), Err(SettingId::S2.row().range()));
        assert_eq!(config.set(SettingId::S2, 640), Ok(()), "a file that was exported here is imported here");
        let mut back = Config::default();
        assert!(restore_settings(&mut back, &of_settings(&config)));
        assert_eq!(back, config);
    }

    #[test]
    fn a_record_of_the_first_format_is_read_by_place() {
        let mut config = Config::default();
        let words = [120u32, 350, 200, 30_000, 45];
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        assert!(restore_settings(&mut config, &bytes));
        assert_eq!(FIRST_FORMAT.map(|id| config.get(id) as u32), words);
        assert!(restore_settings(&mut config, &98u32.to_le_bytes()), "an even older one has fewer");
        assert_eq!(config.get(SettingId::S1), 98);
        assert!(restore_settings(&mut config, &[]));
    }

    #[test]
    fn a_calibration_comes_back_or_is_refused() {
        let model = EmgModel::of_uv([50_000; 2], [400_000, 70_000], [80_000, 600_000]).unwrap();
        let bytes = of_emg(&model);
        assert_eq!(emg(&bytes), Some(model));
        assert_eq!(emg(&bytes[4..]), None);
        assert_eq!(emg(&[0; 40]), None);
        assert_eq!(emg(&[0xff; 40]), None);
    }

    #[test]
    fn a_zero_comes_back_or_is_refused() {
        let offsets = [0, -60_000, 60_000, -1];
        assert_eq!(zero(&of_zero(&offsets)), Some(offsets));
        assert_eq!(zero(&of_zero(&[0, 0, 60_001, 0])), None);
        assert_eq!(zero(&of_zero(&[i32::MIN; 4])), None);
        assert_eq!(zero(&[0; 12]), None);
    }
}
