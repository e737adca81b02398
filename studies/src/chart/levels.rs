//! `tenax chart levels`: what each level of contact changes of a scene's outcome, and what it costs.

use std::collections::BTreeMap;
use std::time::Instant;

use rayon::prelude::*;
use serde::Serialize;
use tenax_bench::board::simulated::Grips;
use tenax_bench::jobs::Jobs;
use tenax_bench::session::controls;
use tenax_hal_shim::detector::DetectorSet;
use tenax_plot::figure::colour;
use tenax_plot::sheet::{Axis, Mark, Panel, Series, Sheet};
use tenax_scene::SceneFile;

use super::{Chart, Progress, csv};

/// Every scene is run with these.
const SEEDS: [u64; 2] = [1, 2];
/// The levels, each with the keys of `[contact]` that others have and it has not.
const LEVELS: [(&str, &[&str]); 3] = [
    ("l0", &["skin_n_per_mm", "skin_ms", "stribeck_mm_s"]),
    ("l1", &["stribeck_mm_s"]),
    ("l2", &["skin_n_per_mm", "skin_ms", "mu_per_decade"]),
];
/// A millimetre, or a tenth of the peak force, is a change.
const CHANGE_MM: f64 = 1.0;
const CHANGE_PART: f64 = 0.1;
/// What was lost is drawn here, mm: the pad's length. What slid less than the least is drawn there.
const LOST_MM: f64 = 18.0;
const LEAST_MM: f64 = 0.01;

/// What became of a scene's object at one level.
#[derive(Clone, Copy, Debug)]
struct Run {
    kept: bool,
    slid_mm: f64,
    peak_n: f64,
    took_s: f64,
}

impl Run {
    /// What differs from `own`, in words.
    fn changed(&self, own: &Self) -> Option<String> {
        let word = |kept| if kept { "kept" } else { "lost" };
        if self.kept != own.kept {
            return Some(format!("{}, not {}", word(self.kept), word(own.kept)));
        }
        let mm = (self.slid_mm - own.slid_mm).abs() > CHANGE_MM;
        let n = (self.peak_n / own.peak_n - 1.0).abs() > CHANGE_PART;
        let words = [
            mm.then(|| format!("{:.1} mm, not {:.1}", self.slid_mm, own.slid_mm)),
            n.then(|| format!("{:.1} N, not {:.1}", self.peak_n, own.peak_n)),
        ];
        let words: Vec<String> = words.into_iter().flatten().collect();
        (!words.is_empty()).then(|| words.join("; "))
    }

    fn drawn_mm(&self) -> f64 {
        if self.kept { self.slid_mm.clamp(LEAST_MM, LOST_MM) } else { LOST_MM }
    }
}

/// A scene with one seed.
struct Tried {
    scene: &'static str,
    seed: u64,
    /// Place of the level that ships.
    own: usize,
    /// None where the scene's physics has no such level: friction that rises with speed has no l2.
    runs: [Option<Run>; LEVELS.len()],
}

/// What the other levels change.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Runs in which something is held.
    pub runs: usize,
    /// Mean processor time over that of l0.
    pub cost: BTreeMap<&'static str, f64>,
    /// By scene and seed, and level: what differs from the level that ships.
    pub changed: BTreeMap<String, BTreeMap<&'static str, String>>,
}

/// Runs every shipped scene that holds something at every level. All on the host. Fails if the chart cannot be drawn.
pub fn chart(progress: Progress) -> anyhow::Result<(Chart, Report)> {
    let names = tenax_scene::builtin().iter().map(|(name, text)| (*name, *text));
    let tries: Vec<_> = names.flat_map(|own| SEEDS.map(|seed| (own, seed))).collect();
    let jobs = Jobs::new(tries.len(), progress);
    let tried = tries.par_iter().map(|&((scene, text), seed)| {
        let _job = jobs.begin();
        at_every_level(scene, text, seed)
    });
    let tried: Vec<Tried> = tried.collect::<anyhow::Result<Vec<_>>>()?.into_iter().flatten().collect();
    let rows = tried.iter().flat_map(|own| {
        own.runs.iter().zip(LEVELS).filter_map(|(run, (level, _))| {
            let run = run.as_ref()?;
            let words = [own.scene.to_owned(), own.seed.to_string(), level.to_owned(), run.kept.to_string()];
            let numbers = [run.slid_mm, run.peak_n, run.took_s].map(|number| format!("{number:.4}"));
            Some(words.into_iter().chain(numbers).collect())
        })
    });
    let csv = csv("scene,seed,level,kept,slid_mm,peak_n,took_s", rows)?;
    let subtitle = format!(
        "each scene at the level that ships and at the others; lost counts as {LOST_MM} mm; seeds 1 and 2"
    );
    let panels = vec![
        panel(&tried, "how far it slid", Axis::log("mm at", 0.8 * LEAST_MM, 1.4 * LOST_MM), Run::drawn_mm),
        panel(&tried, "greatest grip force", Axis::log("N at", 0.3, 100.0), |run| run.peak_n),
        panel(&tried, "time of a run", Axis::log("s at", 0.01, 30.0), |run| run.took_s),
    ];
    let sheet = Sheet::new("What a scene needs of its contact", subtitle, 3, panels);
    Ok((Chart::new("levels", &sheet, csv)?, Report::of(&tried)))
}

