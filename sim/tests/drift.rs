//! Quadrants of the force sensor that drift in a grasp, neighbours, opposites and all, either way, while the reflex may
//! take back what it added.

use crate::common::{asked, parsed, ran_alone, text};

const SETS: [&str; 5] = ["a", "ab", "ac", "abc", "abcd"];
/// N/s. Slower ones stay below what skin yields: `TENAX_DRIFTS=6` plays them, too.
const PER_S: [f64; 6] = [-0.1, 0.1, -0.03, 0.03, -0.005, 0.005];
/// Time within which a drift is told that exceeds the need by then, s.
const TOLD_WITHIN_S: f64 = 20.0;

// Shows R4, R10.
#[test]
fn quadrants_that_drift_lose_nothing_and_are_told_where_that_matters() {
    let rates = &PER_S[..asked("TENAX_DRIFTS").unwrap_or(2)];
    for (name, begins_s, most_n) in [("glass", 6.0, 24.0), ("gripper", 3.0, 9.2), ("relax", 14.0, 24.0)] {
        for (set, per_s) in SETS.into_iter().flat_map(|set| rates.iter().map(move |per_s| (set, per_s))) {
            let more = if name == "gripper" { "duration_s = 60\n" } else { "" };
            let mut text = text(name).replace("\nduration_s = 31", "\nduration_s = 100");
            if name != "relax" {
                text = text.replacen("\ntitle", &format!("\nline_trusted = true\n{more}title"), 1);
                text += "\n[[command]]\nat_s = 0.15\nkind = \"set-relax-choice\"\nvalue = 2\n";
            }
            for quadrant in set.chars() {
                text += &format!(
                    "\n[[fault]]\nat_s = {begins_s}\nchannel = \"fsr_{quadrant}\"\nkind = \"drift\"\n"
                );
                text += &format!("drift_per_s = {per_s}\nreason = \"it warms\"\n");
            }
            let report = ran_alone(&parsed(&text), asked("TENAX_SEED").unwrap_or(1)).report;
            let told = report.faults.iter().find(|fault| {
                fault.at_s.is_some_and(|at_s| at_s > begins_s)
                    && fault.what.contains("gives no number: Creep")
            });
            let told_s = told.map_or(f64::INFINITY, |fault| fault.at_s.unwrap() - begins_s);
            let (needed_n, peak_n) = (report.grip.needed_force_n.unwrap(), report.grip.peak_force_n.unwrap());
            let exceeds_s = needed_n / per_s.abs() / set.len() as f64;
            let case = format!("{name}, {set}, {per_s} N/s: {peak_n:.1} N, told after {told_s:.1} s");
            println!("{case}, {exceeds_s:.0} s to what is needed");
            assert_eq!(report.object.kept, Some(true), "{case}");
            assert!(peak_n < most_n, "{case}");
            assert!(
                exceeds_s > report.virtual_s - begins_s || told_s < exceeds_s.max(TOLD_WITHIN_S),
                "{case}"
            );
        }
    }
}
