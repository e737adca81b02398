use core::f64::consts::TAU;
use std::vec::Vec;

use tenax_hal_shim::channel::SLOW_HZ;

use super::*;
use crate::config::Config;
use crate::vibration::settings::VibrationConfig;
use crate::vibration::{Vibration, VibrationDetector};

fn sample(x: f64, noise: u32) -> u16 {
    (8_192.0 + x + f64::from(noise % 1_000) / 1_000.0) as u16
}

fn envelopes(mains_60_hz: bool, for_s: f64, heard: impl Fn(f64) -> f64) -> Vec<f64> {
    seen(|_| mains_60_hz, for_s, heard).into_iter().map(|(envelope, _)| envelope).collect()
}

/// Mean envelope of the films, samples, and the verdict, each frame.
fn seen(is_60_hz: impl Fn(f64) -> bool, for_s: f64, heard: impl Fn(f64) -> f64) -> Vec<(f64, Vibration)> {
    let mut detector = VibrationDetector::default();
    let mut noise = 1_u32;
    (0..(for_s * f64::from(FRAME_HZ)) as u32)
        .map(|n| {
            let t_s = f64::from(n) / f64::from(FRAME_HZ);
            let config = VibrationConfig { mains_60_hz: is_60_hz(t_s), ..Config::default().vibration };
            let samples = core::array::from_fn(|film| {
                noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                sample(heard(t_s) * (0.4 + 0.1 * film as f64), noise >> 8)
            });
            let vibration = detector.process(&config, &samples, None);
            if n.is_multiple_of(FRAME_HZ / SLOW_HZ) {
                detector.learn_noise(&config, false);
            }
            let sum = detector.envelopes().iter().map(|&e| f64::from(e) / 65_536.0).sum::<f64>();
            (sum / PVDF_COUNT as f64, vibration)
        })
        .collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn hum_goes_where_the_mains_is_half_a_hertz_off_what_is_set() {
    for (mains_60_hz, hz) in [50.0, 60.0].into_iter().flat_map(|hz| [(false, hz), (true, hz)]) {
        for hz in [-0.5, -0.2, 0.0, 0.2, 0.5].map(|off| hz + off) {
            let all = envelopes(mains_60_hz, 6.0, |t_s| 30.0 * (TAU * hz * t_s + 1.0).sin());
            let left = mean(&all[8_000..]) / mean(&all[60..120]);
            let expected = if mains_60_hz == (hz > 55.0) { 0.0..0.08 } else { 0.5..1.1 };
            assert!(expected.contains(&left), "{hz} Hz, {mains_60_hz}: {left}");
        }
    }
}

#[test]
fn hum_that_grows_and_shrinks_is_followed() {
    // By a third, in 2 s: somebody walks past a lamp.
    let size = |t_s: f64| 30.0 * (1.0 + 0.33 * (TAU * 0.5 * t_s).sin());
    let all = envelopes(false, 6.0, |t_s| size(t_s) * (TAU * 50.0 * t_s).sin());
    let left = mean(&all[8_000..]) / mean(&all[60..120]);
    assert!(left < 0.25, "{left}");
}

const LOUD: f64 = 700.0;

fn says_slip(seen: &[(f64, Vibration)], from_s: f64, to_s: f64) -> bool {
    let [from, to] = [from_s, to_s].map(|t_s| (t_s * f64::from(FRAME_HZ)) as usize);
    seen[from..to].iter().any(|(_, vibration)| vibration.s1)
}

#[test]
fn hum_far_above_s1_is_no_slip_whichever_mains_is_set_and_slip_is_heard_again() {
    for is_60_hz in [false, true] {
        for hz in [49.7, 50.0, 59.9, 60.3] {
            let slip = |t_s: f64| if t_s > 8.0 { 700.0 * (TAU * 80.0 * t_s).sin() } else { 0.0 };
            let all = seen(|_| is_60_hz, 8.2, |t_s| LOUD * (TAU * hz * t_s + 1.0).sin() + slip(t_s));
            assert!(!says_slip(&all, 1.0, 8.0), "{hz} Hz, {is_60_hz}");
            assert!(says_slip(&all, 8.0, 8.2), "{hz} Hz, {is_60_hz}");
            let left: Vec<f64> = all[14_000..16_000].iter().map(|(envelope, _)| *envelope).collect();
            assert!(mean(&left) < 80.0, "{hz} Hz, {is_60_hz}: {}", mean(&left));
        }
    }
}

#[test]
fn learned_hum_that_stops_or_jumps_or_meets_another_setting_is_slip_for_a_moment() {
    let stops_after = |s: f64, is_60_hz: fn(f64) -> bool, then: fn(f64) -> f64| {
        let tone = |t_s: f64| if t_s < 6.0 { (TAU * 50.0 * t_s).sin() } else { then(t_s) };
        let all = seen(is_60_hz, 10.0, |t_s| LOUD * (t_s / 4.0).min(1.0) * tone(t_s));
        assert!(!says_slip(&all, 0.0, 6.0), "as it grows");
        !says_slip(&all, 6.0 + s, 10.0)
    };
    assert!(stops_after(0.5, |_| false, |_| 0.0), "off");
    assert!(stops_after(0.5, |_| false, |t_s| (TAU * 50.0 * (t_s + 0.003)).sin()), "six lost frames");
    assert!(stops_after(2.0, |t_s| t_s > 6.0, |t_s| (TAU * 50.0 * t_s).sin()), "another setting");
}

#[test]
fn vibration_that_stands_is_reported_and_needs_several_times_as_much() {
    let noise = |t_s: f64| if t_s < 5.0 { 700.0 * (TAU * 80.0 * t_s).sin() } else { 0.0 };
    let slip = |t_s: f64| if t_s > 3.9 && t_s < 4.0 { 2_800.0 * (TAU * 80.0 * t_s).sin() } else { 0.0 };
    let all = seen(|_| false, 18.0, |t_s| noise(t_s) + slip(t_s));
    assert!(!says_slip(&all, 0.5, 3.9));
    assert!(says_slip(&all, 3.9, 4.0));
    assert!(all[7_000].1.masked.count_ones() >= 6);
    assert_eq!([2_000, 35_999].map(|frame: usize| all[frame].1.masked), [0, 0]);
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
        hum.adapt(&mut film, if now.cosine > 0 { i32::MAX } else { i32::MIN });
        assert!(film.heard(now).abs() < 1 << 29, "{n}");
    }
}
