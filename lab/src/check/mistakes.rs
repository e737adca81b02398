//! A mistake in a file gets one message that says where it is and what is allowed.

use std::fmt::Display;

use tenax_scene::{SceneFile, builtin};
use tenax_sim::recipe::Kind;
use tenax_sim::replay::{Recipe, Recording};

use super::Bar;

pub fn bars() -> Vec<Bar> {
    let scene = builtin().first().map_or(String::new(), |(_, text)| format!("durations = 3\n{text}"));
    let recipe = Recipe::BUILTIN.first().map_or(String::new(), |(_, text)| text.replace("\"myo_", "\"mio_"));
    let csv = "t,pvdf_1\n0.0,1.65\n0.001,1,65\n";
    vec![
        bar("a key that no scene has", SceneFile::parse(&scene, "my.toml"), "my.toml:1"),
        bar("a recipe's channel that does not exist", Recipe::parse(&recipe, "my.toml"), "my.toml:"),
        bar("a recording's row with a cell too many", Recording::parse(csv.as_bytes(), "my.csv"), "my.csv:3"),
    ]
}

fn bar<T, E: Display>(mistake: &str, result: Result<T, E>, place: &str) -> Bar {
    let message = result.map_or_else(|error| error.to_string(), |_| "accepted".to_owned());
    let line = message.lines().next().unwrap_or_default();
    Bar::new(mistake, line, "a message with file and line", message.starts_with(place))
}
