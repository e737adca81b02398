//! `tenax evaluate`: the keys that programs read, and the worst first.

use tenax_lab::dataset::{Dataset, Plan};
use tenax_lab::evaluate::report::Report;
use tenax_lab::evaluate::test_split;
use tenax_sim::labelled::{Part, Recording, Step};
use tenax_sim::scorer::{Doing, SlipSpan};

/// Steps 30 to 49: the first of them ends at 0.38 s.
const SLIP: SlipSpan =
    SlipSpan { micro_onset_s: 0.2, macro_onset_s: Some(0.37), end_s: 0.63, distance_mm: 2.0, meant: false };

fn recording(material: &str, slips: &[bool]) -> Recording {
    Recording {
        name: format!("{material}-01-pour"),
        session: format!("{material}-01"),
        material: material.to_owned(),
        part: Some(Part::Test),
        doing: Doing::Pour,
        first_s: 0.005,
        slips: vec![SLIP],
        exact: true,
        steps: slips.iter().map(|&slip| Step { samples: [1_000; 10], slip }).collect(),
    }
}

#[test]
fn the_keys_are_those_of_the_issue_and_the_worst_comes_first() {
    let slips: Vec<bool> = (0..80).map(|at| (30..50).contains(&at)).collect();
    let recordings = [recording("plastic", &slips), recording("wood", &slips)];
    let late: Vec<bool> = (0..80).map(|at| (32..50).contains(&at)).collect();
    let silent = vec![false; 80];
    let report = Report::new(&recordings, &[late, silent], &[vec![Some(0); 80], vec![Some(0); 80]]);
    let value = serde_json::to_value(&report).unwrap();
    let keys = |value: &serde_json::Value| {
        value.as_object().unwrap().keys().map(String::as_str).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(
        keys(&value),
        "pour auc steps missed false accuracy balanced prevalence events false_per_hour false_by \
         by_material by_session"
    );
    assert_eq!((&value["steps"], &value["missed"], &value["false"]), (&160.into(), &22.into(), &0.into()));
    assert_eq!(
        keys(&value["events"]),
        "count caught early late said_before missed latency_ms_p50 latency_ms_p95 after_micro_ms_p50"
    );
    assert_eq!((&value["events"]["count"], &value["events"]["caught"]), (&2.into(), &1.into()));
    // Step 32 is read at 0.405 s and decided 2.5 ms later.
    let latency_ms = value["events"]["latency_ms_p50"].as_f64().unwrap();
    assert!((latency_ms - 37.5).abs() < 1e-9, "{latency_ms} ms");
    let pour = &value["pour"];
    for key in
        ["balanced", "accuracy", "prevalence", "caught_50ms", "false_per_hour", "missed_2800", "false_2800"]
    {
        assert!(pour[key].is_f64(), "pour.{key} is {}", pour[key]);
    }
    assert_eq!((&pour["prevalence"], &pour["caught_50ms"]), (&0.25.into(), &0.5.into()));
    assert!((pour["balanced"].as_f64().unwrap() - (18.0 / 40.0 + 1.0) / 2.0).abs() < 1e-12);
    assert_eq!(value["auc"], 0.5, "logits that are all alike");
    assert_eq!(keys(&value["by_material"]), "wood plastic");
    assert_eq!(value["by_session"]["wood-01"]["missed"], 20);
}

#[test]
fn a_data_set_carries_the_onsets_of_its_worlds_exactly() {
    let plan = Plan { seed: 5, sessions: 1 };
    let dataset = Dataset::make(plan, Some(Part::Validation), &|_| {}).unwrap();
    let read = dataset.recordings().unwrap();
    let mut slips = 0;
    for (made, read) in dataset.sessions.iter().flat_map(|(_, made)| made).zip(&read) {
        assert!(read.exact && read.doing == Doing::named(made.story.name()));
        assert_eq!(made.spans.len(), read.slips.len(), "{}", read.name);
        for (made, read) in made.spans.iter().zip(&read.slips) {
            assert!((made.micro_onset_s - read.micro_onset_s).abs() < 1e-6);
            let apart_s = made.macro_onset_s.zip(read.macro_onset_s).map(|(made, read)| (made - read).abs());
            assert!(apart_s.is_none_or(|s| s < 1e-6) && made.meant == read.meant);
            assert_eq!(made.macro_onset_s.is_some(), read.macro_onset_s.is_some());
            slips += usize::from(made.macro_onset_s.is_some());
        }
    }
    assert!(slips > 0);
}

#[test]
fn only_the_test_split_is_scored_unless_a_file_knows_none() {
    let train = Recording { part: Some(Part::Train), ..recording("plastic", &[false]) };
    let test = recording("wood", &[false]);
    let none = Recording { part: None, ..recording("paper", &[false]) };
    assert_eq!(test_split(vec![train, test.clone()]), [test]);
    assert_eq!(test_split(vec![none.clone()]), [none]);
}
