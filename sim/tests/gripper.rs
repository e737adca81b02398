//! A gripper without myosensors: its reflex keeps what it lifts if the board knows that nobody wears it. The control is
//! the same board that was not told so.

use crate::common::{parsed, ran_alone, text};
use tenax_sim::report::Report;

fn report(scene: &str, seed: u64) -> Report {
    ran_alone(&parsed(&text(scene)), seed).report
}

// Shows R8.
#[test]
fn a_gripper_keeps_what_it_lifts_and_one_that_waits_for_a_wearer_leaves_it_behind() {
    for seed in 1..=4 {
        let gripper = report("gripper", seed);
        let slid_mm = gripper.slip.distance_mm.unwrap();
        assert!(gripper.wearer.none, "told at the start");
        assert_eq!(gripper.object.kept, Some(true), "seed {seed}");
        assert!(slid_mm < 10.0, "seed {seed}: {slid_mm} mm");

        let control = report("gripper-control", seed);
        assert!(!control.wearer.none && control.wearer.reflex_ticks == 0, "seed {seed}");
        assert_eq!(control.object.left_behind, Some(true), "seed {seed}");
        assert_eq!(control.object.kept, Some(false), "what is left behind is not kept");
    }
}

/// The robot lifts while its fingers still close. In the control its motor counts as louder than slip.
// Shows R1.
#[test]
fn what_slips_while_a_robot_closes_is_answered() {
    let quiet = text("pick-up");
    let loud = format!("{quiet}\n[[command]]\nat_s = 0.2\nkind = \"set-noisy-duty-permille\"\nvalue = 50\n");
    for seed in 1..=4 {
        let [quiet, loud] = [&quiet, &loud].map(|text| {
            let report = ran_alone(&parsed(text), seed).report;
            (report.object.kept, report.slip.distance_mm.unwrap())
        });
        assert!(quiet.0 == Some(true) && quiet.1 < 10.0, "seed {seed}: {quiet:?}");
        assert!(loud.0 == Some(false) && loud.1 > 60.0, "seed {seed}: {loud:?}");
    }
}
