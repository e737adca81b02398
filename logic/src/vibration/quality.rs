//! Validity of the PVDF films' samples. All twelve are tested at once, two in a word.

use tenax_hal_shim::channel::{CHANNELS, FRAME_HZ, PVDF, PVDF_COUNT, SAMPLE_MAX, SLOW_HZ, sample_from_mv};
use tenax_hal_shim::front_end::PVDF_CUT_MV;
use tenax_hal_shim::words::Reason;

use super::Trust;
use crate::health::{Change, Limits, SensorHealth};

/// Equal samples in a row that a live film hardly ever gives; the filters have not passed the freeze yet.
const DOUBTED_AFTER: u32 = 2;

/// Output of an amplifier without its film, samples, within 40 mV.
const CUT: core::ops::RangeInclusive<u16> =
    sample_from_mv(PVDF_CUT_MV - 40)..=sample_from_mv(PVDF_CUT_MV + 40);
const CUT_AFTER: u8 = (SLOW_HZ / 2) as u8;
const LIMITS: Limits = Limits::of(&CHANNELS[PVDF], FRAME_HZ);
/// Unused top bit of a sample, so that one subtraction compares two samples in a word.
const SPARE: u16 = 1 << 15;
const _: () = assert!(SAMPLE_MAX < SPARE && LIMITS.high < SPARE);

#[derive(Clone, Debug, Default)]
pub struct PvdfQuality {
    health: [SensorHealth; PVDF_COUNT],
    last: [u16; PVDF_COUNT],
    behind: bool,
    any_lost: bool,
    cut_frames: [u8; PVDF_COUNT],
}

impl PvdfQuality {
    /// 14-bit samples of one tick. None if all are valid, the usual case; else the validity of each.
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

    /// Cut wires before the amplifier. Call it once a slow frame.
    pub fn slow(&mut self, mut changed: impl FnMut(usize, Change)) {
        let films = self.cut_frames.iter_mut().zip(&self.last).zip(&mut self.health);
        for (n, ((frames, last), health)) in films.enumerate() {
            *frames = if CUT.contains(last) { frames.saturating_add(1) } else { 0 };
            if *frames >= CUT_AFTER {
                self.any_lost = true;
                if let Some(change) = health.lose(Reason::Dead) {
                    changed(n, change);
                }
            }
        }
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
            if in_range && sample != last && health.lost.is_none() {
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
                Ok(_) if health.same >= DOUBTED_AFTER => Trust::Doubtful,
                Ok(_) => Trust::Full,
            };
            all_believed &= *trust == Trust::Full;
            self.any_lost |= health.lost.is_some();
        }
        (!all_believed).then_some(trusts)
    }
}

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

#[inline]
const fn pair(samples: &[u16; 2]) -> u32 {
    samples[0] as u32 | (samples[1] as u32) << 16
}

#[cfg(test)]
mod tests {
    use super::*;

    type Verdict = ([Trust; PVDF_COUNT], std::vec::Vec<(usize, Change)>);

    fn one_by_one(films: &mut [SensorHealth; PVDF_COUNT], samples: &[u16; PVDF_COUNT]) -> Verdict {
        let mut changes = std::vec::Vec::new();
        let trusts = core::array::from_fn(|n| {
            let (reading, change) = films[n].take(&LIMITS, samples[n]);
            changes.extend(change.map(|change| (n, change)));
            match reading {
                Err(_) => Trust::None,
                Ok(_) if films[n].same >= DOUBTED_AFTER => Trust::Doubtful,
                Ok(_) => Trust::Full,
            }
        });
        (trusts, changes)
    }

    fn agree(frames: impl Iterator<Item = [u16; PVDF_COUNT]>) {
        let (mut films, mut each) = (PvdfQuality::default(), Default::default());
        for (n, samples) in frames.enumerate() {
            let mut changes = std::vec::Vec::new();
            let trusts = films.check(&samples, |film, change| changes.push((film, change)));
            let trusts = trusts.unwrap_or([Trust::Full; PVDF_COUNT]);
            assert_eq!((trusts, changes), one_by_one(&mut each, &samples), "frame {n}: {samples:?}");
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
                (5, 36..=38) => SAMPLE_MAX + 1 + (n % 2) as u16,
                _ => noise(n, film),
            })
        }));
    }

    fn told(hz: f64, swing: f64, rest_mv: impl Fn(u32) -> u32, frames: u32) -> std::vec::Vec<(u32, Change)> {
        let (mut films, mut told) = (PvdfQuality::default(), std::vec::Vec::new());
        for n in 0..frames {
            let phase = core::f64::consts::TAU * hz * f64::from(n) / f64::from(FRAME_HZ);
            let mut samples = [9_000 + (n % 2) as u16; PVDF_COUNT];
            let rest = f64::from(sample_from_mv(rest_mv(n)));
            samples[4] = (rest + swing * phase.sin()) as u16 + (n % 2) as u16;
            films.check(&samples, |film, change| {
                assert_eq!(film, 4);
                told.push((n, change));
            });
            if n % (FRAME_HZ / SLOW_HZ) == 7 {
                films.slow(|film, change| {
                    assert_eq!(film, 4);
                    told.push((n, change));
                });
            }
        }
        told
    }

    #[test]
    fn no_vibration_is_a_cut_wire_but_one_that_beats_with_the_looks() {
        for hz in [16.0, 40.0, 50.0, 60.0, 100.0, 120.0, 150.0, 158.0, 213.0, 237.0, 300.0] {
            for swing in [100.0, 500.0, 700.0, 2_000.0, 8_000.0] {
                assert_eq!(told(hz, swing, |_| 1_650, 10_000), [], "{hz} Hz, {swing}");
            }
        }
        // The boundary: always seen at the same place of its swing.
        assert!(!told(160.0, 1_350.0, |_| 1_650, 10_000).is_empty());
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
