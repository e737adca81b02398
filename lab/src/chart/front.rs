//! `tenax chart front`: what a grip pays in newtons for what it saves in millimetres.

use plotters::style::RGBColor;
use rayon::prelude::*;
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_sim::board::simulated::Grips;
use tenax_sim::jobs::Jobs;
use tenax_sim::plot::figure::colour;
use tenax_sim::plot::sheet::{Axis, Mark, Panel, Series, Sheet};
use tenax_sim::report::fate::Fate;
use tenax_sim::session::{self, controls};

use super::{Chart, Progress, csv};

const SEEDS: [u64; 2] = [1, 2];
/// A lost object, and one that slid further, counts as this, mm: the pad's length.
const LOST_MM: f64 = 18.0;
/// Least way in the chart, mm.
const LEAST_MM: f64 = 0.01;
/// Scenes with a panel of their own: a wet patch, a pour with the array, a pour, a toy, balls off the middle.
const OWN: [&str; 5] = ["glass", "array-pour", "pour", "hold-toy", "steel-balls"];

/// One run of a scene in one grip.
struct Run {
    scene: String,
    seed: u64,
    grip: String,
    fate: Fate,
}

impl Run {
    fn slid_mm(&self) -> f64 {
        if self.fate.kept() { self.fate.distance_mm.clamp(LEAST_MM, LOST_MM) } else { LOST_MM }
    }
}

/// Runs every shipped scene that holds something in every grip, and draws what it cost. All on the host.
/// Fails if the chart cannot be drawn.
pub fn front(progress: Progress) -> anyhow::Result<Chart> {
    let names: Vec<&str> = tenax_scene::builtin().iter().map(|(name, _)| *name).collect();
    let tries: Vec<(&str, u64)> =
        names.iter().flat_map(|name| SEEDS.into_iter().map(move |seed| (*name, seed))).collect();
    let jobs = Jobs::new(tries.len(), progress);
    let run = |&(scene, seed): &(&str, u64)| {
        let _job = jobs.begin();
        in_every_grip(scene, seed)
    };
    let runs: Vec<Vec<Run>> = tries.par_iter().map(run).collect::<anyhow::Result<_>>()?;
    let runs: Vec<Run> = runs.into_iter().flatten().collect();
    let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.4}"));
    let rows = runs.iter().map(|run| {
        let fate = &run.fate;
        let words = [run.scene.clone(), run.seed.to_string(), run.grip.clone(), fate.kept().to_string()];
        let numbers = [
            Some(fate.distance_mm),
            fate.beyond_need_n,
            fate.mean_grip_n,
            fate.peak_grip_n,
            fate.needed_force_n,
        ];
        words.into_iter().chain(numbers.map(number)).collect()
    });
    let header = "scene,seed,grip,kept,slid_mm,beyond_need_n,mean_n,peak_n,needed_n";
    let csv = csv(header, rows)?;
    let all = panel("all scenes that hold something, mean", &runs.iter().collect::<Vec<_>>());
    let own = OWN.map(|name| panel(name, &runs.iter().filter(|run| run.scene == name).collect::<Vec<_>>()));
    let sheet = Sheet::new(
        "What a grip pays for what it saves",
        format!(
            "newtons beyond need against millimetres slid; lost counts as {LOST_MM} mm; seeds 1 and 2; the best corner is the lower left"
        ),
        3,
        std::iter::once(all).chain(own).collect(),
    );
    Chart::new("front", &sheet, csv)
}

/// None of a scene in which nothing is carried.
fn in_every_grip(scene: &str, seed: u64) -> anyhow::Result<Vec<Run>> {
    let file = session::load_scene(scene)?;
    let hand = controls::gripped(&file, seed, Grips::Reflex(DetectorSet::ALL));
    if hand.mean_grip_n.is_none() {
        return Ok(Vec::new());
    }
    let bound = controls::bound(&file, seed, &hand);
    let controls = controls::runs(&file, seed, &hand);
    let own = [("the hand".to_owned(), hand), ("the bound".to_owned(), bound)];
    let runs = own.into_iter().chain(controls);
    Ok(runs.map(|(grip, fate)| Run { scene: scene.to_owned(), seed, grip, fate }).collect())
}

fn look(grip: &str) -> (RGBColor, Mark) {
    let of = |id: DetectorId| match id {
        DetectorId::S1 => colour::BLUE,
        DetectorId::S2 => colour::ORANGE,
        DetectorId::Hebbian => colour::GREEN,
        DetectorId::Mlp => colour::PURPLE,
        DetectorId::Photoelastic | DetectorId::Injected => colour::SKY,
    };
    let detector = DetectorId::ALL.into_iter().find(|id| grip.split(' ').any(|word| word == id.name()));
    match (grip, detector) {
        ("the hand", _) => (colour::VERMILLION, Mark::Dots),
        ("the bound", _) => (colour::GREEN, Mark::Dots),
        ("constant grip", _) => (colour::SKY, Mark::Dots),
        (alone, Some(id)) if alone.ends_with("alone") => (of(id), Mark::Rings),
        (_, Some(id)) => (of(id), Mark::Crosses),
        _ => (colour::GREY, Mark::Dots),
    }
}

fn panel(title: &str, runs: &[&Run]) -> Panel {
    let mut grips: Vec<&str> = Vec::new();
    for run in runs {
        if !grips.contains(&run.grip.as_str()) {
            grips.push(&run.grip);
        }
    }
    let series: Vec<Series> = grips
        .iter()
        .map(|grip| {
            let own: Vec<&&Run> = runs.iter().filter(|run| run.grip == *grip).collect();
            let mean =
                |of: &dyn Fn(&Run) -> f64| own.iter().map(|run| of(run)).sum::<f64>() / own.len() as f64;
            let point = (mean(&Run::slid_mm), mean(&|run| run.fate.beyond_need_n.unwrap_or(0.0)));
            let (colour, mark) = look(grip);
            Series::new(*grip, colour, mark, [point])
        })
        .collect();
    let most_n = series.iter().flat_map(|own| &own.points).map(|(_, n)| *n).fold(1.0, f64::max);
    Panel::new(
        title,
        Axis::log("slid, mm", 0.8 * LEAST_MM, 1.4 * LOST_MM),
        Axis::even("beyond need, mean, N", 0.0, 1.1 * most_n),
        series,
    )
}
