//! Objects that turn, are crushed and break, and what a camera says of a lift.

use crate::common::{Reflex, changed, scene, truth};

#[test]
fn a_load_off_centre_turns_before_it_slides_and_without_pitch_it_holds_longer() {
    let turns = truth(&scene("steel-balls"), Reflex::None);
    let straight = truth(&changed("steel-balls", &[("offset_mm = 15", "offset_mm = 0")]), Reflex::None);
    assert!(turns.pitch_rad > 0.05, "{} rad", turns.pitch_rad);
    assert_eq!(straight.pitch_rad, 0.0);
    let [turned_s, slid_s] = [&turns, &straight].map(|truth| {
        let mut onsets = truth.slips.iter().map(|slip| slip.macro_onset_s);
        onsets.find(|&onset_s| onset_s > 8.0).unwrap_or(f64::INFINITY)
    });
    assert!(slid_s > turned_s + 2.0, "{turned_s} s, then {slid_s} s");
}

#[test]
fn the_can_is_crushed_by_the_mistake_and_by_nothing_else() {
    let crushed = truth(&scene("can"), Reflex::None);
    assert!(crushed.crushed_at_s.is_some_and(|at_s| at_s > 10.0), "{:?}", crushed.crushed_at_s);
    assert!(crushed.dent_mm > 1.0, "{} mm", crushed.dent_mm);
    // It yields: no finger presses harder than its wall bears.
    assert_eq!(crushed.peak_grip_n, 8.0);
    let mistake = ("at_s = 10.0\nfor_s = 1.2", "at_s = 10.0\nfor_s = 0.01");
    let careful = truth(&changed("can", &[mistake]), Reflex::None);
    assert_eq!((careful.crushed_at_s, careful.dent_mm), (None, 0.0));
    assert!(careful.needed_grip_n > 0.1 && !careful.dropped && careful.slips.is_empty());
    // Without a limit nothing tells the two apart but the force.
    let rigid = truth(&changed("can", &[("crush_n = 8 ", "break_n = 200 ")]), Reflex::None);
    assert!(rigid.crushed_at_s.is_none() && rigid.peak_grip_n > 8.0);
    let broken = truth(&changed("can", &[("crush_n = 8 ", "break_n = 8 ")]), Reflex::None);
    assert!(broken.broken_at_s.is_some_and(|at_s| at_s > 10.0) && broken.dropped, "what breaks is gone");
}

#[test]
fn the_pick_up_slips_on_the_way_up_and_on_the_way_down_with_a_warning_before() {
    let truth = truth(&scene("pick-up"), Reflex::None);
    assert!(!truth.dropped && truth.micro_slips > 40);
    for begin_s in [0.0, 10.0, 20.0] {
        let up = begin_s + 1.0..begin_s + 5.0;
        assert!(
            truth.slips.iter().any(|slip| up.contains(&slip.macro_onset_s)),
            "{begin_s} s: {:?}",
            truth.slips
        );
        let high_mm = truth.trace.iter().filter(|row| (begin_s..begin_s + 6.0).contains(&row.t_s));
        let high_mm = high_mm.map(|row| row.position_mm).fold(0.0, f64::max);
        assert!(high_mm > 10.0, "lifted by {high_mm} mm");
    }
    // Tada 2006, figure 6: the camera says all its words, v1 = -1 while it slips.
    let said = |v1: i8, v2: i8| truth.camera.iter().filter(|seen| (seen.v1, seen.v2) == (v1, v2)).count();
    assert!(said(-1, 1) > 5 && said(1, 1) > 20 && said(0, 0) > 200 && said(1, -1) > 20);
    let first = truth.slips.iter().find(|slip| slip.distance_mm > 5.0).expect("a slip to see");
    let mut seen = truth.camera.iter().filter(|seen| seen.v1 == -1 && seen.t_s > first.micro_onset_s);
    let seen_s = seen.next().expect("seen").t_s;
    assert!(seen_s - first.macro_onset_s > 0.03, "seen at {seen_s} s, begun at {} s", first.macro_onset_s);
}
