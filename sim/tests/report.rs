//! The report's keys: other people's programs read them.

use crate::common::{parsed, ran, ran_alone, text};
use serde_json::Value;
use tenax_hal_shim::detector::DetectorId;
use tenax_sim::plot::sheet::draw;
use tenax_sim::report::bound::{Bound, SAME_MM};
use tenax_sim::report::fate::Fate;
use tenax_sim::session::{self, Board, Outcome, controls};

/// The keys of a scene's report before those of its detectors, in order, as paths. None may go; new ones are added here.
const KEYS: &str = "
    scene board seed virtual_s wall_s overruns
    ticks.count ticks.dropped ticks.instructions_mean ticks.instructions_max ticks.load_percent
    ticks.core_load_percent load.tick_instructions_mean load.period_instructions_mean stack_bytes
    slip.micro_onset_s slip.macro_onset_s slip.caught slip.latency_ms slip.distance_mm slip.dropped
    slip.macro_slips slip.macro_slips_caught
    bound.kept bound.distance_mm bound.peak_force_n bound.distance_ratio bound.peak_force_ratio controls
    grip.peak_force_n grip.needed_force_n grip.crushed_at_s grip.dent_mm grip.broken_at_s
    wearer.none wearer.reflex_while_active wearer.open_latency_ms wearer.active_first_s wearer.active_permille wearer.reflex_ticks
    wearer.closing_s wearer.opening_s wearer.longest_open_ms wearer.longest_close_ms wearer.faults
    wearer.vibration_steps wearer.vibration_s
    margin.least_mn margin.last_mn
    reflex.pulses reflex.without_slip reflex.added_n reflex.added_without_need_n reflex.closings_without_need reflex.relaxed_n
    added_n added_without_need_n closings_without_need relaxed_n object.kept object.left_behind
    object.handed_over object.turned_deg behaviours
";

const DETECTOR_KEYS: [&str; 6] = ["first_s", "detections", "false_alarms", "said", "acted", "events"];

const LAST_KEYS: &str = "
    detectors.wearer.first_s detectors.wearer.detections detectors.wearer.false_alarms
    faults line.bytes line.messages_missed line.telemetry_dropped line.bad_frames
";

const REPLAY_KEYS: &str = "
    replay.recording replay.recipe replay.first_s replay.duration_s replay.lead_in_s replay.longest_gap_ms
    replay.unused_columns replay.assumed replay.doubts
    replay.force.peak_ratio replay.force.peak_s
    replay.force.s2_first_s replay.force.s2_before_peak_ms replay.force.s1_first_s replay.force.s1_before_peak_ms
    replay.muscle.onset_s replay.muscle.noticed_s replay.muscle.onset_delay_ms replay.muscle.active_part
    replay.muscle.reflex_while_active
    replay.meant.wants replay.meant.never replay.meant.wanted_s replay.meant.wrong_ms
";

fn leaves(value: &Value, path: &str, into: &mut Vec<String>) {
    match value {
        Value::Object(map) if !path.ends_with(".events") => {
            for (key, value) in map {
                leaves(value, format!("{path}.{key}").trim_start_matches('.'), into);
            }
        }
        _ => into.push(path.to_owned()),
    }
}

fn found(report: &Value) -> Vec<String> {
    let mut found = Vec::new();
    leaves(report, "", &mut found);
    found
}

fn expected(replay: &'static str) -> Vec<String> {
    let words = |keys: &'static str| keys.split_whitespace().map(str::to_owned);
    let of = |id: DetectorId| DETECTOR_KEYS.map(|key| format!("detectors.{}.{key}", id.name()));
    let detectors = DetectorId::ALL.into_iter().flat_map(of);
    words(KEYS).chain(detectors).chain(words(LAST_KEYS)).chain(words(replay)).collect()
}

fn replayed(csv: &str, recipe: Option<&str>) -> Outcome {
    let recording = tempfile::Builder::new().suffix(".csv").tempfile().unwrap();
    std::fs::write(recording.path(), csv).unwrap();
    let file = recipe.map(|text| {
        let file = tempfile::Builder::new().suffix(".toml").tempfile().unwrap();
        std::fs::write(file.path(), text).unwrap();
        file
    });
    let recipe = file.as_ref().map(|file| file.path().to_str().unwrap());
    session::replay(recording.path(), recipe, 1, &Board::Host, &mut |_| {}).unwrap()
}

#[test]
fn a_scenes_keys_are_stable() {
    let outcome = ran(&parsed(&text(session::DEFAULT_SCENE)), 1);
    let report = serde_json::to_value(&outcome.report).unwrap();
    assert_eq!(found(&report), expected("replay"));
    let events = &report["detectors"]["s1"]["events"];
    for key in ["count", "caught", "early", "late", "said_before", "missed"] {
        assert!(events[key].is_u64(), "events.{key}");
    }
    let by = events["false_by"].as_object().unwrap();
    assert!(by.keys().map(String::as_str).eq(["hold", "pour", "move", "disturb"]), "{by:?}");
    for alarms in by.values().chain([&events["false_alarms"]]) {
        assert!(alarms["per_hour"].is_f64() && alarms["hours"].as_f64() > Some(0.0));
    }
}

