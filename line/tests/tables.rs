//! The printed tables agree with the picture of the wiring; the layouts name only what a recording has.

use std::collections::BTreeSet;

use tenax_frames::link::Inbox;
use tenax_frames::record::topics::{Row, rows};
use tenax_hal_shim::channel::{COUNT, PVDF_COUNT};
use tenax_hal_shim::wire::{Senses, Up};
use tenax_line::tables;
use tenax_scene::World;
use tenax_sim::live::Use;
use tenax_sim::session::{Board, load_scene};

/// Pins such as PA0 that a text names.
fn pins(text: &str) -> BTreeSet<String> {
    let is_pin = |word: &&str| {
        let port = word.strip_prefix('P').filter(|rest| rest.starts_with(['A', 'B', 'C']));
        port.is_some_and(|rest| rest[1..].parse::<u8>().is_ok_and(|number| number < 16))
    };
    text.split(|c: char| !c.is_ascii_alphanumeric()).filter(is_pin).map(str::to_owned).collect()
}

#[test]
fn the_picture_has_the_tables_pins() {
    let picture = pins(include_str!("../../docs/figures/wiring.svg"));
    assert_eq!(picture, pins(&tables::wiring()));
    assert!(picture.len() > 20);
}

/// Topics and, behind the mark, fields of a recording of every stream.
fn paths(mark: char) -> BTreeSet<String> {
    let plant =
        Use { streams_at_start: true, ..Use::default() }.of(World::new(&load_scene("rig").unwrap(), 1));
    let (run, _) = Board::Host.run(plant, &mut |_| {}).unwrap();
    let mut inbox = Inbox::default();
    let messages = run.line.iter().filter_map(|&byte| inbox.push(byte)).flatten();
    let senses = Senses { frame: 0, samples: [0; COUNT], films: [0; PVDF_COUNT] };
    let messages = messages.map(|heard| heard.received.message).chain([Up::Senses(senses)]);
    let path = |row: Row| {
        let fields = row.fields.iter().map(|(field, _)| format!("{}{mark}{field}", row.topic));
        fields.chain([row.topic.to_string()]).collect::<Vec<_>>()
    };
    messages.flat_map(|message| rows(&message, 1)).flat_map(path).collect()
}

#[test]
fn every_path_of_a_layout_is_in_a_recording() {
    let between = |text: &str, before: &str| -> BTreeSet<String> {
        text.split(before).skip(1).map(|rest| rest.split('"').next().unwrap().to_owned()).collect()
    };
    let foxglove = include_str!("../../docs/layouts/foxglove.json");
    let plots = &between(foxglove, "\"value\": \"") | &between(foxglove, "\"topicPath\": \"");
    let plotjuggler = between(include_str!("../../docs/layouts/plotjuggler.xml"), "<curve name=\"");
    assert!(plots.len() > 12 && plotjuggler.len() > 45, "{plots:?} {plotjuggler:?}");
    assert_eq!(&plots - &paths('.'), BTreeSet::new());
    assert_eq!(&plotjuggler - &paths('/'), BTreeSet::new());
}
