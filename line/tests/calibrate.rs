//! `tenax calibrate` on served scenes, in which weights are put on and surfaces are stroked at known instants: nobody presses a
//! key. The muscles are calibrated in `journey.rs`.

use std::thread;

use crate::serving::Serving;
use crate::tool::tenax;

const HEAD: &str = "name = \"bench\"
title = \"A bench\"
from = \"a test\"
slip_floor_mm_s = 1.0
line_trusted = true
";

/// A probe that is pressed on a surface with these forces, N, each from an instant on for so long, s; and drawn over it.
fn bench(duration_s: f64, presses: &[(f64, f64, f64)], sweeps: &[(f64, f64)]) -> String {
    let mut text = format!(
        "{HEAD}duration_s = {duration_s}\n[contact]\nmu_s = 0.5\nmu_d = 0.4\npad_length_mm = 18\npitch_mm = 1.2\n\
         [robot]\nprobe_kg = 0.2\nstiffness_n_per_mm = 0.5\ndamping = 0.7\nramp_ms = 80\n"
    );
    for (at_s, for_s, load_n) in presses {
        text += &format!("[[press]]\nat_s = {at_s}\nfor_s = {for_s}\nload_n = {load_n}\n");
    }
    for (at_s, for_s) in sweeps {
        text += &format!("[[sweep]]\nat_s = {at_s}\nfor_s = {for_s}\nspeed_mm_s = 20\n");
    }
    text
}

fn calibrate(place: &str, args: &[&str]) -> (bool, String, String) {
    tenax(&[&["calibrate"], args, &["--port", place]].concat())
}

/// The number that follows these words.
fn number(text: &str, after: &str) -> f64 {
    let rest = text.split(after).nth(1).unwrap_or_else(|| panic!("no '{after}': {text}"));
    rest.split_whitespace().next().unwrap().parse().unwrap()
}

fn known_weights_show_how_far_the_force_sensor_is_off() {
    let presses = [(6.0, 2.5, 2.0), (9.5, 2.5, 5.0), (13.0, 2.5, 10.0)];
    let mut served = Serving::start(&bench(25.0, &presses, &[]), &[]);
    let place = served.places[0].clone();
    // The control, at the same time: somebody who puts on a sixth less than they say.
    let wrong = thread::spawn(move || calibrate(&place, &["force", "--weights-n", "2.4,6,12"]));
    let (done, out, error) = calibrate(&served.places[0], &["force", "--weights-n", "2,5,10"]);
    println!("{out}{error}");
    assert!(done && out.contains("Zeroed.") && out.contains("put on 5 N (510 g)"), "{out}{error}");
    assert!(out.contains("within 5 %: nothing to do"), "{out}");
    assert!(number(&out, "off that line by ") < 5.0, "{out}");
    let (done, out, error) = wrong.join().unwrap();
    assert!(done && out.contains("change the amplifier") && out.contains("reads 0.8"), "{out}{error}");
    // What it proposes is a command that the board takes.
    let proposed = out.lines().find_map(|line| line.trim().strip_prefix("tenax config ")).expect("a command");
    println!("{proposed}");
    let gain = number(&out, "the board reads ");
    assert!((0.78..0.87).contains(&gain), "{out}");
    assert!((number(proposed, "force-ceiling-mn=") - 40_000.0 * gain).abs() < 30.0, "{proposed}");
    assert!((number(proposed, "loaded-mn=") - 600.0 * gain).abs() < 1.0, "{proposed}");
    let words: Vec<&str> = proposed.split(' ').collect();
    let (set, _, error) = tenax(&[&["config"], &words[..], &["--port", &served.places[0]]].concat());
    assert!(set, "{error}");
    served.kill();
}

fn strokes_measure_friction_and_set_s2() {
    let strokes = [5.0, 7.5, 10.0];
    let presses = strokes.map(|at_s| (at_s, 1.8, 2.0));
    let sweeps = strokes.map(|at_s| (at_s + 0.5, 1.0));
    let mut served = Serving::start(&bench(15.0, &presses, &sweeps), &[]);
    let (done, out, error) = calibrate(&served.places[0], &["friction", "--strokes", "3"]);
    println!("{out}{error}");
    // 0.5 on the board's scale of ratios, r / sqrt(1 + r^2), is 0.447; S2 is 0.8 of it.
    assert!(done && out.contains("3 of 3"), "{out}{error}");
    assert!((number(&out, "Static friction ") - 0.447).abs() < 0.03, "{out}");
    assert!((number(&out, "S2 is ") - 0.358).abs() < 0.03, "{out}");
    served.kill();
}

/// All at once: each waits for its scene nearly all the time.
#[test]
fn a_person_who_does_what_is_said_calibrates_the_hand() {
    thread::scope(|scope| {
        scope.spawn(known_weights_show_how_far_the_force_sensor_is_off);
        scope.spawn(strokes_measure_friction_and_set_s2);
    });
}

#[test]
fn the_help_says_how() {
    let (done, out, _) = calibrate("nowhere", &["--help"]);
    assert!(done && out.contains("tenax calibrate force --weights-n 1,2,5,10"), "{out}");
    let (done, _, error) = calibrate("nowhere", &["force", "--weights-n", "500"]);
    assert!(!done && error.contains("0.1 to 60 N"), "{error}");
}
