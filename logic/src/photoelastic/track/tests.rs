use super::*;
use crate::photoelastic::curve::tests::FIGURE_14;
use std::f64::consts::FRAC_PI_2;

const OPEN: Hints = Hints { unloaded: true, force_mn: None };
const NOTHING: Hints = Hints { unloaded: false, force_mn: None };

fn level(force_n: f64, q: f64) -> i32 {
    let phase = FRAC_PI_2 * (force_n / 1.7).powf(1.0 / (6.0_f64 / 1.7).log2());
    let squared = 1.0 + 4.0 * q * q;
    (32_000.0 + 175_000.0 * (phase * squared.sqrt()).sin().powi(2) / squared).round() as i32
}

fn opened() -> Tracker {
    let mut tracker = Tracker::default();
    (0..40).for_each(|_| tracker.step(&FIGURE_14, Some(level(0.0, 0.0)), OPEN));
    tracker
}

fn ramp(tracker: &mut Tracker, from: (f64, f64), to: (f64, f64), cycles: u32, hints: Hints) {
    for n in 1..=cycles {
        let part = f64::from(n) / f64::from(cycles);
        let (force_n, q) = (from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1));
        tracker.step(&FIGURE_14, Some(level(force_n, q)), hints);
        if let Some(force) = tracker.force() {
            let within = f64::from(force.least_mn)..=f64::from(force.most_mn);
            assert!(
                within.contains(&(1e3 * force_n)),
                "{force:?} for {force_n} N, {q}: {:?}",
                tracker.track()
            );
        }
    }
}

#[test]
fn it_is_certain_as_long_as_no_shear_can_have_brought_the_light_to_its_fold() {
    let mut tracker = opened();
    for q in [0.5, 0.0, 0.3] {
        ramp(&mut tracker, (0.0, q), (0.4, q), 40, NOTHING);
        assert_eq!(tracker.track(), Track::Certain(Branch::Rising));
        assert!(tracker.force().unwrap().uncertainty_mn() < 180, "3 % of 6 N");
        ramp(&mut tracker, (0.4, q), (0.0, q), 40, NOTHING);
    }
    ramp(&mut tracker, (0.0, 0.0), (0.8, 0.0), 40, NOTHING);
    assert_eq!(tracker.track(), Track::Either, "with a shear of a half it would have been over the fold");
    // The control: going back does not help, an open hand does.
    ramp(&mut tracker, (0.8, 0.0), (0.2, 0.0), 40, NOTHING);
    assert_eq!(tracker.track(), Track::Either);
    (0..3).for_each(|_| tracker.step(&FIGURE_14, Some(level(0.0, 0.0)), OPEN));
    assert_eq!(tracker.track(), Track::Certain(Branch::Rising));
}

#[test]
fn another_sensor_tells_the_branch_where_only_one_agrees() {
    for (force_n, q, branch) in [(0.3, 0.2, Branch::Rising), (4.5, 0.1, Branch::Falling)] {
        let mut tracker = opened();
        ramp(&mut tracker, (0.0, 0.0), (3.0, 0.0), 80, NOTHING);
        ramp(&mut tracker, (3.0, 0.0), (force_n, q), 80, NOTHING);
        assert_eq!(tracker.track(), Track::Either);
        let told = Hints { force_mn: Some((1e3 * force_n) as i32 + 50), ..NOTHING };
        tracker.step(&FIGURE_14, Some(level(force_n, q)), told);
        assert_eq!(tracker.track(), Track::Certain(branch));
        ramp(&mut tracker, (force_n, q), (force_n, q), 3, NOTHING);
        assert_eq!(tracker.track(), Track::Certain(branch));
    }
}

#[test]
fn a_jump_missing_readings_and_the_curves_end_leave_nothing_certain() {
    let mut fast = opened();
    ramp(&mut fast, (0.0, 0.0), (4.0, 0.0), 1, NOTHING);
    assert_eq!(fast.track(), Track::Either);

    let mut missing = opened();
    (0..MISSED_MAX).for_each(|_| missing.step(&FIGURE_14, None, NOTHING));
    assert_eq!(missing.track(), Track::Certain(Branch::Rising), "a frame or two may be lost");
    missing.step(&FIGURE_14, None, NOTHING);
    assert_eq!((missing.track(), missing.force()), (Track::Unknown, None));
    ramp(&mut missing, (2.0, 0.2), (1.0, 0.2), 40, NOTHING);
    assert_eq!(missing.track(), Track::Either);

    let mut ended = opened();
    ramp(&mut ended, (0.0, 0.0), (6.0, 0.0), 120, NOTHING);
    assert!(ended.force().unwrap().most_mn >= 6_000);
    ramp(&mut ended, (6.0, 0.0), (3.0, 0.4), 40, NOTHING);
    assert!(ended.force().unwrap().most_mn >= 6_000, "beyond the end the light rises again");
}