/// A ratio may be below 1 by this much: the bound's least force is found to a hundredth, and planned two above the edge of sliding.
const TOLERANCE: f64 = 0.03;

#[test]
fn no_hand_and_no_control_is_better_than_the_bound() {
    // A patch, a rotation, a wearer, an array that dies, a turn, pulls. With TENAX_SCENES=all, in ten minutes: every scene and control.
    let few = ["steel-balls", "pour", "hold", "array-lost", "array-pick", "push-gentle", "turn-pen"];
    let whole = std::env::var("TENAX_SCENES").is_ok_and(|own| own == "all");
    let all = tenax_scene::builtin().iter().map(|(name, _)| *name);
    let scenes: Vec<&str> = if whole { all.collect() } else { few.to_vec() };
    let mut worse = Vec::new();
    for scene in scenes {
        let file = parsed(&text(scene));
        let outcome = ran(&file, 1);
        let controls = if whole { controls::runs(&file, 1, &outcome.truth) } else { Vec::new() };
        let beside = |fate: &Fate| Bound::of(Some(fate), Some(&controls::bound(&file, 1, fate)));
        let controls = controls.into_iter().map(|(name, fate)| (name, beside(&fate), fate));
        let hand = ("the hand".to_owned(), outcome.report.bound, outcome.truth);
        for (name, bound, fate) in std::iter::once(hand).chain(controls) {
            let longer = bound.distance_mm.unwrap() - fate.distance_mm > SAME_MM;
            let harder = bound.peak_force_ratio.is_some_and(|ratio| ratio < 1.0 - TOLERANCE);
            if longer || harder || (fate.kept() && bound.kept == Some(false)) {
                worse.push(format!("{scene}, {name}: {bound:?}"));
            }
        }
    }
    assert!(worse.is_empty(), "{worse:#?}");
}

#[test]
fn a_push_is_planned_for() {
    let bound = controls::bound(&parsed(&text("push-gentle")), 1, &Fate::default());
    // A screwdriver of 0.29 N that is pushed down with 3 N: half of it on each finger, by 0.6 of a patch's hold.
    assert!(bound.kept() && bound.distance_mm < SAME_MM, "{bound:?}");
    let least_n = (0.03 * 9.81 + 3.0) / 2.0 / 0.6;
    assert!((1.0..1.3).contains(&(bound.peak_grip_n.unwrap() / least_n)), "{bound:?}");
}

#[test]
fn a_grip_that_is_enough_by_itself_is_its_own_bound() {
    let outcome = ran_alone(&parsed(&text("swung")), 1);
    let bound = controls::bound(&parsed(&text("swung")), 1, &outcome.truth);
    assert!(
        outcome.truth.kept() && bound.kept() && bound.peak_grip_n < outcome.truth.peak_grip_n,
        "{bound:?}"
    );
}

#[test]
fn the_controls_of_a_scene_are_worse_than_the_reflex() {
    let file = parsed(&text("array-pour"));
    let outcome = ran_alone(&file, 1);
    let controls = controls::controls(&file, 1, &outcome.truth);
    let names: Vec<&str> = controls.iter().map(|control| control.name.as_str()).collect();
    let each = ["s1", "s2", "hebbian", "mlp"];
    let expected = ["no reflex", "constant grip"].map(str::to_owned).into_iter();
    let expected = expected.chain(each.map(|id| format!("{id} alone")));
    let expected: Vec<String> = expected.chain(each.map(|id| format!("without {id}"))).collect();
    assert_eq!(names, expected);
    assert!(outcome.report.object.kept == Some(true) && !controls[0].kept, "{:?}", controls[0]);
    // The constant grip has the run's mean force, within the edge of closing.
    let (own, mean) = (outcome.truth.mean_grip_n.unwrap(), controls[1].mean_force_n.unwrap());
    assert!((mean / own - 1.0).abs() < 0.05, "{mean} N for {own} N");
}

#[test]
fn a_replays_keys_are_stable() {
    let recipe = "title = ''\ndescription = ''\n[force]\nnormal = 'n'\nshear_x = 's'\n\
                  [[map]]\ncolumn = 'm'\nchannels = ['myo_flexor']\ngain = 1.0\n\
                  [[meaning]]\nnamed = '*'\nwants = 'rest'\nnever = ['open']\n";
    let report = replayed("t,n,s,m\n0,1,0,0\n0.5,1,0,0\n", Some(recipe)).report;
    assert_eq!(found(&serde_json::to_value(&report).unwrap()), expected(REPLAY_KEYS));
    // What did not happen or is not known is null.
    assert_eq!((report.slip.dropped, report.bound.distance_mm, report.grip.peak_force_n), (None, None, None));
}

#[test]
fn a_run_is_drawn_and_a_recording_of_two_rows_too() {
    for (csv, words) in [
        (
            "t,pvdf_1,fsr_a\n0,1.65,0.2\n0.5,1.8,0.9\n",
            &["force, N", "Ft/Fn", "S1", "S2", "gate", "time, s"][..],
        ),
        ("t,pvdf_1\n0,1.65\n0.0001,1.7\n", &["</svg>\n"]),
    ] {
        let svg = draw::svg(&replayed(csv, None).figure).unwrap();
        assert!(words.iter().all(|word| svg.contains(word)), "{words:?}");
    }
}
