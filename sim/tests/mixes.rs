//! Settings anywhere in their ranges, several at once: none of them drops what the defaults keep, crushes it or deafens the hand.
//! `TENAX_MIXES=500 cargo test --release -p tenax-sim --test all mixes -- --nocapture`; `TENAX_SEED` draws others.

use std::fmt::Write as _;
use std::sync::OnceLock;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use tenax_logic::setting::SettingId;
use tenax_scene::SceneFile;
use tenax_sim::live::Use;
use tenax_sim::report::Report;
use tenax_sim::report::fate::Fate;
use tenax_sim::session::{self, Board, controls};

const SCENES: [&str; 6] = ["glass", "knocks", "array-pick", "gripper", "egg-filled", "wearer-control"];
const FORCE_RATIO: f64 = 1.5;
const OF_DEFAULTS: f64 = 1.25;
const DEFAULT_SEEDS: std::ops::RangeInclusive<u64> = 1..=4;
const OPEN_MS: f64 = 25.0;

type Mix = Vec<(SettingId, i32)>;

fn text(name: &str) -> String {
    let sets = |table: &&str| table.contains("kind = \"set-") && !table.contains("-flag\"");
    crate::common::text(name).split("[[").filter(|table| !sets(table)).collect::<Vec<_>>().join("[[")
}

fn scene(text: &str, mix: &[(SettingId, i32)]) -> SceneFile {
    let mut text = text.to_owned();
    for (id, value) in mix {
        let name = id.row().name;
        write!(text, "\n[[command]]\nat_s = 0.11\nkind = \"set-{name}\"\nvalue = {value}\n").unwrap();
    }
    crate::common::parsed(&text)
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Broken {
    Dropped,
    Pressed(f64),
    Active,
    OpenedLate(f64),
}

/// A scene, what the defaults did in it and what is allowed.
struct Scene {
    name: &'static str,
    text: String,
    seed: u64,
    defaults: Report,
    bound_n: f64,
    most: OnceLock<f64>,
}

impl Scene {
    fn new(name: &'static str, seed: u64) -> Self {
        let text = text(name);
        let file = scene(&text, &[]);
        // Beside a run that pressed however hard: the least from which nothing slides.
        let any = Fate { peak_grip_n: Some(f64::INFINITY), ..Fate::default() };
        let bound_n = controls::bound(&file, seed, &any).peak_grip_n.unwrap();
        Self { name, text, seed, defaults: ran(&file, seed), bound_n, most: OnceLock::new() }
    }

    /// The greatest force that a mix may press with, of the bound's. Asked where one presses more than the defaults should.
    fn most(&self) -> f64 {
        *self.most.get_or_init(|| {
            let file = scene(&self.text, &[]);
            let worst = DEFAULT_SEEDS.map(|seed| self.ratio(&ran(&file, seed))).fold(0.0, f64::max);
            if worst > FORCE_RATIO { OF_DEFAULTS * worst } else { FORCE_RATIO }
        })
    }

    fn ratio(&self, report: &Report) -> f64 {
        report.grip.peak_force_n.unwrap_or_default() / self.bound_n
    }

    fn broken_by(&self, mix: &[(SettingId, i32)]) -> Option<Broken> {
        let report = ran(&scene(&self.text, mix), self.seed);
        let kept = |report: &Report| report.object.kept == Some(true);
        // Whoever wished to open and was answered late; who was not answered at all opened nothing.
        let deaf = self.defaults.wearer.opening_s > 0.0 && report.wearer.opening_s == 0.0;
        match report.wearer.open_latency_ms {
            _ if kept(&self.defaults) && !kept(&report) => Some(Broken::Dropped),
            _ if self.ratio(&report) > FORCE_RATIO && self.ratio(&report) > self.most() => {
                Some(Broken::Pressed(self.ratio(&report)))
            }
            _ if report.wearer.reflex_while_active > 0 => Some(Broken::Active),
            _ if deaf => Some(Broken::OpenedLate(f64::INFINITY)),
            Some(ms) if ms > OPEN_MS => Some(Broken::OpenedLate(ms)),
            _ => None,
        }
    }
}

fn ran(file: &SceneFile, seed: u64) -> Report {
    session::scene_alone(file, seed, &Board::Host, Use::default(), &mut ()).unwrap().report
}

fn judged() -> Vec<SettingId> {
    SettingId::ALL.into_iter().filter(|id| id.row().unit != "flag").collect()
}

fn mix(rng: &mut ChaCha8Rng) -> Mix {
    let mut left = judged();
    let count = rng.random_range(1..=6);
    let each = (0..count).map(|_| {
        let id = left.swap_remove(rng.random_range(0..left.len()));
        let (min, max) = id.row().range().into_inner();
        (id, [min, max, rng.random_range(min..=max), rng.random_range(min..=max)][rng.random_range(0..4)])
    });
    each.collect()
}

// Shows W6, R2.
#[test]
fn no_mix_of_legal_settings_drops_crushes_or_deafens() {
    let (asked, seed) =
        (crate::common::asked("TENAX_MIXES").unwrap_or(0), crate::common::asked("TENAX_SEED").unwrap_or(1));
    let count = if asked == 0 { 4 } else { asked as usize };
    let seeds = if asked == 0 { seed..=seed } else { seed..=seed + 1 };
    let each: Vec<_> = seeds.flat_map(|seed| SCENES.map(|name| (name, seed))).collect();
    let scenes: Vec<Scene> = each.into_par_iter().map(|(name, seed)| Scene::new(name, seed)).collect();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut mixes: Vec<Mix> = (0..count).map(|_| mix(&mut rng)).collect();
    if asked > 0 {
        mixes.extend(
            judged().into_iter().flat_map(|id| [id.row().min, id.row().max].map(|end| vec![(id, end)])),
        );
    }
    let broken: Vec<_> = mixes
        .par_iter()
        .flat_map_iter(|mix| {
            scenes.iter().filter_map(move |scene| Some((scene.name, scene.seed, scene.broken_by(mix)?, mix)))
        })
        .collect();
    assert!(broken.is_empty(), "{broken:.2?}");
}

#[test]
fn what_only_a_trusted_line_may_set_drops_and_crushes() {
    for (name, id, is) in [
        ("glass", SettingId::SlipPulseMax, (|own| own == Broken::Dropped) as fn(Broken) -> bool),
        ("knocks", SettingId::ImpactRatio, |own| matches!(own, Broken::Pressed(_))),
    ] {
        let scene = Scene::new(name, 1);
        let ends = [*id.row().range_in_force(true).start(), *id.row().range_in_force(true).end()];
        assert!(ends.into_iter().filter_map(|end| scene.broken_by(&[(id, end)])).any(is), "{name}, {id:?}");
    }
}
