//! `tenax calibrate` on served scenes: weights are put on, a surface is stroked and muscles are contracted.

use std::io::{BufRead, BufReader};
use std::process::Stdio;
use std::thread;
use std::time::Duration;

use crate::serving::{BENCH, Serving, command, tenax};

/// A probe that is pressed on a surface at these instants (s), for so long (s), with this force (N); and drawn over it.
fn probe(duration_s: f64, presses: &[(f64, f64, f64)], sweeps: &[(f64, f64)]) -> String {
    let mut text = format!(
        "name = \"probe\"\ntitle = \"A probe\"\nfrom = \"a test\"\nslip_floor_mm_s = 1.0\nline_trusted = true\n\
         duration_s = {duration_s}\n[contact]\nmu_s = 0.5\nmu_d = 0.4\npad_length_mm = 18\npitch_mm = 1.2\n\
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

fn number(text: &str, after: &str) -> f64 {
    let rest = text.split(after).nth(1).unwrap_or_else(|| panic!("no '{after}': {text}"));
    rest.split_whitespace().next().unwrap().parse().unwrap()
}

fn known_weights_show_how_far_the_force_sensor_is_off() {
    let served = Serving::start(&probe(25.0, &[(6.0, 2.5, 2.0), (9.5, 2.5, 5.0), (13.0, 2.5, 10.0)], &[]));
    let force =
        |weights: &str| tenax(&["calibrate", "force", "--weights-n", weights, "--port", &served.place]);
    // The control, at the same time: a sixth less is put on than is said.
    let [(right, out, error), (wrong, off, _)] = thread::scope(|scope| {
        let wrong = scope.spawn(|| force("2.4,6,12"));
        [force("2,5,10"), wrong.join().unwrap()]
    });
    assert!(right && out.contains("Zeroed.") && out.contains("put on 5 N (510 g)"), "{out}{error}");
    assert!(out.contains("within 5 %: nothing to do"), "{out}");
    assert!(number(&out, "off that line by ") < 5.0, "{out}");
    assert!(wrong && off.contains("change the amplifier") && off.contains("reads 0.8"), "{off}");
    assert!((0.78..0.87).contains(&number(&off, "the board reads ")), "{off}");
    served.end();
}

fn strokes_measure_friction_and_set_s2() {
    let strokes = [5.0, 7.5, 10.0];
    let (presses, sweeps) = (strokes.map(|at_s| (at_s, 1.8, 2.0)), strokes.map(|at_s| (at_s + 0.5, 1.0)));
    let served = Serving::start(&probe(15.0, &presses, &sweeps));
    let (done, out, error) = tenax(&["calibrate", "friction", "--strokes", "3", "--port", &served.place]);
    // 0.5 on the board's scale of ratios, r / sqrt(1 + r^2), is 0.447; S2 is 0.8 of it.
    assert!(done && out.contains("3 of 3"), "{out}{error}");
    assert!((number(&out, "Static friction ") - 0.447).abs() < 0.03, "{out}");
    assert!((number(&out, "S2 is ") - 0.358).abs() < 0.03, "{out}");
    served.end();
}

fn three_prompts_calibrate_the_muscles() {
    let served = Serving::start(BENCH);
    thread::sleep(Duration::from_secs(1));
    served.tell("button");
    thread::sleep(Duration::from_millis(500));
    let mut child =
        command(&["calibrate", "emg", "--port", &served.place]).stdout(Stdio::piped()).spawn().unwrap();
    let mut said = String::new();
    for line in BufReader::new(child.stdout.take().unwrap()).lines().map(Result::unwrap) {
        for (prompt, key) in [("shall close the hand", "c"), ("shall open the hand", "o")] {
            if line.contains(prompt) {
                served.tell(key);
            }
        }
        said += &line;
    }
    assert!(child.wait().unwrap().success() && said.contains("Taken, and kept"), "{said}");
    served.end();
}

/// All at once: each waits for its scene nearly all the time.
#[test]
fn a_person_who_does_what_is_said_calibrates_the_hand() {
    thread::scope(|scope| {
        scope.spawn(known_weights_show_how_far_the_force_sensor_is_off);
        scope.spawn(strokes_measure_friction_and_set_s2);
        scope.spawn(three_prompts_calibrate_the_muscles);
    });
    let (done, _, error) = tenax(&["calibrate", "force", "--weights-n", "500", "--port", "nowhere"]);
    assert!(!done && error.contains("0.1 to 60 N"), "{error}");
}
