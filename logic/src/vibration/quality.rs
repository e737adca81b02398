//! The PVDF films: which of their samples are valid, suspect or none.
//!
//! Nearly every sample of nearly every film is plain: in range, different from the last, of a film that is not lost. So
//! all twelve are asked at once, two in a word, and only if one is not plain is each looked at by itself.

use tenax_hal_shim::channel::{CHANNELS, FRAME_HZ, PVDF, PVDF_COUNT, SAMPLE_MAX};

use super::Trust;
use crate::health::{Change, Limits, SensorHealth};

/// Equal samples in a row that a live film, with 30 of them rms of noise, hardly ever gives: before the jump of a film
/// that freezes has come through its filters, the film is suspect.
const DOUBTED_AFTER: u32 = 2;

const LIMITS: Limits = Limits::of(&CHANNELS[PVDF], FRAME_HZ);

/// The unused top bit of a sample, so that one subtraction compares two samples in a word.
const SPARE: u16 = 1 << 15;
const _: () = assert!(SAMPLE_MAX < SPARE && LIMITS.high < SPARE);

/// The twelve films.
#[derive(Clone, Debug, Default)]
pub struct PvdfQuality {
    health: [SensorHealth; PVDF_COUNT],
    last: [u16; PVDF_COUNT],
    /// Whether `health` has not been told of `last`, which was plain.
    behind: bool,
    any_lost: bool,
}

impl PvdfQuality {
    /// Takes every film's 14-bit sample of one tick. None if all are valid, the usual case; else the validity of
    /// each. Calls `changed` for a film that was lost or is back.
    #[inline]
    pub fn check(
        &mut self,
        samples: &[u16; PVDF_COUNT],
        changed: impl FnMut(usize, Change),
    ) -> Option<[Trust; PVDF_COUNT]> {
        if !self.any_lost && are_plain(samples, &self.last) {
            self.last = *samples;
            self.behind = true;
            return None;
        }
        self.check_each(samples, changed)
    }

    #[inline(never)]
    fn check_each(
        &mut self,
        samples: &[u16; PVDF_COUNT],
        mut changed: impl FnMut(usize, Change),
    ) -> Option<[Trust; PVDF_COUNT]> {
        let behind = core::mem::take(&mut self.behind);
        let mut trusts = [Trust::Full; PVDF_COUNT];
        let mut all_believed = true;
        self.any_lost = false;
        let films = self.health.iter_mut().zip(&mut self.last).zip(samples).zip(&mut trusts);
        for (n, (((health, last), &sample), trust)) in films.enumerate() {
            let last = core::mem::replace(last, sample);
            let in_range = (LIMITS.low..=LIMITS.high).contains(&sample);
            if in_range && sample != last && !health.is_lost() {
                health.was_plain(sample);
                continue;
            }
            if behind {
                health.was_plain(last);
            }
            let (reading, change) = health.take(&LIMITS, sample);
            if let Some(change) = change {
                changed(n, change);
            }
            *trust = match reading {
                Err(_) => Trust::None,
                Ok(_) if health.same() >= DOUBTED_AFTER => Trust::Doubtful,
                Ok(_) => Trust::Full,
            };
            all_believed &= *trust == Trust::Full;
            self.any_lost |= health.is_lost();
        }
        (!all_believed).then_some(trusts)
    }
}

/// Whether every sample is in range and different from the last.
#[inline]
fn are_plain(samples: &[u16; PVDF_COUNT], last: &[u16; PVDF_COUNT]) -> bool {
    const LOW: u32 = pair(&[LIMITS.low; 2]);
    const HIGH: u32 = pair(&[LIMITS.high | SPARE; 2]);
    const SPARES: u32 = pair(&[SPARE; 2]);
    const NOT_ZERO: u32 = pair(&[SPARE - 1; 2]);
    let (samples, _) = samples.as_chunks();
    let (last, _) = last.as_chunks();
    let plain = samples.iter().zip(last).fold(SPARES, |plain, (two, last)| {
        let two = pair(two);
        // In each half the highest bit stays where the difference is not negative, and is reached where a sum is not 0. A
        // sample that uses that bit itself is out of range, and may take a bit from the other half, never give one.
        plain
            & (two | SPARES).wrapping_sub(LOW)
            & HIGH.wrapping_sub(two)
            & (two ^ pair(last)).wrapping_add(NOT_ZERO)
    });
    plain == SPARES
}

/// Two samples in a word.
#[inline]
const fn pair(samples: &[u16; 2]) -> u32 {
    samples[0] as u32 | (samples[1] as u32) << 16
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same, film by film.
    #[derive(Default)]
    struct OneByOne([SensorHealth; PVDF_COUNT]);

    impl OneByOne {
        fn check(
            &mut self,
            samples: &[u16; PVDF_COUNT],
        ) -> ([Trust; PVDF_COUNT], std::vec::Vec<(usize, Change)>) {
            let mut changes = std::vec::Vec::new();
            let trusts = core::array::from_fn(|n| {
                let (reading, change) = self.0[n].take(&LIMITS, samples[n]);
                changes.extend(change.map(|change| (n, change)));
                match reading {
                    Err(_) => Trust::None,
                    Ok(_) if self.0[n].same() >= DOUBTED_AFTER => Trust::Doubtful,
                    Ok(_) => Trust::Full,
                }
            });
            (trusts, changes)
        }
    }

    fn agree(frames: impl Iterator<Item = [u16; PVDF_COUNT]>) {
        let (mut films, mut one_by_one) = (PvdfQuality::default(), OneByOne::default());
        for (n, samples) in frames.enumerate() {
            let mut changes = std::vec::Vec::new();
            let trusts = films.check(&samples, |film, change| changes.push((film, change)));
            let trusts = trusts.unwrap_or([Trust::Full; PVDF_COUNT]);
            assert_eq!((trusts, changes), one_by_one.check(&samples), "frame {n}: {samples:?}");
        }
    }

    #[test]
    fn all_at_once_is_the_same_as_one_by_one_through_every_fault() {
        let noise = |n: u32, film: usize| 8_000 + (n.wrapping_mul(0x9E37_79B9 + film as u32) >> 26) as u16;
        agree((0..20_000).map(|n| {
            core::array::from_fn(|film| match (film, n / 100 % 80) {
                (0, 10..=11) => 0,
                (1, 12..=40) => SAMPLE_MAX,
                (2, 5..=79) => 7_777,
                (3, 20) => 0,
                (4, 33..=34) if n % 2 == 0 => 0,
                _ => noise(n, film),
            })
        }));
    }

    #[test]
    fn every_end_of_the_range_is_seen_in_either_half() {
        let ends = [0, 1, LIMITS.low, LIMITS.high, LIMITS.high + 1, SAMPLE_MAX, SPARE - 1, SPARE, u16::MAX];
        for a in ends {
            for b in ends {
                for place in 0..PVDF_COUNT - 1 {
                    let mut samples = [9_000; PVDF_COUNT];
                    (samples[place], samples[place + 1]) = (a, b);
                    let expected = samples.iter().all(|&s| (LIMITS.low..=LIMITS.high).contains(&s));
                    assert_eq!(are_plain(&samples, &[8_999; PVDF_COUNT]), expected, "{samples:?}");
                    assert!(!are_plain(&samples, &samples));
                }
            }
        }
    }
}
