//! What the reflex added and takes back: by the friction that slip has shown, never below what the hand was closed to.

use crate::common::{loaded, ran_alone};
use tenax_sim::report::Report;

const MU_S: f64 = 0.25;

fn ran(name: &str, seed: u64) -> Report {
    ran_alone(&loaded(name), seed).report
}

// Shows R10.
#[test]
fn twenty_seconds_after_a_wet_patch_the_grip_is_a_third_above_the_need_and_a_pull_is_answered() {
    // Constants were chosen with seed 1.
    for seed in 1..=6 {
        let (held, pulled) = (ran("relax", seed), ran("relax-pull", seed));
        let needed_n = held.grip.needed_force_n.unwrap();
        let held_n = needed_n + held.margin.last_mn.unwrap() / 1e3 / MU_S;
        let relaxed_n = held.added.relaxed_n;
        assert_eq!((held.object.kept, pulled.object.kept), (Some(true), Some(true)), "seed {seed}");
        assert!(relaxed_n > 1.0 && held_n < 1.35 * needed_n, "seed {seed}: {held_n} N for {needed_n} N");
        assert!(relaxed_n <= held.added.added_n, "seed {seed}");
        let slid_by_it_mm = pulled.slip.distance_mm.unwrap() - held.slip.distance_mm.unwrap();
        assert!(pulled.reflex.pulses > held.reflex.pulses || slid_by_it_mm < 0.1, "seed {seed}");
        // Half the pad, as the default scene. Without relaxing it does not slide: that is its price.
        assert!(slid_by_it_mm < 9.0, "seed {seed}: {slid_by_it_mm} mm");
    }
}

// Shows R10.
#[test]
fn a_third_of_a_grip_is_taken_back_and_the_force_that_is_felt_is_the_true_one() {
    for seed in 1..=6 {
        let report = ran("relax-far", seed);
        let (peak_n, relaxed_n) = (report.grip.peak_force_n.unwrap(), report.added.relaxed_n);
        let last_mn = report.margin.last_mn.unwrap();
        assert_eq!(report.object.kept, Some(true), "seed {seed}");
        assert!(relaxed_n > 0.3 * peak_n, "seed {seed}: or it shows nothing");
        // A tenth of the shear.
        assert!(last_mn > 270.0, "seed {seed}: {last_mn} mN");
        let after = report.faults.iter().filter(|fault| fault.at_s > Some(13.0)).count();
        assert_eq!(after, 0, "seed {seed}: {:?}", report.faults);
    }
}

// Shows R10.
#[test]
fn who_has_not_chosen_it_keeps_what_was_added() {
    let report = ran("glass", 1);
    assert!(report.added.added_n > 1.0);
    assert_eq!(report.added.relaxed_n, 0.0);
}
