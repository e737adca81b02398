//! Payloads of the records: words, so that a later version may append more.

use crate::setting::SettingId;
use heapless::Vec;
use tenax_hal_shim::channel::FSR_COUNT;

use crate::config::Config;
use crate::emg::model::{EmgModel, MODEL_WORDS};
use crate::force::sensor::ZERO_LIMIT_UV;

const VALUE_BITS: u32 = 24;
pub type SettingsBytes = Vec<u8, { 4 * SettingId::ALL.len() }>;
pub type ZeroBytes = [u8; 4 * FSR_COUNT];
pub type EmgBytes = [u8; 4 * MODEL_WORDS];

pub fn of_emg(model: &EmgModel) -> EmgBytes {
    bytes_of(model.to_words())
}

pub fn emg(bytes: &[u8]) -> Option<EmgModel> {
    // What a record of an earlier version has no word for is not known.
    let mut own = [0; MODEL_WORDS];
    own.iter_mut().zip(words(bytes)).for_each(|(slot, word)| *slot = word.cast_signed());
    EmgModel::from_words(own).ok()
}

pub fn of_settings(config: &Config) -> SettingsBytes {
    let mut bytes = Vec::new();
    for id in SettingId::ALL {
        let value = config.get(id);
        if value != id.row().default {
            let word = u32::from(id.number()) << VALUE_BITS | value.unsigned_abs();
            let _fits = bytes.extend_from_slice(&word.to_le_bytes());
        }
    }
    bytes
}

/// False if a setting is unknown or its value not accepted; its default stays.
pub fn restore_settings(config: &mut Config, bytes: &[u8]) -> bool {
    let mut all = true;
    for word in words(bytes) {
        let value = (word & ((1 << VALUE_BITS) - 1)).cast_signed();
        let id = SettingId::from_number((word >> VALUE_BITS) as u8);
        all &= id.is_some_and(|id| config.set(id, value).is_ok());
    }
    all
}

pub fn of_zero(zero_uv: &[i32; FSR_COUNT]) -> ZeroBytes {
    bytes_of(*zero_uv)
}

pub fn zero(bytes: &[u8]) -> Option<[i32; FSR_COUNT]> {
    let zero_uv = words_of::<FSR_COUNT>(bytes)?;
    let allowed = zero_uv.iter().all(|uv| uv.unsigned_abs() <= ZERO_LIMIT_UV.unsigned_abs());
    allowed.then_some(zero_uv)
}

fn bytes_of<const WORDS: usize, const BYTES: usize>(words: [i32; WORDS]) -> [u8; BYTES] {
    let mut bytes = [0; BYTES];
    let (slots, _) = bytes.as_chunks_mut::<4>();
    for (slot, word) in slots.iter_mut().zip(words) {
        *slot = word.to_le_bytes();
    }
    bytes
}

fn words_of<const WORDS: usize>(bytes: &[u8]) -> Option<[i32; WORDS]> {
    Some(bytes.as_chunks::<4>().0.first_chunk::<WORDS>()?.map(i32::from_le_bytes))
}

fn words(bytes: &[u8]) -> impl Iterator<Item = u32> {
    bytes.as_chunks::<4>().0.iter().map(|chunk| u32::from_le_bytes(*chunk))
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn a_calibration_and_a_zero_come_back_or_are_refused() {
        let model = EmgModel::of_uv([50_000; 2], [400_000, 70_000], [80_000, 600_000]).unwrap();
        let bytes = of_emg(&model);
        assert_eq!(emg(&bytes), Some(model));
        assert_eq!([&bytes[4..], &bytes[..36], &[0; 44], &[0xff; 44]].map(emg), [None; 4]);
        assert_eq!(emg(&bytes[..40]), Some(model), "of a version that kept no spread");
        let offsets = [0, -60_000, 60_000, -1];
        assert_eq!(zero(&of_zero(&offsets)), Some(offsets));
        assert_eq!([[0, 0, 60_001, 0], [i32::MIN; 4]].map(|uv| zero(&of_zero(&uv))), [None; 2]);
        assert_eq!(zero(&[0; 12]), None);
    }
}
