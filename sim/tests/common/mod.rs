//! What the host tool's tests share.

pub mod hash;

use std::path::{Path, PathBuf};
use std::str::FromStr;

use tenax_scene::{SceneFile, builtin};
use tenax_sim::live::Use;
use tenax_sim::replay::{Recipe, Recording};
use tenax_sim::session::{self, Board, Outcome};

pub fn asked<N: FromStr>(name: &str) -> Option<N> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

pub fn text(name: &str) -> String {
    let own = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes/");
    let read = || std::fs::read_to_string(format!("{own}{name}.toml")).expect("a scene of these tests");
    builtin::find(name).map_or_else(read, |(_, text)| text.into_owned())
}

pub fn loaded(name: &str) -> SceneFile {
    let own = format!("{}/tests/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let asked = if Path::new(&own).exists() { &own } else { name };
    session::load_scene(asked).unwrap_or_else(|error| panic!("{error}"))
}

pub fn parsed(text: &str) -> SceneFile {
    SceneFile::parse(text, "scene").unwrap_or_else(|error| panic!("{error}"))
}

pub fn ran(scene: &SceneFile, seed: u64) -> Outcome {
    session::scene(scene, seed, &Board::Host, &mut |_| {}).expect("it runs")
}

/// Without its bound, whose search takes longer than the run.
pub fn ran_alone(scene: &SceneFile, seed: u64) -> Outcome {
    let line = Use { without_bound: true, ..Use::default() };
    session::scene_served(scene, seed, &Board::Host, line, &mut (), &mut |_| {}).expect("it runs")
}

pub fn shared(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data").join(name)
}

pub fn recording(csv: &str) -> Recording {
    Recording::parse(csv.as_bytes(), "r.csv").expect("the recording is good")
}

pub fn recipe(body: &str) -> Recipe {
    Recipe::parse(&with_head(body), "r.toml").expect("the recipe is good")
}

/// Two lines, so that `body` begins in line 3.
pub fn with_head(body: &str) -> String {
    format!("title = 'T'\ndescription = 'D'\n{body}")
}
