//! Objects that turn, are crushed and break, and grippers that move by steps.

use crate::common::{Reflex, run, scene};
use tenax_scene::{SceneFile, Truth, builtin};

fn truth(scene: &SceneFile) -> Truth {
    run(scene, 1, Reflex::None, |_, _, _| {}).truth().clone()
}

/// A built-in scene with something in it replaced.
fn changed(name: &str, changes: &[(&str, &str)]) -> SceneFile {
    let (_, text) = builtin().iter().find(|(builtin, _)| *builtin == name).unwrap();
    let text = changes.iter().fold((*text).to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from} stands in {name}");
        text.replacen(from, to, 1)
    });
    SceneFile::parse(&text, name).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_load_off_centre_turns_before_it_slides_and_without_pitch_it_holds_longer() {
    let turns = run_script("steel-balls", &[]);
    let straight = run_script("steel-balls", &[("offset_mm = 15", "offset_mm = 0")]);
    assert!(turns.pitch_rad > 0.05, "{} rad", turns.pitch_rad);
    assert_eq!(straight.pitch_rad, 0.0);
    let held_s = |truth: &Truth| {
        truth.slips.iter().find(|slip| slip.macro_onset_s > 8.0).map(|slip| slip.macro_onset_s)
    };
    let (turned_s, slid_s) = (held_s(&turns).expect("it slips"), held_s(&straight));
    assert!(slid_s.is_none_or(|slid_s| slid_s > turned_s + 2.0), "{turned_s} s, then {slid_s:?} s");
}

/// A scene whose hand obeys what somebody types: [`crate::common::run`] knows muscles only.
fn run_script(name: &str, changes: &[(&str, &str)]) -> Truth {
    use tenax_hal_shim::motor::MotorDrive;
    use tenax_hal_shim::wire::Down;
    use tenax_scene::plant::Plant;
    let scene = changed(name, changes);
    let mut world = tenax_scene::World::new(&scene, 1);
    let (mut drive, mut until_s) = (MotorDrive::Coast, 0.0);
    while world.now_s() < scene.duration_s() {
        if world.now_s() > until_s {
            drive = MotorDrive::Coast;
        }
        world.scan(drive);
        for command in world.commands() {
            if let Down::Drive { drive: wanted, hold_ms } = command {
                drive = wanted;
                until_s = world.now_s() + f64::from(hold_ms) / 1e3;
            }
        }
    }
    world.truth().clone()
}

#[test]
fn the_can_is_crushed_by_the_mistake_and_by_nothing_else() {
    let crushed = truth(&scene("can"));
    assert!(crushed.crushed_at_s.is_some_and(|at_s| at_s > 10.0), "{:?}", crushed.crushed_at_s);
    assert!(crushed.dent_mm > 1.0, "{} mm", crushed.dent_mm);
    // It yields: no finger presses harder than its wall bears.
    assert_eq!(crushed.peak_grip_n, 8.0);
    let careful = truth(&changed("can", &[("at_s = 10.0\nfor_s = 1.2", "at_s = 10.0\nfor_s = 0.01")]));
    assert_eq!((careful.crushed_at_s, careful.dent_mm), (None, 0.0));
    assert!(careful.needed_grip_n > 0.1 && !careful.dropped && careful.slips.is_empty());
    // Without a limit, which is the level below, nothing tells the two apart but the force.
    let rigid = truth(&changed("can", &[("crush_n = 8 ", "break_n = 200 ")]));
    assert!(rigid.crushed_at_s.is_none() && rigid.peak_grip_n > 8.0);
}

#[test]
fn what_breaks_is_gone() {
    let broken = truth(&changed("can", &[("crush_n = 8 ", "break_n = 8 ")]));
    assert!(broken.broken_at_s.is_some_and(|at_s| at_s > 10.0) && broken.dropped, "{:?}", broken.broken_at_s);
}

#[test]
fn the_pick_up_slips_on_the_way_up_and_on_the_way_down_with_a_warning_before() {
    let truth = run_script("pick-up", &[]);
    assert!(!truth.dropped && truth.micro_slips > 40);
    for begin_s in [0.0, 10.0, 20.0] {
        let ups =
            truth.slips.iter().filter(|slip| (begin_s + 1.0..begin_s + 5.0).contains(&slip.macro_onset_s));
        assert!(ups.clone().count() >= 1, "from {begin_s} s: {:?}", truth.slips);
        let high_mm = truth.trace.iter().filter(|row| (begin_s..begin_s + 6.0).contains(&row.t_s));
        let high_mm = high_mm.map(|row| row.position_mm).fold(0.0, f64::max);
        assert!(high_mm > 10.0, "lifted by {high_mm} mm");
    }
    // Tada 2006, figure 6: the camera says all its words, v1 = -1 while it slips.
    let said = |v1: i8, v2: i8| truth.camera.iter().filter(|seen| (seen.v1, seen.v2) == (v1, v2)).count();
    assert!(said(-1, 1) > 5 && said(1, 1) > 20 && said(0, 0) > 200 && said(1, -1) > 20);
    let first = truth.slips.iter().find(|slip| slip.distance_mm > 5.0).expect("a slip to see");
    let seen_s =
        truth.camera.iter().find(|seen| seen.v1 == -1 && seen.t_s > first.micro_onset_s).expect("seen").t_s;
    assert!(seen_s - first.macro_onset_s > 0.03, "seen at {seen_s} s, begun at {} s", first.macro_onset_s);
}
