//! Scenes in which a reflex of many guards failed, beside their bound: what has to be kept, and with how much.

use std::sync::OnceLock;

use crate::common::{parsed, text};
use tenax_hal_shim::motor::MotorDrive;
use tenax_scene::World;
use tenax_scene::plant::Plant;
use tenax_sim::report::Report;
use tenax_sim::report::bound::SAME_MM;

/// Each with the seconds in which its object slips, if it does, and the force that it bears, N.
const SCENES: [(&str, bool, f64); 10] = [
    ("drifting-quadrant", false, f64::INFINITY),
    ("drifting-quadrants", true, f64::INFINITY),
    ("hum-after-slip", true, f64::INFINITY),
    ("slippery", true, f64::INFINITY),
    ("egg", true, 25.0),
    ("egg-filled", true, 25.0),
    ("deaf-film", true, f64::INFINITY),
    ("lifted-extensor", true, f64::INFINITY),
    ("lifted-flexor", true, f64::INFINITY),
    ("dead-extensor", true, f64::INFINITY),
];

fn ran(name: &str) -> &'static Report {
    static RAN: [OnceLock<Report>; SCENES.len()] = [const { OnceLock::new() }; SCENES.len()];
    let at = SCENES.iter().position(|(own, ..)| *own == name).expect("a scene of the table");
    RAN[at].get_or_init(|| crate::common::ran(&parsed(&text(name)), 1).report)
}

#[test]
fn the_bound_keeps_every_one_of_them_with_little_more_than_is_needed() {
    for (name, slips, bears_n) in SCENES {
        let report = ran(name);
        let (bound, grip) = (&report.bound, &report.grip);
        assert_eq!(bound.kept, Some(true), "{name}");
        assert!(bound.distance_mm.unwrap() < SAME_MM, "{name}: {bound:?}");
        assert!(bound.peak_force_n.unwrap() < bears_n, "{name}: {bound:?}");
        // What is needed is the bound's, or what the wearer gripped with.
        let needed_n = grip.needed_force_n.unwrap_or_default();
        assert!(slips || needed_n < bound.peak_force_n.unwrap(), "{name}: {needed_n} N");
    }
}

// Shows R4.
#[test]
fn cells_that_drift_add_nothing() {
    // All quadrants that run down are followed by a real slip, whose answer is needed.
    for name in ["drifting-quadrant", "drifting-quadrants"] {
        let report = ran(name);
        assert_eq!(report.object.kept, Some(true), "{name}");
        let without_n = report.added.added_without_need_n.unwrap();
        assert!(without_n < 0.1, "{name}: {without_n} N without need in {} pulses", report.reflex.pulses);
    }
}

// Shows R4.
#[test]
fn hum_that_closing_does_not_change_is_not_answered_for_long() {
    let report = ran("hum-after-slip");
    let without_n = report.added.added_without_need_n.unwrap();
    assert!(without_n < 1.5, "{without_n} N without need in {} pulses", report.reflex.pulses);
    let peak_n = report.grip.peak_force_n.unwrap();
    assert!(peak_n < 14.0, "{peak_n} N");
}

// Shows R3, W1.
#[test]
fn one_sound_electrode_is_enough_to_save_a_glass() {
    for name in ["lifted-extensor", "lifted-flexor", "dead-extensor"] {
        let report = ran(name);
        assert_eq!((report.object.kept, report.wearer.reflex_while_active), (Some(true), 0), "{name}");
        assert!(report.wearer.faults > 0, "{name}: nobody is told");
    }
}

// Shows R9.
#[test]
fn a_pulse_breaks_no_egg() {
    let report = ran("egg-filled");
    assert_eq!((report.object.kept, report.grip.broken_at_s), (Some(true), None), "{:?}", report.grip);
    let [peak_n, bound_n] = [report.grip.peak_force_n, report.bound.peak_force_n].map(Option::unwrap);
    assert!(report.reflex.pulses > 0 && peak_n < 2.0 * bound_n, "{peak_n} N, the bound {bound_n} N");
}

#[test]
fn what_drifts_and_hums_reaches_the_pins() {
    // The control of every scene in which nothing is to be answered: the disturbance is there.
    for (name, what) in [("drifting-quadrant", "[[fault]]"), ("hum-after-slip", "[[hum]]")] {
        let text = text(name);
        let last = |text: &str| {
            let mut world = World::new(&parsed(text), 1);
            (0..8 * 15_007).map(|_| world.scan(MotorDrive::Coast).codes()).last()
        };
        assert_ne!(last(&text), last(text.split(what).next().unwrap()), "{name}");
    }
}
