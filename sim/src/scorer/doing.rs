//! What was going on, for false alarms to be counted by.

use serde::Serialize;
use tenax_scene::SceneFile;
use tenax_scene::file::Happening;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Doing {
    Hold,
    Pour,
    Move,
    Disturb,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    pub from_s: f64,
    pub to_s: f64,
    pub doing: Doing,
}

pub fn in_scene(scene: &SceneFile) -> Vec<Stretch> {
    let happenings = scene.happenings();
    let end_s = scene.duration_s();
    let mut edges: Vec<f64> = happenings.iter().flat_map(|&(from_s, to_s, _)| [from_s, to_s]).collect();
    edges.extend([0.0, end_s]);
    edges.retain(|edge| (0.0..=end_s).contains(edge));
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    let at = |t_s: f64| {
        let is = |what: Happening| {
            happenings.iter().any(|&(from_s, to_s, own)| own == what && (from_s..to_s).contains(&t_s))
        };
        match () {
            () if is(Happening::Disturb) => Doing::Disturb,
            () if is(Happening::Pour) => Doing::Pour,
            () if is(Happening::Move) => Doing::Move,
            () => Doing::Hold,
        }
    };
    let pairs = edges.windows(2);
    pairs
        .map(|pair| Stretch { from_s: pair[0], to_s: pair[1], doing: at((pair[0] + pair[1]) / 2.0) })
        .collect()
}
