//! A camera's program and a board that is served, two processes as a person starts them: what the camera sees arrives, a behaviour
//! acts on it, the network learns from it, and when the camera fails the hand holds by its own senses.

use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

use serde_json::Value;
use tenax_hal_shim::behaviour::Behaviour;
use tenax_hal_shim::wire::{Slow, Up};
use tenax_hal_shim::words::{Code, DriveSource};
use tenax_frames::link::{Client, Target};

use crate::serving::Serving;

/// A can that a robot's hand takes, and whose line is trusted. No camera is in it: the one that is tried comes down the line.
const SCENE: &str = "
name = 'served'
title = 'T'
from = 'F'
duration_s = 26
slip_floor_mm_s = 1.0
arm = 'robot'
line_trusted = true

[contact]
level = 'l1'
mu_s = 0.8
mu_d = 0.65
pad_length_mm = 18
pitch_mm = 0.5

[object]
mass_kg = 0.05
width_mm = 66
stiffness_n_per_mm = 1.0

[gripper]
opening_mm = 70

[[command]]
at_s = 0.2
kind = 'close'
duty_permille = 100
for_s = 0.6

[[move]]
at_s = 3.0
for_s = 1.0
to_mm = 100
";

/// What a board did while a drawn camera told it of its pictures, and what both said at the end.
struct Seen {
    slows: Vec<Slow>,
    camera: Value,
    said: String,
    run: Value,
}

impl Seen {
    /// Cycles in which the behaviour closed the hand.
    fn answered(&self) -> usize {
        let answers = |slow: &&Slow| {
            let closes =
                slow.ticks.iter().any(|tick| tick.source == DriveSource::Behaviour && tick.drive.closes());
            closes && slow.behaviour == Some(Behaviour::Hold)
        };
        self.slows.iter().filter(answers).count()
    }

    /// Cycles in which the network learned that the object slips, and that it does not.
    fn lessons(&self) -> [usize; 2] {
        let learned = |slips: bool| {
            let is_one = |slow: &&Slow| slow.lesson.is_some_and(|codes| (codes[0] == Code::Minus) == slips);
            self.slows.iter().filter(is_one).count()
        };
        [true, false].map(learned)
    }

    /// Messages of the camera that the board took, and that it refused.
    fn answers(&self) -> [usize; 2] {
        let line = self.said.lines().find(|line| line.contains("messages of the camera")).expect("it says");
        let mut numbers = line.split(' ').filter_map(|word| word.parse().ok());
        [(); 2].map(|()| numbers.next().expect("two numbers"))
    }

    fn says(&self, what: &str) -> bool {
        self.said.contains(what)
    }
}

fn see(more: &[&str]) -> Seen {
    let served = Serving::start(SCENE, &["--serve"]);
    let [one, other] = [0, 1].map(|at| served.places[at].clone());
    let mut camera = Command::new(env!("CARGO_BIN_EXE_tenax-host"));
    camera.args(["vision", "--drawn", "--seed", "1", "--teach", "--begin", "hold", "--rate-hz", "20"]);
    camera.args(["--report", "json", "--port", &other]).args(more);
    // The scene's own commands come first: a line has one sender at a time.
    thread::sleep(Duration::from_millis(1_200));
    let camera = camera.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
    let listener = thread::spawn(move || {
        let target: Target = one.parse().expect("a place");
        let mut client = Client::open(&target).expect("it is served");
        let mut slows = Vec::new();
        while let Ok(heard) = client.next_message() {
            if let Some(Up::Slow(slow)) = heard.map(|heard| heard.received.message) {
                slows.push(slow);
            }
        }
        slows
    });
    let output = camera.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let run = served.report();
    let slows = listener.join().expect("it listened");
    Seen { slows, camera: serde_json::from_slice(&output.stdout).expect("JSON"), said, run }
}

fn kept(seen: &Seen) {
    assert_eq!(seen.run["object"]["kept"], true, "{}", seen.run["object"]);
    assert_eq!(seen.run["behaviours"][0]["name"], "hold", "{}", seen.run["behaviours"]);
    assert_eq!(
        seen.run["behaviours"][0]["ending"],
        Value::Null,
        "it holds to the end: {}",
        seen.run["behaviours"]
    );
}

#[test]
fn a_served_board_feels_with_a_camera_learns_from_it_and_holds_without_it() {
    let lost = thread::spawn(|| see(&["--fault", "lost"]));
    let seen = see(&[]);
    // At the start it refuses what comes before it trusts its line.
    let [took, refused] = seen.answers();
    assert!(took > 200 && refused < 50, "{}", seen.said);
    assert!(seen.camera["slip_share"].as_f64().is_some_and(|share| share > 0.05), "{}", seen.camera);
    assert!(
        seen.answered() > 0,
        "the hold answers what the camera sees: {} {}",
        seen.said,
        seen.run["behaviours"]
    );
    let [slipping, still] = seen.lessons();
    assert!(slipping > 20 && still > 20, "{slipping} and {still} cycles of lessons: {}", seen.said);
    kept(&seen);

    let lost = lost.join().expect("the other one");
    assert!(
        lost.says("the camera is lost; nothing is told") && lost.says("the camera sees again"),
        "{}",
        lost.said
    );
    assert!(lost.camera["blind"]["lost"].as_u64().is_some_and(|times| times >= 1), "{}", lost.camera);
    // Half a second of the slip is not told, nor learned.
    let [untold, _] = lost.lessons();
    assert!(untold < slipping, "{untold} {slipping}");
    kept(&lost);
}

#[test]
fn each_way_in_which_a_camera_fails_is_noticed_and_said() {
    for (fault, least) in [("late", 40), ("frozen", 40), ("covered", 50), ("lost", 1)] {
        let mut camera = Command::new(env!("CARGO_BIN_EXE_tenax-host"));
        camera.args(["vision", "--drawn", "--seed", "1", "--report", "json", "--fault", fault]);
        let output = camera.output().expect("it starts");
        let said = String::from_utf8_lossy(&output.stderr);
        let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        for (kind, count) in report["blind"].as_object().expect("counts") {
            let count = count.as_u64().expect("a count");
            // Between the last picture in time and the first late one nothing comes for more than 200 ms.
            let most = u64::from(fault == "late" && kind == "lost");
            assert!(if kind == fault { count >= least } else { count <= most }, "{fault}: {report}");
        }
        assert!(said.contains(&format!("the camera is {fault}; nothing is told")), "{said}");
        assert!(said.contains("the camera sees again"), "{said}");
    }
}
