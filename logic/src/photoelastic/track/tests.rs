use super::*;
use std::f64::consts::FRAC_PI_2;

const FIGURE_14: Curve = Curve {
    dark_q4: 32_000,
    bright_q4: 207_000,
    force_mn: [136, 481, 1_007, 1_700, 2_551, 3_554, 4_706, 6_000],
};
const OPEN: Hints = Hints { unloaded: true, force_mn: None, drive: 0 };
const CLOSING: Hints = Hints { unloaded: false, force_mn: None, drive: 1 };
const NOTHING: Hints = Hints { unloaded: false, force_mn: None, drive: 0 };

/// The level of a force, N, a little beyond the curve's end too.
fn level(force_n: f64) -> i32 {
    let phase = FRAC_PI_2 * (force_n / 1.7).powf(1.0 / (6.0_f64 / 1.7).log2());
    (32_000.0 + 175_000.0 * phase.sin().powi(2)).round() as i32
}

fn opened() -> Tracker {
    let mut tracker = Tracker::default();
    (0..40).for_each(|_| tracker.step(&FIGURE_14, Some(level(0.0)), OPEN));
    tracker
}

/// Goes evenly from one force to another in so many cycles.
fn ramp(tracker: &mut Tracker, from_n: f64, to_n: f64, cycles: u32, hints: Hints) {
    for n in 1..=cycles {
        let part = f64::from(n) / f64::from(cycles);
        tracker.step(&FIGURE_14, Some(level(from_n + part * (to_n - from_n))), hints);
    }
}

fn reads(tracker: &Tracker, true_n: f64) {
    let force = tracker.force().expect("a force");
    let error_mn = (f64::from(force.mn) - 1e3 * true_n).abs();
    assert!(error_mn <= f64::from(force.uncertainty_mn), "{force:?} for {true_n} N, {:?}", tracker.track());
}

#[test]
fn a_motor_that_closes_over_the_peak_keeps_it_certain() {
    let mut tracker = opened();
    ramp(&mut tracker, 0.0, 4.0, 80, CLOSING);
    assert_eq!(tracker.track(), Track::Certain(Branch::Falling));
    reads(&tracker, 4.0);
    assert!(tracker.force().unwrap().uncertainty_mn < 180, "3 % of 6 N");
}

#[test]
fn without_a_motor_it_is_a_guess_that_reaches_to_the_other_branch() {
    for to_n in [4.0, 0.6] {
        let mut tracker = opened();
        ramp(&mut tracker, 0.0, 1.7, 80, NOTHING);
        ramp(&mut tracker, 1.7, to_n, 80, NOTHING);
        assert!(matches!(tracker.track(), Track::Likely(_)), "{:?}", tracker.track());
        reads(&tracker, to_n);
    }
    // An even ramp over it is guessed to have passed, one that comes back at its own speed to have turned.
    let mut passes = opened();
    ramp(&mut passes, 0.0, 4.0, 160, NOTHING);
    assert_eq!(passes.track(), Track::Likely(Branch::Falling));
    let mut turns = opened();
    ramp(&mut turns, 0.0, 1.7, 80, NOTHING);
    ramp(&mut turns, 1.7, 0.3, 66, NOTHING);
    assert_eq!(turns.track(), Track::Likely(Branch::Rising));
}

#[test]
fn a_turn_clearly_below_the_peak_stays_certain() {
    let mut tracker = opened();
    // The peak has been seen.
    ramp(&mut tracker, 0.0, 3.0, 80, CLOSING);
    ramp(&mut tracker, 3.0, 0.0, 80, Hints { drive: -1, ..NOTHING });
    (0..20).for_each(|_| tracker.step(&FIGURE_14, Some(level(0.0)), OPEN));
    for _ in 0..5 {
        ramp(&mut tracker, 0.2, 1.4, 40, NOTHING);
        ramp(&mut tracker, 1.4, 0.2, 40, NOTHING);
        assert_eq!(tracker.track(), Track::Certain(Branch::Rising));
        reads(&tracker, 0.2);
    }
}

#[test]
fn what_it_was_switched_on_in_is_unknown_until_only_one_force_is_possible() {
    let mut tracker = Tracker::default();
    ramp(&mut tracker, 3.0, 2.5, 40, NOTHING);
    assert_eq!((tracker.track(), tracker.force()), (Track::Unknown(Why::Starting), None));
    // The motor closes and it grows darker: above the peak.
    ramp(&mut tracker, 2.5, 4.0, 40, CLOSING);
    assert_eq!(tracker.track(), Track::Certain(Branch::Falling));
    reads(&tracker, 4.0);
}

#[test]
fn another_sensor_mends_a_wrong_branch_and_it_is_counted() {
    let mut tracker = opened();
    ramp(&mut tracker, 0.0, 1.7, 80, NOTHING);
    // It turns and at once goes back three times as slowly, for a moment, then on: the guess may be wrong.
    ramp(&mut tracker, 1.7, 0.8, 40, NOTHING);
    let guessed = tracker.track();
    tracker.step(&FIGURE_14, Some(level(0.8)), Hints { force_mn: Some(850), ..NOTHING });
    assert_eq!(tracker.track(), Track::Certain(Branch::Rising));
    assert_eq!(tracker.corrections() > 0, guessed == Track::Likely(Branch::Falling));
    reads(&tracker, 0.8);
    tracker.step(&FIGURE_14, Some(level(0.8)), Hints { force_mn: Some(9_000), ..NOTHING });
    assert_eq!(tracker.track(), Track::Unknown(Why::Beyond));
}

#[test]
fn too_fast_missing_and_saturated_are_states_of_their_own() {
    let mut fast = opened();
    ramp(&mut fast, 0.0, 3.0, 2, NOTHING);
    assert_eq!(fast.track(), Track::Unknown(Why::TooFast));

    let mut missing = opened();
    (0..MISSED_MAX).for_each(|_| missing.step(&FIGURE_14, None, NOTHING));
    assert_eq!(missing.track(), Track::Certain(Branch::Rising), "a frame or two may be lost");
    missing.step(&FIGURE_14, None, NOTHING);
    assert_eq!(missing.track(), Track::Unknown(Why::NoReading));

    let mut saturated = opened();
    ramp(&mut saturated, 0.0, 6.0, 120, CLOSING);
    assert_eq!(saturated.track(), Track::Saturated);
    reads(&saturated, 6.0);
    ramp(&mut saturated, 6.0, 6.9, 20, CLOSING);
    assert_eq!(saturated.track(), Track::Unknown(Why::Beyond));
}

#[test]
fn a_source_that_has_faded_is_learned_where_the_force_surely_passed() {
    let faded = |force_n: f64| 32_000 + (level(force_n) - 32_000) * 98 / 100;
    let mut tracker = opened();
    let up = |n: u32| f64::from(n) / 80.0 * 4.0;
    (1..=80).for_each(|n| tracker.step(&FIGURE_14, Some(faded(up(n))), CLOSING));
    (1..=80).for_each(|n| {
        tracker.step(&FIGURE_14, Some(faded(up(80 - n))), Hints { drive: -1, ..NOTHING });
    });
    (0..40).for_each(|_| tracker.step(&FIGURE_14, Some(faded(0.0)), OPEN));
    for n in 1..=32 {
        tracker.step(&FIGURE_14, Some(faded(up(n))), CLOSING);
        let force = tracker.force().unwrap();
        assert!((f64::from(force.mn) - 1e3 * up(n)).abs() < 120.0, "{} N: {force:?}", up(n));
    }
}
