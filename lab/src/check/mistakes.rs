//! A mistake gets one message that says where it is and what is allowed.

use tenax_scene::{SceneFile, builtin};

use super::Bar;
use tenax_sim::recipe::Kind;
use tenax_sim::replay::{Recipe, Recording};

/// The bars: one mistake of each kind.
pub fn bars() -> Vec<Bar> {
    let scene = builtin().first().map_or(String::new(), |(_, text)| format!("durations = 3\n{text}"));
    let recipe = Recipe::BUILTIN.first().map_or(String::new(), |(_, text)| text.replace("\"myo_", "\"mio_"));
    let csv = "t,pvdf_1\n0.0,1.65\n0.001,1,65\n";
    let scene = SceneFile::parse(&scene, "my.toml").map(|_| ()).map_err(|error| error.to_string());
    let recipe = Recipe::parse(&recipe, "my.toml").map(|_| ()).map_err(|error| error.to_string());
    let recording = Recording::parse(csv.as_bytes(), "my.csv").map(|_| ()).map_err(|error| error.to_string());
    vec![
        bar("a key that no scene has", scene, "my.toml:1"),
        bar("a recipe's channel that does not exist", recipe, "my.toml:"),
        bar("a recording's row with a cell too many", recording, "my.csv:3"),
    ]
}

fn bar(mistake: &str, result: Result<(), String>, place: &str) -> Bar {
    let promise = format!("{mistake}: a message with file and line");
    match result {
        Ok(()) => Bar::new(promise, "accepted", false),
        Err(message) => {
            let line = message.lines().next().unwrap_or_default();
            Bar::new(promise, line, message.starts_with(place))
        }
    }
}
