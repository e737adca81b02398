use super::*;
use crate::emg::mains::mains_of;
use std::f64::consts::TAU;

const ACTIVE_UV: i32 = 120_000;
const AT_S: [f64; 3] = [0.005, 0.008, 0.011];

fn watch(seconds: f64, of: impl Fn(f64) -> f64) -> Trust {
    let mut watch = Trust::default();
    go_on(&mut watch, 0.0, seconds, of);
    watch
}

fn go_on(watch: &mut Trust, from_s: f64, seconds: f64, of: impl Fn(f64) -> f64) {
    for slow in 0..(seconds * 80.0) as u32 {
        let readings = AT_S.map(|at| of(from_s + f64::from(slow) / 80.0 + at));
        let numbers = readings.map(|mv| watch.take((mv < 2_950.0).then_some((mv * 1e3) as i32)));
        if let [Some(first), Some(second), Some(third)] = numbers {
            watch.judge(ACTIVE_UV, (first + second + third) / 3, 0);
        }
        if let Some(window) = watch.window().copied() {
            watch.hear(mains_of(&window));
        }
    }
}

fn muscle(t: f64) -> f64 {
    let wave = |hz: f64| (TAU * hz * t).sin();
    400.0 * (1.0 + 0.15 * wave(2.3) + 0.12 * wave(4.1))
}

#[test]
fn each_fault_has_its_name() {
    for (seconds, of, quality) in [
        (2.0, (|_| 400.0) as fn(f64) -> f64, Quality::Flat),
        (3.0, |t| 400.0 + 5.0 * (TAU * 100.0 * t).sin(), Quality::Hum),
        (3.0, |t| 400.0 + 5.0 * (TAU * 50.0 * t).sin(), Quality::Hum),
        (3.0, |t| 100.0 + 700.0 * t, Quality::Creep),
        (4.0, |t| 400.0 + 6.0 * (1.15 * t).floor(), Quality::Flat),
        (4.0, |t| 400.0 + 6.0 * (1.15 * t).floor() + 5.0 * (TAU * 100.0 * t).sin(), Quality::Hum),
        (1.0, |_| 3_000.0, Quality::LeadOff),
        (2.0, |t| 2_900.0 + 20.0 * (TAU * 3.0 * t).sin(), Quality::Saturated),
        (61.0, muscle, Quality::Endless),
        (59.0, muscle, Quality::Good),
        (10.0, |t| 60.0 + 4.0 * (TAU * 3.0 * t).sin(), Quality::Good),
        (10.0, |_| 60.0, Quality::Good),
        (10.0, |_| 0.0, Quality::Good),
    ] {
        assert_eq!(watch(seconds, of).quality(), quality, "{} after {seconds} s", of(seconds));
    }
}

#[test]
fn a_contraction_proves_itself_and_a_step_of_the_front_end_does_not() {
    let settling = |t: f64| 500.0 * (1.0 - (-t / 0.027).exp());
    assert!(!watch(0.24, settling).has_turned_twice());
    assert!(watch(0.50, muscle).has_turned_twice());
}

#[test]
fn a_jump_from_a_fault_to_another_proves_nothing() {
    let jump = |t: f64| if t < 0.24 { 500.0 } else { 1_400.0 };
    (1..60).for_each(|n| assert!(!watch(f64::from(n) / 80.0, jump).has_turned_twice(), "{n} slow frames"));
}

#[test]
fn a_turn_within_the_other_electrodes_signal_proves_nothing() {
    for (other_uv, proves) in [(2_000_000, false), (200_000, true)] {
        let mut watch = Trust::default();
        for n in 0..60 {
            let uv = if n < 40 { 1_000_000 } else { 950_000 };
            watch.judge(ACTIVE_UV, uv, if (40..48).contains(&n) { other_uv } else { 0 });
        }
        assert_eq!(watch.has_turned(), proves);
    }
}

#[test]
fn what_is_proven_must_prove_itself_again_once_it_no_longer_curves() {
    let mut watch = watch(1.0, muscle);
    assert!(watch.has_turned_twice());
    let level = muscle(1.0);
    go_on(&mut watch, 1.0, 1.2, |t| level + 1_000.0 * (t - 1.0));
    assert!(!watch.has_turned_twice(), "a straight line is no muscle");
}

#[test]
fn a_dip_of_a_muscle_proves_a_closing_and_one_of_a_loose_contact_does_not() {
    for (tau_s, proves) in [(0.1, true), (0.027, false)] {
        let (mut watch, mut uv) = (Trust::default(), 400_000.0);
        for frame in 0..120 {
            let target_uv = if (40..70).contains(&frame) { 150_000.0 } else { 400_000.0 };
            uv += (target_uv - uv) * (1.0 - (-1.0f64 / 80.0 / tau_s).exp());
            watch.take(Some(uv as i32));
            watch.judge(ACTIVE_UV, uv as i32, 0);
            watch.weigh(Part::Unknown, true, true, false);
        }
        assert_eq!(watch.is_joined(), proves, "{tau_s}");
    }
}