/// None of a scene in which nothing is held.
fn at_every_level(scene: &'static str, text: &str, seed: u64) -> anyhow::Result<Option<Tried>> {
    let table = SceneFile::table(text, scene)?;
    let contact = table.get("contact").and_then(toml::Value::as_table).cloned().unwrap_or_default();
    let ships = contact.get("level").and_then(toml::Value::as_str).unwrap_or(LEVELS[0].0).to_owned();
    let mut tried = Tried { scene, seed, own: 0, runs: [None; LEVELS.len()] };
    for (n, (level, not)) in LEVELS.iter().enumerate() {
        if *level == ships {
            tried.own = n;
        } else if *level == "l2" && contact.contains_key("mu_per_decade") {
            continue;
        }
        let mut contact = contact.clone();
        contact.retain(|key, _| !not.contains(&key));
        contact.insert("level".to_owned(), (*level).into());
        let mut table = table.clone();
        table.insert("contact".to_owned(), contact.into());
        let file = SceneFile::parse(&toml::to_string(&table)?, scene)?;
        let begun = Instant::now();
        let fate = controls::gripped(&file, seed, Grips::Reflex(DetectorSet::ALL));
        let took_s = begun.elapsed().as_secs_f64();
        tried.runs[n] = fate.mean_grip_n.zip(fate.peak_grip_n).map(|(_, peak_n)| Run {
            kept: fate.kept(),
            slid_mm: fate.distance_mm,
            peak_n,
            took_s,
        });
    }
    Ok(tried.runs[tried.own].is_some().then_some(tried))
}

impl Report {
    fn of(tried: &[Tried]) -> Self {
        let mut report = Self { runs: tried.len(), cost: BTreeMap::new(), changed: BTreeMap::new() };
        for (n, (level, _)) in LEVELS.into_iter().enumerate() {
            let both = tried.iter().filter_map(|own| Some(own.runs[n]?.took_s / own.runs[0]?.took_s));
            let costs: Vec<f64> = both.collect();
            report.cost.insert(level, costs.iter().sum::<f64>() / costs.len().max(1) as f64);
            for own in tried {
                let words =
                    own.runs[n].as_ref().zip(own.runs[own.own].as_ref()).and_then(|(a, b)| a.changed(b));
                if let Some(words) = words {
                    let of_scene = format!("{} ({}), seed {}", own.scene, LEVELS[own.own].0, own.seed);
                    report.changed.entry(of_scene).or_default().insert(level, words);
                }
            }
        }
        report
    }
}

fn panel(tried: &[Tried], title: &str, axis: Axis, of: impl Fn(&Run) -> f64) -> Panel {
    let label = axis.label.clone();
    let looks =
        [(colour::BLUE, Mark::Rings), (colour::ORANGE, Mark::Crosses), (colour::VERMILLION, Mark::Dots)];
    let series = LEVELS.into_iter().zip(looks).enumerate().map(|(n, ((level, _), (colour, mark)))| {
        let points = tried.iter().filter(|own| own.own != n);
        let points =
            points.filter_map(|own| Some((of(own.runs[own.own].as_ref()?), of(own.runs[n].as_ref()?))));
        Series::new(level, colour, mark, points.collect::<Vec<_>>())
    });
    let named = |what: &str| Axis { label: format!("{label} {what}"), ..axis.clone() };
    Panel::new(title, named("the level that ships"), named("another"), series.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lost_object_a_millimetre_and_a_tenth_of_the_force_are_changes() {
        let own = Run { kept: true, slid_mm: 5.2, peak_n: 16.0, took_s: 1.0 };
        assert_eq!(Run { slid_mm: 6.1, peak_n: 17.5, ..own }.changed(&own), None);
        assert_eq!(Run { kept: false, ..own }.changed(&own).unwrap(), "lost, not kept");
        assert_eq!(
            Run { slid_mm: 3.0, peak_n: 20.0, ..own }.changed(&own).unwrap(),
            "3.0 mm, not 5.2; 20.0 N, not 16.0"
        );
    }

    #[test]
    fn every_level_runs_and_the_glass_is_lost_where_friction_falls_with_speed() {
        let (name, text) = tenax_scene::builtin().iter().find(|(name, _)| *name == "glass").unwrap();
        let tried = at_every_level(name, text, 1).unwrap().unwrap();
        assert_eq!((tried.own, tried.runs.map(|run| run.unwrap().kept)), (0, [true, true, false]));
    }
}
