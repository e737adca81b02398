//! Two fingertips' images and the palm's on one bus.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use tenax_bench::board::emulated::Models;
use tenax_bench::hand::emulated::{Options, run, to_finger};
use tenax_bench::session::load_scene;
use tenax_hal_shim::wire::Down;
use tenax_palm::bus::CYCLE_US;
use tenax_palm::line;
use tenax_palm::palm::Report;
use tenax_palm::places::{Place, Places};

/// Of a fingertip and of the palm.
fn images() -> [&'static Path; 2] {
    static PALM: OnceLock<PathBuf> = OnceLock::new();
    let palm = PALM.get_or_init(|| tenax_bench::image::build_palm(super::root()).expect("the palm's image"));
    [super::image(), palm]
}

/// They are found, polled, and carry their lines; one of them is asked something through the palm. To every byte on the bus the host's
/// build says the same.
#[test]
fn two_images_and_a_palm_say_what_the_host_says() {
    let scene = load_scene("pinch").unwrap();
    let until_s = 0.4;
    let commands = vec![(0.1, to_finger(2, &Down::Ping))];
    let outcome = run(images(), &scene, &Options { until_s, commands, ..Options::default() }).unwrap();
    println!("{outcome}");
    assert!(outcome.holds());
    let found: Vec<Report> = outcome.reports.iter().map(|(_, report)| *report).collect();
    assert_eq!(found, [Report::Found(1), Report::Found(2)]);
    // Where it stops for the wires, a cycle begins a few microseconds late.
    assert!(outcome.garbled == 0 && outcome.cycle_us <= CYCLE_US + 10, "{outcome}");
    assert!(outcome.clock_us > 0.0 && outcome.clock_us <= 100.0, "{} us", outcome.clock_us);
    assert!(outcome.palm.agreement.frames > 400);
    for finger in &outcome.fingers {
        let polls = until_s * 1e6 / f64::from(CYCLE_US);
        assert!(finger.agreement.answers as f64 > 0.95 * polls, "{} answers", finger.agreement.answers);
        assert!(finger.agreement.slows > 20 && finger.messages > 20, "{finger:?}");
    }
    let asked = outcome.fingers.iter().map(|finger| (finger.agreement.commands, finger.answers));
    assert_eq!(asked.collect::<Vec<_>>(), [(0, 0), (1, 1)]);
}

/// A driver that stays on garbles a cycle; the image lets go of the wires by itself before anybody is lost.
#[test]
fn an_answer_without_an_end_is_given_up_before_a_finger_is_lost() {
    let scene = load_scene("pinch").unwrap();
    let options = Options { until_s: 0.15, stuck: Some((0.1, 0)), ..Options::default() };
    let outcome = run(images(), &scene, &options).unwrap();
    println!("{outcome}");
    assert!(outcome.garbled > 0);
    let found: Vec<Report> = outcome.reports.iter().map(|(_, report)| *report).collect();
    assert_eq!(found, [Report::Found(1), Report::Found(2)]);
    for finger in &outcome.fingers {
        assert!(finger.agreement.holds(), "{}", finger.agreement);
        let polls = options.until_s * 1e6 / f64::from(CYCLE_US);
        assert!((polls - 4.0..polls).contains(&(finger.agreement.answers as f64)), "{}", finger.agreement);
    }
}

#[test]
fn the_buss_models_do_as_rigless_own() {
    let scene = load_scene("pinch").unwrap();
    let [quick, rigless] = [Models::Quick, Models::Rigless].map(|models| {
        let options = Options { until_s: 0.05, models, ..Options::default() };
        let outcome = run(images(), &scene, &options).unwrap();
        assert!(outcome.holds() && outcome.fingers[0].agreement.answers > 20, "{outcome}");
        format!("{outcome:?}")
    });
    assert_eq!(quick, rigless);
}

/// A palm that has been told of one finger too few is told of both: it erases, starts anew, and knows them in their order from then on.
#[test]
fn a_palm_keeps_the_fingers_that_a_pc_names() {
    let scene = load_scene("pinch").unwrap();
    let place =
        |n| Place { chip: [Options::default().seed as u32, 7, n], normal: [1_000, 0], ceiling_mn: 9_000 };
    let other_way: Places = [place(1), place(0)].into_iter().collect();
    let commands = vec![(0.02, line::Down::Keep(other_way.clone())), (2.9, line::Down::Ask)];
    let outcome = run(images(), &scene, &Options { until_s: 3.0, commands, ..Options::default() }).unwrap();
    println!("{outcome}");
    assert!(outcome.palm.agreement.holds() && outcome.fingers.iter().all(|finger| finger.late == 0));
    let kept = line::Up::Hand(other_way);
    assert!(
        outcome.said.iter().all(|(_, said)| *said == kept) && outcome.said.len() == 2,
        "{:?}",
        outcome.said
    );
    let found: Vec<Report> = outcome.reports.iter().map(|(_, report)| *report).collect();
    assert_eq!(found, [Report::Found(1), Report::Found(2), Report::Found(1), Report::Found(2)]);
}
