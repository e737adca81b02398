//! The photoelastic head: what it says of slip with and without its strip (Dubey 2006, sections 2 to 4).

use std::f64::consts::TAU;

use tenax_scene::physics::Touch;
use tenax_scene::physics::stribeck::{METAL, PLASTIC, Slider, Stribeck};
use tenax_scene::sensor::photoelastic::curve::{Day, Making};
use tenax_scene::sensor::photoelastic::optics::Layer;
use tenax_scene::sensor::photoelastic::{HEAD_STRIP, Head};

const SCAN_S: f64 = 1.0 / 8_000.0;
const LOAD_N: f64 = 1.0;

fn pin_mv(friction: Stribeck, rate_mm_s: f64) -> Vec<f64> {
    let slider = Slider { friction, ..HEAD_STRIP };
    let mut head = Head::with(Layer::DUBEY, Making::MEAN, Day::FIRST, slider, 1.into());
    let at = |n: u32| {
        let slides = (4_000..12_000).contains(&n);
        let slide_m_s = if slides { rate_mm_s / 1e3 } else { 0.0 };
        Touch { normal_n: LOAD_N, slide_m_s, sticks: !slides, ..Touch::default() }
    };
    (0..16_000).map(|n| 1e3 * head.step(f64::from(n) * SCAN_S, &at(n))).collect()
}

/// Amplitude of the strongest line from 5 to 300 Hz in a part of the pin's voltage, mV, and its frequency.
fn line(pin_mv: &[f64]) -> (f64, f64) {
    let mean = pin_mv.iter().sum::<f64>() / pin_mv.len() as f64;
    (5..300).map(f64::from).fold((0.0, 0.0), |most, hz| {
        let (re, im) = pin_mv.iter().enumerate().fold((0.0, 0.0), |(re, im), (n, mv)| {
            let (sin, cos) = (TAU * hz * n as f64 * SCAN_S).sin_cos();
            (re + (mv - mean) * cos, im + (mv - mean) * sin)
        });
        let amplitude = 2.0 * (re * re + im * im).sqrt() / pin_mv.len() as f64;
        if amplitude > most.0 { (amplitude, hz) } else { most }
    })
}

fn sliding(friction: Stribeck, rate_mm_s: f64) -> (f64, f64) {
    line(&pin_mv(friction, rate_mm_s)[8_000..12_000])
}

#[test]
fn amplitude_and_frequency_rise_with_the_rate_and_metal_is_louder_than_plastic() {
    let rates = [0.1, 0.3, 0.6, 1.0, 2.0, 2.7];
    let metal = rates.map(|rate| sliding(METAL, rate));
    let plastic = rates.map(|rate| sliding(PLASTIC, rate));
    for lines in [metal, plastic] {
        assert!(lines.windows(2).all(|two| two[1].0 > two[0].0), "amplitudes {lines:?}");
        assert!(lines[5].1 > lines[0].1 + 5.0, "frequencies {lines:?}");
    }
    for (metal, plastic) in metal.iter().zip(plastic) {
        assert!(metal.0 > 1.3 * plastic.0, "{metal:?} {plastic:?}");
    }
    assert!(metal[0].0 > 2.0, "0.1 mm/s is seen over 0.5 mV of noise: {} mV", metal[0].0);
}

#[test]
fn without_falling_friction_there_is_light_only_where_slip_begins_and_ends() {
    let bare = Stribeck { mu_s: 0.30, ..METAL };
    for rate_mm_s in [0.3, 1.0, 3.0] {
        let (pin, with) = (pin_mv(bare, rate_mm_s), pin_mv(METAL, rate_mm_s));
        let swing = |part: &[f64]| {
            part.iter().copied().fold(f64::MIN, f64::max) - part.iter().copied().fold(f64::MAX, f64::min)
        };
        let [begins, slides, ends] =
            [&pin[3_900..6_000], &pin[8_000..11_900], &pin[11_900..14_000]].map(swing);
        // Noise of a scan is 1 mV rms.
        assert!(begins > 100.0 && slides < 10.0 && ends < begins, "{rate_mm_s}: {begins} {slides} {ends}");
        let (amplitude, _) = line(&pin[8_000..12_000]);
        assert!(amplitude < 0.2 * line(&with[8_000..12_000]).0, "the control vibrates: {amplitude} mV");
    }
}
