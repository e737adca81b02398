//! The layouts for Foxglove and PlotJuggler name only what a recording has.

use tenax_frames::protobuf::Kind;
use tenax_frames::record::topics::Topic;

/// Every value that a recording has, as `TOPIC`, `mark` and the field.
fn values(mark: char) -> Vec<String> {
    let of = |topic: Topic| {
        let fields = topic.fields().into_iter().filter(|(_, kind)| *kind != Kind::Bytes);
        fields.map(move |(field, _)| format!("{}{mark}{field}", topic.name()))
    };
    Topic::all().into_iter().flat_map(of).collect()
}

/// What stands between this and the next quote, each time.
fn between<'a>(text: &'a str, before: &str) -> Vec<&'a str> {
    text.split(before).skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
}

/// Paths that no recording has.
fn unknown(paths: &[&str], mark: char) -> Vec<String> {
    let values = values(mark);
    let is_topic = |path: &str| Topic::all().iter().any(|topic| topic.name() == path);
    let is_there = |path: &str| values.iter().any(|value| value == path) || is_topic(path);
    paths.iter().filter(|path| !is_there(path)).map(ToString::to_string).collect()
}

#[test]
fn every_path_of_a_layout_is_in_a_recording() {
    let foxglove = include_str!("../../layouts/foxglove.json");
    let paths = [between(foxglove, "\"value\": \""), between(foxglove, "\"topicPath\": \"")].concat();
    assert!(paths.len() > 12, "{paths:?}");
    assert_eq!(unknown(&paths, '.'), [""; 0]);
    let plotjuggler = between(include_str!("../../layouts/plotjuggler.xml"), "<curve name=\"");
    assert!(plotjuggler.len() > 45, "{plotjuggler:?}");
    assert_eq!(unknown(&plotjuggler, '/'), [""; 0]);
    // The control.
    assert_eq!(unknown(&["/state.fn", "/line.data"], '.').len(), 2);
}

#[test]
fn every_panel_of_the_layout_has_its_place() {
    let foxglove: serde_json::Value =
        serde_json::from_str(include_str!("../../layouts/foxglove.json")).unwrap();
    let place = foxglove["layout"].to_string();
    for panel in foxglove["configById"].as_object().unwrap().keys() {
        assert!(place.contains(&format!("\"{panel}\"")), "{panel}");
    }
}
