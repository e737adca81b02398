use core::f64::consts::TAU;
use std::vec::Vec;

use super::*;
use crate::config::Config;
use crate::vibration::VibrationDetector;
use crate::vibration::settings::VibrationConfig;

fn sample(x: f64, noise: u32) -> u16 {
    (8_192.0 + x + f64::from(noise % 1_000) / 1_000.0) as u16
}

fn envelopes(mains_60_hz: bool, for_s: f64, heard: impl Fn(f64) -> f64) -> Vec<f64> {
    let config = VibrationConfig { mains_60_hz, ..Config::default().vibration };
    let mut detector = VibrationDetector::default();
    let mut noise = 1_u32;
    (0..(for_s * f64::from(FRAME_HZ)) as u32)
        .map(|n| {
            let t_s = f64::from(n) / f64::from(FRAME_HZ);
            let samples = core::array::from_fn(|film| {
                noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                sample(heard(t_s) * (0.4 + 0.1 * film as f64), noise >> 8)
            });
            detector.process(&config, &samples, None);
            detector.envelopes().iter().map(|&e| f64::from(e) / 65_536.0).sum::<f64>() / PVDF_COUNT as f64
        })
        .collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn left(hum: impl Fn(f64) -> f64) -> f64 {
    let all = envelopes(false, 6.0, hum);
    mean(&all[8_000..]) / mean(&all[60..120])
}

#[test]
fn hum_goes_also_where_the_mains_is_half_a_hertz_off() {
    for hz in [49.5, 49.8, 50.0, 50.2, 50.5] {
        let left = left(|t_s| 30.0 * (TAU * hz * t_s + 1.0).sin());
        assert!(left < 0.08, "{hz} Hz: {left}");
    }
}

#[test]
fn hum_of_60_hz_goes_where_the_mains_is_said_to_be_that() {
    for (mains_60_hz, most) in [(true, 0.08), (false, 1.1)] {
        for hz in [59.5, 60.0, 60.5] {
            let all = envelopes(mains_60_hz, 9.0, |t_s| 30.0 * (TAU * hz * t_s + 1.0).sin());
            let left = mean(&all[14_000..]) / mean(&all[60..120]);
            assert!(left < most && (mains_60_hz || left > 0.5), "{hz} Hz, {mains_60_hz}: {left}");
        }
    }
}

#[test]
fn hum_that_grows_and_shrinks_is_followed() {
    // By a third, in 2 s: somebody walks past a lamp.
    let left = left(|t_s| 30.0 * (1.0 + 0.33 * (TAU * 0.5 * t_s).sin()) * (TAU * 50.0 * t_s).sin());
    assert!(left < 0.25, "{left}");
}

#[test]
fn a_burst_of_slip_is_heard_as_loud_as_without_hum() {
    // The bump of a place that lets go: 25 ms, at 5 s.
    let bump = |t_s: f64| {
        let since = t_s - 5.0;
        if (0.0..0.025).contains(&since) { 40.0 * (TAU * 40.0 * since).sin() } else { 0.0 }
    };
    let peak = |all: &[f64]| all[10_000..10_200].iter().copied().fold(0.0, f64::max);
    let with_hum = peak(&envelopes(false, 5.2, |t_s| 30.0 * (TAU * 50.2 * t_s).sin() + bump(t_s)));
    let without = peak(&envelopes(false, 5.2, bump));
    assert!((with_hum / without - 1.0).abs() < 0.15, "{with_hum} of {without}");
}

#[test]
fn the_oscillator_neither_grows_nor_dies() {
    let mut hum = Mains::default();
    // An hour of a frequency that is pushed to both ends.
    for n in 0..7_200_000_u32 {
        hum.turn();
        hum.asks();
        hum.step = step(50.0 + (f64::from(n % 20_000) / 10_000.0 - 1.0));
        let Turn { cosine, sine } = hum.now;
        let size = f64::from(cosine).hypot(f64::from(sine)) / f64::from(AMPLITUDE);
        assert!((0.9..1.1).contains(&size), "{size} after {n}");
    }
}

#[test]
fn no_error_makes_a_weight_leave_its_range() {
    let (mut hum, mut film) = (Mains::default(), Weights::default());
    for n in 0..1_000_000_u32 {
        let now = hum.turn();
        hum.asks();
        hum.adapt(false, &mut film, if now.cosine > 0 { i32::MAX } else { i32::MIN });
        assert!(film.heard(now).abs() < 1 << 29, "{n}");
    }
}
