//! An hour of everyday disturbances in which nothing slips, so that a pulse is one without need. What has no measured value is drawn for
//! each minute, over the ranges of its sources.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

pub const NAME: &str = "disturbance-hour";

pub fn text(seed: u64, minutes: u32) -> String {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut text = format!(
        r#"# Drawn from seed {seed} by sim/src/disturbances.rs.
name = "{NAME}"
title = "An hour of disturbances in a hand that holds a glass; nothing slips"
base = "glass"
without = ["muscle", "move", "swing", "fill", "knock", "wet"]
duration_s = {duration}
[contact]
level = "l1"                    # what swings lets rings of the pad go without sliding
[[muscle]]
at_s = 1.0
for_s = 4.0
intent = "close"
level_mv = 400                  # as scenes/glass.toml
until_grip_n = 4.5              # assumed: they grip firmly before they walk
[[move]]
at_s = 5.0
for_s = 3.0
to_mm = 150                     # as scenes/glass.toml
"#,
        duration = 60 * minutes
    );
    for minute in 0..minutes {
        one_minute(&mut text, &mut rng, f64::from(60 * minute) + 10.0);
    }
    drifts(&mut text, &mut rng);
    text
}

/// 49 s from `from_s` on; the rest of the minute is quiet.
fn one_minute(text: &mut String, rng: &mut ChaCha8Rng, from_s: f64) {
    let swing = |at_s: f64, for_s: f64, rate_hz: f64, peak_m_s2: f64| {
        let cycles = (for_s * rate_hz).round();
        format!(
            "[[swing]]\nat_s = {at_s}\ncycles = {cycles}\nrate_hz = {rate_hz:.3}\npeak_m_s2 = {peak_m_s2:.3}\n"
        )
    };
    // Walking: 1.6 to 2.2 steps a second, the hand's acceleration as scenes/glass.toml at most; then standing.
    *text += &swing(from_s, 20.0, rng.random_range(1.6..2.2), rng.random_range(1.0..3.0));
    // Tremor: physiological, 8 to 12 Hz, up to 0.3 m/s^2.
    *text += &swing(from_s + 24.0, 8.0, rng.random_range(8.0..12.0), rng.random_range(0.05..0.3));
    // Knocks: 50 Hz to 2 kHz, 1 to 30 ms, unequal over the films. A door: the lowest and longest of them.
    let mut at_s = from_s;
    for n in 0..7 {
        at_s += rng.random_range(1.0..7.0);
        let is_door = n == 6;
        let ring_hz = if is_door { rng.random_range(50.0..90.0) } else { decades(rng, 50.0, 2_000.0) };
        let decay_ms = if is_door { 30.0 } else { decades(rng, 1.0, 30.0) };
        let (peak_mv, uneven) = (decades(rng, 5.0, 100.0), rng.random_range(0.0..1.0));
        *text += &format!("[[knock]]\nat_s = {at_s:.3}\npeak_mv = {peak_mv:.2}\nring_hz = {ring_hz:.1}\n");
        *text += &format!("decay_ms = {decay_ms:.2}\nuneven = {uneven:.3}\n");
    }
    // Somebody switches a machine on near by: mains of 50 or 60 Hz, whatever the board is set to.
    let hum_hz = if rng.random_range(0.0..1.0) < 0.5 { 50 } else { 60 };
    let peak_mv = decades(rng, 0.5, 5.0);
    let at_s = from_s + rng.random_range(10.0..25.0);
    *text += &format!("[[hum]]\nat_s = {at_s:.3}\nfor_s = 20\npeak_mv = {peak_mv:.3}\nhum_hz = {hum_hz}\n");
}

fn drifts(text: &mut String, rng: &mut ChaCha8Rng) {
    let mut drift = |name: String, per_s: String| {
        *text += &format!("[[fault]]\nat_s = 10\nchannel = \"{name}\"\nkind = \"drift\"\n");
        *text += &format!("drift_per_s = {per_s}\nreason = \"creep\"\n");
    };
    for quadrant in ["a", "b", "c", "d"] {
        // 0.2 N an hour either way: under 5 % a decade of time for an FSR at 1.3 N a quadrant (Interlink FSR 400, data sheet).
        drift(format!("fsr_{quadrant}"), format!("{:.8}", rng.random_range(-6e-5..6e-5)));
    }
    for film in 1..=12 {
        // Offsets of the charge amplifiers: up to 30 mV an hour (assumed).
        drift(format!("pvdf_{film}"), format!("{:.6}", rng.random_range(-8e-3..8e-3)));
    }
}

fn decades(rng: &mut ChaCha8Rng, from: f64, to: f64) -> f64 {
    from * (to / from).powf(rng.random_range(0.0..1.0))
}
