//! `tenax evaluate`: the keys that programs read, the worst first, and the online tasks at a small scale.

use tenax::evaluate::online;
use tenax::evaluate::report::Report;
use tenax::evaluate::test_split;
use tenax::labelled::{Part, Recording, Step};
use tenax::session::Board;

fn recording(material: &str, slips: &[bool]) -> Recording {
    Recording {
        name: format!("{material}-01-pour"),
        session: format!("{material}-01"),
        material: material.to_owned(),
        part: Some(Part::Test),
        steps: slips.iter().map(|&slip| Step { samples: [1_000; 10], slip }).collect(),
    }
}

#[test]
fn the_keys_are_those_of_the_issue_and_the_worst_comes_first() {
    let slips: Vec<bool> = (0..80).map(|at| (30..50).contains(&at)).collect();
    let recordings = [recording("plastic", &slips), recording("wood", &slips)];
    let late: Vec<bool> = (0..80).map(|at| (32..50).contains(&at)).collect();
    let silent = vec![false; 80];
    let report = Report::new(&recordings, &[late, silent.clone()], &[silent.clone(), silent]);
    let value = serde_json::to_value(&report).unwrap();
    let keys: Vec<&String> = value.as_object().unwrap().keys().collect();
    assert_eq!(
        keys,
        [
            "steps",
            "missed",
            "false",
            "accuracy",
            "events",
            "false_per_hour",
            "by_material",
            "by_session",
            "without_lookback"
        ]
    );
    assert_eq!((&value["steps"], &value["missed"], &value["false"]), (&160.into(), &22.into(), &0.into()));
    let events: Vec<&String> = value["events"].as_object().unwrap().keys().collect();
    assert_eq!(events, ["count", "caught", "latency_ms_p50", "latency_ms_p95"]);
    assert_eq!((&value["events"]["count"], &value["events"]["caught"]), (&2.into(), &1.into()));
    assert_eq!(value["events"]["latency_ms_p50"], 25.0);
    let materials: Vec<&String> = value["by_material"].as_object().unwrap().keys().collect();
    assert_eq!(materials, ["wood", "plastic"]);
    assert_eq!(value["by_session"]["wood-01"]["missed"], 20);
    assert_eq!(value["without_lookback"]["missed"], 40);
}

#[test]
fn only_the_test_split_is_scored_unless_a_file_knows_none() {
    let train = Recording { part: Some(Part::Train), ..recording("plastic", &[false]) };
    let test = recording("wood", &[false]);
    let none = Recording { part: None, ..recording("paper", &[false]) };
    assert_eq!(test_split(vec![train, test.clone()]), [test]);
    assert_eq!(test_split(vec![none.clone()]), [none]);
}

#[test]
fn each_task_is_tried_with_each_material_and_the_same_seed_gives_the_same_fate() {
    let tries = || online::tasks(1, 1, &Board::Host, &|_| {}).unwrap();
    let (first, again) = (tries(), tries());
    assert_eq!(serde_json::to_value(&first).unwrap(), serde_json::to_value(&again).unwrap());
    let rows = online::rows(&first);
    assert_eq!(rows.len(), 8);
    for row in rows {
        assert_eq!(row.tries, 1, "{} {}", row.task, row.material);
        assert!(row.needed_force_n > 0.5 && row.peak_force_n > row.needed_force_n * 0.5, "{row:?}");
    }
}
