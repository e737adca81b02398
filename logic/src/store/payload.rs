//! What the records hold of settings and zero: words, so that a later version may append more.

use tenax_hal_shim::channel::{FSR_COUNT, mv_from_sample};
use tenax_hal_shim::wire::Setting;

use crate::config::Config;
use crate::forces::ZERO_LIMIT_UV;

/// Settings that are kept.
const SETTINGS: usize = 5;

/// The settings' record: a word each, in the units and in the order of [`Setting`].
pub type SettingsBytes = [u8; 4 * SETTINGS];
/// The zero's record: a word for each quadrant, uV above rest.
pub type ZeroBytes = [u8; 4 * FSR_COUNT];

/// Every setting, as it is in `config`.
fn settings(config: &Config) -> [Setting; SETTINGS] {
    [
        // A sample has 14 bits: a millivolt comes back as it was set, and none is above 3 300.
        Setting::S1Mv(mv_from_sample(config.vibration.s1) as u16),
        Setting::S2Permille(config.friction.s2_permille),
        Setting::MyoOnMv(config.gate.on_mv),
        Setting::ForceCeilingMn(config.grip.ceiling_mn.max(0).unsigned_abs()),
        Setting::NetworkSlipPermille(config.touch.slip_permille),
    ]
}

/// The same settings with other values, from a record's words. Fewer than there are now is an earlier version's record.
fn settings_of(words: &[u32]) -> impl Iterator<Item = Option<Setting>> {
    let small = |word: u32| u16::try_from(word).ok();
    words.iter().take(SETTINGS).enumerate().map(move |(n, &word)| {
        Some(match n {
            0 => Setting::S1Mv(small(word)?),
            1 => Setting::S2Permille(small(word)?),
            2 => Setting::MyoOnMv(small(word)?),
            3 => Setting::ForceCeilingMn(word),
            _ => Setting::NetworkSlipPermille(small(word)?),
        })
    })
}

/// The record of the settings in `config`.
#[must_use]
pub fn of_settings(config: &Config) -> SettingsBytes {
    bytes_of(settings(config).map(|setting| setting.describe().2))
}

/// Puts a record's settings into `config`. False if a value is not allowed; that one is left as it was.
#[must_use]
pub fn restore_settings(config: &mut Config, bytes: &[u8]) -> bool {
    let mut words = [0; SETTINGS];
    let given = words_of(bytes, &mut words);
    let mut all = true;
    for setting in settings_of(given) {
        all &= setting.is_some_and(|setting| config.set(setting));
    }
    all
}

/// The record of the force sensor's zero.
#[must_use]
pub fn of_zero(zero_uv: &[i32; FSR_COUNT]) -> ZeroBytes {
    bytes_of(zero_uv.map(i32::cast_unsigned))
}

/// A record's zero. None if it is no offset of a working sensor.
#[must_use]
pub fn zero(bytes: &[u8]) -> Option<[i32; FSR_COUNT]> {
    let mut words = [0; FSR_COUNT];
    let complete = words_of(bytes, &mut words).len() == FSR_COUNT;
    let zero_uv = words.map(u32::cast_signed);
    let allowed = zero_uv.iter().all(|uv| uv.unsigned_abs() <= ZERO_LIMIT_UV.unsigned_abs());
    (complete && allowed).then_some(zero_uv)
}

fn bytes_of<const WORDS: usize, const BYTES: usize>(words: [u32; WORDS]) -> [u8; BYTES] {
    const { assert!(BYTES == 4 * WORDS) };
    let mut bytes = [0; BYTES];
    let (slots, _) = bytes.as_chunks_mut::<4>();
    for (slot, word) in slots.iter_mut().zip(words) {
        *slot = word.to_le_bytes();
    }
    bytes
}

/// The whole words of `bytes`, as many as there are places for.
fn words_of<'a>(bytes: &[u8], words: &'a mut [u32]) -> &'a [u32] {
    let (chunks, _) = bytes.as_chunks::<4>();
    let count = chunks.len().min(words.len());
    for (word, chunk) in words.iter_mut().zip(chunks) {
        *word = u32::from_le_bytes(*chunk);
    }
    words.get(..count).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_allowed_setting_comes_back() {
        // One of each: they are as many as a record has.
        for setting in settings(&Config::default()) {
            let (.., allowed) = setting.describe();
            for value in allowed.step_by(7) {
                let small = value as u16;
                let set = match setting {
                    Setting::S1Mv(_) => Setting::S1Mv(small),
                    Setting::S2Permille(_) => Setting::S2Permille(small),
                    Setting::MyoOnMv(_) => Setting::MyoOnMv(small),
                    Setting::ForceCeilingMn(_) => Setting::ForceCeilingMn(value),
                    Setting::NetworkSlipPermille(_) => Setting::NetworkSlipPermille(small),
                };
                let (mut config, mut back) = (Config::default(), Config::default());
                assert!(config.set(set));
                assert!(restore_settings(&mut back, &of_settings(&config)));
                assert_eq!(back, config, "{set:?}");
            }
        }
    }

    #[test]
    fn a_value_that_is_not_allowed_leaves_the_others() {
        let mut config = Config::default();
        let mut bytes = of_settings(&Config::default());
        bytes[..4].copy_from_slice(&700u32.to_le_bytes());
        bytes[4..8].copy_from_slice(&0x0001_0190u32.to_le_bytes());
        assert!(!restore_settings(&mut config, &bytes));
        let mut expected = Config::default();
        assert!(expected.set(Setting::S1Mv(700)));
        assert_eq!(config, expected);
    }

    #[test]
    fn an_earlier_or_later_record_sets_what_both_know() {
        let mut config = Config::default();
        let mut longer = of_settings(&Config::default()).to_vec();
        longer[0] = 99;
        longer.extend([1, 2, 3, 4]);
        assert!(restore_settings(&mut config, &longer));
        assert_eq!(mv_from_sample(config.vibration.s1), 99);
        assert!(restore_settings(&mut config, &98u32.to_le_bytes()));
        assert_eq!(mv_from_sample(config.vibration.s1), 98);
        assert!(restore_settings(&mut config, &[]));
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
