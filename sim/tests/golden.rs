//! The golden gate: one hash of every decision, event, drive and force of each shipped scene and recording, on the host's logic.
//! A change that is not meant to change a decision leaves `golden.txt` as it is. `TENAX_GOLDEN=write` writes it anew.

use std::fs;
use std::path::Path;

use rayon::prelude::*;
use tenax_scene::{SceneFile, World, builtin};
use tenax_sim::board::hash::{Hash, of_run, of_scene};
use tenax_sim::board::{Run, simulated};
use tenax_sim::live::Use;
use tenax_sim::replay::Recipe;
use tenax_sim::session::{self, Board};

use crate::common::hash::compare;
use crate::common::shared;

const SEEDS: [u64; 2] = [1, 2];

fn scene(name: &str, text: &str, seed: u64) -> Hash {
    let file = SceneFile::parse(text, name).expect("a shipped scene is good");
    let (run, mut world) = simulated::run(World::new(&file, seed));
    of_scene(&run, &mut world)
}

fn replayed(path: &Path) -> Hash {
    let (mut run, line) = (Run::default(), Use::default());
    let outcome = session::replay_served(path, (None, None), line, 1, &Board::Host, &mut run, &mut |_| {});
    run.summary = outcome.expect("the recording and its recipe are good").run;
    of_run(&run)
}

#[test]
fn scenes_decide_as_held() {
    let runs: Vec<(&str, &str, u64)> =
        builtin().iter().flat_map(|&(name, text)| SEEDS.map(|seed| (name, text, seed))).collect();
    let hashes = runs
        .par_iter()
        .map(|&(name, text, seed)| (format!("{name} {seed}"), scene(name, text, seed)))
        .collect();
    compare("scene", &hashes);
}

#[test]
#[cfg_attr(not(recordings), ignore = "no recordings in ../shared/data")]
fn recordings_decide_as_held() {
    let folder = fs::read_dir(shared("")).expect("the recordings");
    let files: Vec<_> = folder.map(|entry| entry.expect("an entry").path()).collect();
    let hashes = files
        .par_iter()
        .filter(|path| path.extension().is_some_and(|ending| ending == "csv"))
        .filter(|path| Recipe::for_file(path).expect("the recipes are good").is_some())
        .map(|path| (session::name_of(path), replayed(path)))
        .collect();
    compare("recording", &hashes);
}
