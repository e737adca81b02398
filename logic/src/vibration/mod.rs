//! S1: slip from the vibration of the PVDF films, 20 to 150 Hz (Prosthesis, sections 4 and 5). An impact rings
//! above the band and is over soon, so S1 needs a loud band with a quieter sound above it, or one that stays. What
//! stands for longer than a slip is [`noise`]: S1 needs several times as much.

pub mod detector;
mod film;
pub mod hum;
mod noise;
pub mod quality;
pub mod settings;
pub mod sliding;

use tenax_hal_shim::channel::PVDF_COUNT;
use tenax_hal_shim::wire::TickRecord;

pub(crate) use self::film::Q;
use self::film::{Band, ENVELOPE, Film, Levels};
use self::hum::{Mains, Turn};
use self::noise::Noise;
use self::sliding::{Hand, Sliding};
use crate::evidence::Sound;
use crate::vibration::settings::VibrationConfig;

/// Frames for which a loud vibration must ring to be an impact; a sliding object rings for single ticks.
const IMPACT_RINGS: u32 = 12;
const PEAK_SHIFT: u32 = 8;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trust {
    #[default]
    Full,
    Doubtful,
    None,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Vibration {
    pub level: u16,
    /// Above the threshold, and no impact.
    pub s1: bool,
    /// Rings above the slip band, and not for longer than an impact.
    pub impact: bool,
    pub slides: bool,
    pub masked: u16,
}

#[derive(Clone, Debug, Default)]
pub struct VibrationDetector {
    films: [Film; PVDF_COUNT],
    band: Band,
    mains: Mains,
    envelopes: [i32; PVDF_COUNT],
    all_primed: bool,
    above: i32,
    loud_frames: u32,
    ringing_frames: u32,
    /// Largest envelope since the vibration became loud, slowly decaying, and the loud frames until it.
    peak: i32,
    peak_at: u32,
    rang_frames: u32,
    s1: bool,
    noise: Noise,
    sliding: Sliding,
    slides: bool,
}

impl VibrationDetector {
    /// 14-bit samples of one tick. `trusts` None: all are valid.
    #[inline(always)]
    pub fn process(
        &mut self,
        config: &VibrationConfig,
        samples: &[u16; PVDF_COUNT],
        trusts: Option<&[Trust; PVDF_COUNT]>,
    ) -> Vibration {
        let mains = self.mains.turn();
        if self.noise.left_out != 0 {
            let trusts = self.without_noisy(trusts);
            let loudest = self.process_each(samples, &trusts, mains);
            return self.judge(config, loudest);
        }
        let loudest = match trusts {
            None if self.all_primed => self.process_all(samples, mains),
            None => self.process_each(samples, &[Trust::Full; PVDF_COUNT], mains),
            Some(trusts) => self.process_each(samples, trusts, mains),
        };
        self.judge(config, loudest)
    }

    #[inline(never)]
    fn without_noisy(&self, trusts: Option<&[Trust; PVDF_COUNT]>) -> [Trust; PVDF_COUNT] {
        let mut trusts = *trusts.unwrap_or(&[Trust::Full; PVDF_COUNT]);
        let noisy = trusts.iter_mut().enumerate().filter(|(film, _)| self.noise.left_out >> film & 1 != 0);
        noisy.filter(|(_, trust)| **trust == Trust::Full).for_each(|(_, trust)| *trust = Trust::Doubtful);
        trusts
    }

    /// Another sensor takes the film's place, and the jump is no vibration.
    pub fn forget(&mut self, film: usize) {
        if let Some(film) = self.films.get_mut(film) {
            *film = Film::default();
            self.all_primed = false;
        }
    }

    #[inline]
    fn process_all(&mut self, samples: &[u16; PVDF_COUNT], mains: Turn) -> Levels {
        let mut loudest = Levels::default();
        for ((film, own), &sample) in self.films.iter_mut().zip(&mut self.envelopes).zip(samples) {
            let levels = film.process(&self.band, sample, mains);
            *own = levels.envelope;
            loudest.raise(levels);
        }
        loudest
    }

    #[inline(never)]
    fn process_each(
        &mut self,
        samples: &[u16; PVDF_COUNT],
        trusts: &[Trust; PVDF_COUNT],
        mains: Turn,
    ) -> Levels {
        let mut loudest = Levels::default();
        self.all_primed = true;
        let films = self.films.iter_mut().zip(&mut self.envelopes).zip(samples).zip(trusts);
        for (((film, own), &sample), &trust) in films {
            // Suspect PVDF channels are masked, their held envelope included.
            *own = 0;
            if trust == Trust::None {
                // Primed anew when it comes back: its jump is no vibration.
                *film = Film::default();
                self.all_primed = false;
                continue;
            }
            film.prime(sample);
            let levels = film.process(&self.band, sample, mains);
            if trust == Trust::Full {
                *own = levels.envelope;
                loudest.raise(levels);
            }
        }
        loudest
    }

    fn judge(&mut self, config: &VibrationConfig, loudest: Levels) -> Vibration {
        let Levels { envelope, above } = loudest;
        let asked = self.mains.asks();
        if let Some(film) = asked.and_then(|film| self.films.get_mut(film)) {
            self.mains.adapt(&mut film.hum, film.band);
        }
        let above = ENVELOPE.process(&mut self.above, above);
        let set = i32::from(config.s1) << Q;
        let on = set + self.noise.raised;
        // Half the threshold keeps it on: the envelope of one slip has dips.
        let loud = envelope > if self.s1 { on - on.min(set) / 2 } else { on };
        self.loud_frames = if loud { self.loud_frames.saturating_add(1) } else { 0 };
        // A quiet film's noise is mostly above the band too, but no impact is as quiet.
        let rings = above > (i32::from(config.impact_level) << Q).min(on / 2)
            && i64::from(above) * 1_000 > i64::from(envelope) * i64::from(config.impact_permille);
        self.ringing_frames = if rings { self.ringing_frames.saturating_add(1) } else { 0 };
        self.rang_frames = if loud { self.rang_frames.saturating_add(rings.into()) } else { 0 };
        self.peak -= self.peak >> PEAK_SHIFT;
        if !loud || envelope >= self.peak {
            self.peak = envelope;
            self.peak_at = self.loud_frames;
        }
        // An impact is loudest as it begins, and short.
        let lasts = self.loud_frames >= config.impact_frames && 4 * self.peak_at >= 3 * config.impact_frames;
        let impact = rings || self.rang_frames >= IMPACT_RINGS;
        self.s1 = loud && (self.s1 || !impact || lasts);
        Vibration {
            level: (envelope >> Q).clamp(0, i32::from(TickRecord::VIBRATION_MAX)) as u16,
            s1: self.s1,
            impact: rings && self.ringing_frames < config.impact_frames,
            slides: self.slides,
            masked: self.noise.noisy,
        }
    }

    /// Call it once a slow frame.
    #[inline(never)]
    pub fn learn_noise(&mut self, config: &VibrationConfig, empty_hand: bool) {
        self.noise.step(&self.films, config.s1, empty_hand);
        self.mains.tune(config.mains_60_hz ^ self.noise.other_mains);
    }

    pub const fn sound(&self) -> Sound {
        self.sliding.sound
    }

    pub fn slow(&mut self, hand: Hand) {
        self.slides = self.sliding.step(&self.envelopes, self.above, &Hand { loud: self.s1, ..hand });
    }

    /// What the films hear is no slip.
    pub fn refute(&mut self) {
        self.sliding.refute(&self.envelopes);
        self.noise.refute(&self.envelopes);
    }

    /// Envelopes in the slip band, Q16 samples; 0 of a film without a number.
    pub const fn envelopes(&self) -> &[i32; PVDF_COUNT] {
        &self.envelopes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use core::f64::consts::PI;
    use std::vec::Vec;
    use tenax_hal_shim::channel::{FRAME_HZ, SAMPLE_MAX};

    fn tick(detector: &mut VibrationDetector, sample: u16, trust: Trust) -> Vibration {
        detector.process(&Config::default().vibration, &[sample; PVDF_COUNT], Some(&[trust; PVDF_COUNT]))
    }

    fn levels(samples: &[u16]) -> Vec<Vibration> {
        let mut detector = VibrationDetector::default();
        samples.iter().map(|&sample| tick(&mut detector, sample, Trust::Full)).collect()
    }

    fn tone(hz: f64, amplitude: f64, decay_s: f64, frames: u32) -> Vec<u16> {
        (0..frames)
            .map(|n| {
                let t = f64::from(n) / f64::from(FRAME_HZ);
                (8_192.0 + amplitude * (-t / decay_s).exp() * (2.0 * PI * hz * t).sin()) as u16
            })
            .collect()
    }

    #[test]
    fn a_tone_in_the_band_is_slip_and_any_steady_voltage_is_not() {
        assert!(levels(&tone(60.0, 3_000.0, 1e9, 400)).iter().any(|v| v.s1));
        for steady in [0, 1, 8_192, SAMPLE_MAX] {
            assert!(levels(&[steady; 4_000]).iter().all(|v| !v.s1 && v.level == 0));
        }
    }

    #[test]
    fn an_impact_is_not_slip_though_it_is_louder() {
        let impact = levels(&tone(300.0, 7_000.0, 0.006, 400));
        assert!(impact.iter().map(|v| v.level).max() > Some(Config::default().vibration.s1));
        assert!(impact.iter().all(|v| !v.s1));
    }

    #[test]
    fn a_high_tone_that_stays_is_slip_after_the_time_that_an_impact_lasts() {
        let seen = levels(&tone(300.0, 7_000.0, 1e9, 400));
        let first_loud = seen.iter().position(|v| v.level > 600).unwrap();
        let first_s1 = seen.iter().position(|v| v.s1).unwrap();
        let impact_frames = Config::default().vibration.impact_frames as usize;
        assert!((first_s1 - first_loud).abs_diff(impact_frames) <= 10, "{first_loud} {first_s1}");
    }

    #[test]
    fn a_film_that_comes_back_is_primed_anew() {
        let mut detector = VibrationDetector::default();
        for (trust, sample) in [(Trust::Full, 12_000), (Trust::None, 0), (Trust::Full, 12_000)] {
            for _ in 0..200 {
                assert_eq!(tick(&mut detector, sample, trust), Vibration::default());
            }
        }
    }
}
