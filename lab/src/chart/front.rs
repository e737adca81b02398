//! `tenax chart front`: what a grip pays in newtons for what it loses and lets slide, on drawn worlds.

use plotters::style::RGBColor;
use rayon::prelude::*;
use tenax_frames::quantile::not_exceeded;
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_scene::SceneFile;
use tenax_scene::drawn::nth;
use tenax_sim::board::simulated::Grips;
use tenax_sim::drawn::HALF_PAD_MM;
use tenax_sim::jobs::Jobs;
use tenax_sim::plot::figure::colour;
use tenax_sim::plot::sheet::{Axis, Mark, Panel, Series, Sheet};
use tenax_sim::report::fate::Fate;
use tenax_sim::session::controls;

use super::{Chart, Progress, csv};

const CONSTANTS_N: [f64; 6] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
const CONSTANT: &str = "constant grip, 1 to 32 N";
const HAND: &str = "the hand";
const KEPT: &str = "kept by the hand";
const LOST: &str = "lost";
const THEORY: &str = "a step that is seen a dead time late";
/// Way and loss that a logarithm can show.
const LEAST_MM: f64 = 0.3;
const LEAST_N: f64 = 0.5;
const PAD_MM: f64 = 18.0;
/// Deviations of an interval of 95 %.
const WIDE: f64 = 1.96;

/// A world in one grip.
struct Run {
    grip: String,
    fate: Fate,
}

struct World {
    name: String,
    /// Force that the motor adds within its dead time.
    in_flight_n: f64,
    needed_n: Option<f64>,
    runs: Vec<Run>,
}

/// Runs `count` worlds of `seed` in every grip, and draws what each cost where a causal oracle keeps. All on the host.
/// Fails if the chart cannot be drawn.
pub fn front(seed: u64, count: u32, progress: Progress) -> anyhow::Result<Chart> {
    let jobs = Jobs::new(count as usize, progress);
    let run = |n| {
        let _job = jobs.begin();
        let drawn = nth(None, seed, n);
        in_every_grip(&drawn.scene()?, drawn.noise_seed, format!("{} {}", drawn.family.name(), drawn.index))
    };
    let worlds: Vec<Option<World>> =
        (0..count).into_par_iter().with_max_len(1).map(run).collect::<anyhow::Result<_>>()?;
    let worlds: Vec<World> = worlds.into_iter().flatten().collect();
    let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.4}"));
    let rows = worlds.iter().flat_map(|world| {
        world.runs.iter().map(move |Run { grip, fate }| {
            let words = [world.name.clone(), grip.clone(), fate.kept().to_string()];
            let own = [Some(fate.distance_mm), fate.beyond_need_n, fate.peak_grip_n];
            let numbers = own.into_iter().chain([world.needed_n, Some(world.in_flight_n)]);
            words.into_iter().chain(numbers.map(number)).collect()
        })
    });
    let csv = csv("world,grip,kept,slid_mm,beyond_need_n,peak_n,needed_n,in_flight_n", rows)?;
    let sheet = Sheet::new(
        "What a grip pays for what it saves",
        format!(
            "{} of {count} drawn worlds of seed {seed}, those that a causal oracle holds within half a pad; crosses are intervals of 95 %; lower left is best",
            worlds.len()
        ),
        3,
        vec![lost_panel(&worlds), slid_panel(&worlds), flight_panel(&worlds)],
    );
    Chart::new("front", &sheet, csv)
}

/// None of a world that the oracle does not hold.
fn in_every_grip(file: &SceneFile, seed: u64, name: String) -> anyhow::Result<Option<World>> {
    let oracle = controls::oracle(file, seed);
    if !oracle.kept() || oracle.distance_mm > HALF_PAD_MM {
        return Ok(None);
    }
    let hand = controls::gripped(file, seed, Grips::Reflex(DetectorSet::ALL));
    let bound = controls::bound(file, seed, &hand);
    let needed_n = bound.peak_grip_n;
    let alone = [DetectorId::S1, DetectorId::S2, DetectorId::Mlp].map(|id| {
        let grips = Grips::Reflex(DetectorSet::only(id));
        (format!("{} alone", id.name()), controls::gripped(file, seed, grips))
    });
    let nobody = controls::gripped(file, seed, Grips::Reflex(DetectorSet::NONE));
    let constant =
        CONSTANTS_N.map(|n| (format!("constant {n} N"), controls::gripped(file, seed, Grips::Constant(n))));
    let own = [(HAND, hand), ("causal oracle", oracle), ("the bound", bound), ("no reflex", nobody)];
    let runs = own.into_iter().map(|(grip, fate)| (grip.to_owned(), fate)).chain(alone).chain(constant);
    let runs = runs.map(|(grip, fate)| Run { grip, fate }).collect();
    Ok(Some(World { name, in_flight_n: file.force_in_flight_n(), needed_n, runs }))
}

/// Grips in their order, with every run of each.
fn by_grip(worlds: &[World]) -> Vec<(&str, Vec<&Fate>)> {
    let grips = worlds.first().map_or(0, |world| world.runs.len());
    let of = |n: usize| worlds.iter().map(move |world| &world.runs[n]);
    (0..grips).map(|n| (worlds[0].runs[n].grip.as_str(), of(n).map(|run| &run.fate).collect())).collect()
}

/// Least, value and most.
type Interval = [f64; 3];

/// Newtons beyond need while it was carried, mean of the worlds.
fn paid(fates: &[&Fate]) -> Interval {
    let all: Vec<f64> = fates.iter().filter_map(|fate| fate.beyond_need_n).collect();
    let count = all.len().max(1) as f64;
    let mean = all.iter().sum::<f64>() / count;
    let variance = all.iter().map(|n| (n - mean) * (n - mean)).sum::<f64>() / count;
    let wide = WIDE * (variance / count).sqrt();
    [mean - wide, mean, mean + wide].map(|n| n.max(LEAST_N))
}

/// Wilson's interval of a part.
fn part(some: usize, of: usize) -> Interval {
    let (n, p) = (of.max(1) as f64, some as f64 / of.max(1) as f64);
    let (middle, scale) = (p + WIDE * WIDE / (2.0 * n), 1.0 + WIDE * WIDE / n);
    let wide = WIDE * (p * (1.0 - p) / n + WIDE * WIDE / (4.0 * n * n)).sqrt();
    [(middle - wide) / scale, p, (middle + wide) / scale]
}

fn lost_panel(worlds: &[World]) -> Panel {
    let lost = |fates: &[&Fate]| part(fates.iter().filter(|fate| !fate.kept()).count(), fates.len());
    let most = by_grip(worlds).iter().map(|(_, fates)| lost(fates)[2]).fold(0.1, f64::max);
    Panel::new("what is lost", Axis::even("lost, part", 0.0, 1.1 * most), cost(worlds), points(worlds, &lost))
}

fn slid_panel(worlds: &[World]) -> Panel {
    let slid = |fates: &[&Fate]| {
        let mm = |fate: &&Fate| if fate.kept() { fate.distance_mm.min(PAD_MM) } else { PAD_MM };
        let mut all: Vec<f64> = fates.iter().map(mm).collect();
        all.sort_by(f64::total_cmp);
        // Order statistics beside the quantile, by the binomial's deviation.
        let wide = WIDE * (0.95 * 0.05 / all.len().max(1) as f64).sqrt();
        [0.95 - wide, 0.95, (0.95 + wide).min(1.0)]
            .map(|part| not_exceeded(all.iter().copied(), part).unwrap_or(0.0).max(LEAST_MM))
    };
    let axis = Axis::log("slid in 95 % of the worlds, mm", 0.8 * LEAST_MM, 1.4 * PAD_MM);
    Panel::new("what slides", axis, cost(worlds), points(worlds, &slid))
}

fn cost(worlds: &[World]) -> Axis {
    let most_n = by_grip(worlds).iter().map(|(_, fates)| paid(fates)[2]).fold(1.0, f64::max);
    Axis::log("beyond need, mean, N", LEAST_N, 1.3 * most_n)
}

fn points(worlds: &[World], of: &dyn Fn(&[&Fate]) -> Interval) -> Vec<Series> {
    let mut series: Vec<Series> = Vec::new();
    for (grip, fates) in by_grip(worlds) {
        let ([left, x, right], [low, y, high]) = (of(&fates), paid(&fates));
        let cross = [(x, y), (left, y), (right, y), (x, y), (x, low), (x, high), (x, y)];
        let (name, colour) = look(grip);
        match series.last_mut().filter(|last| last.name == name) {
            Some(constant) => constant.points.extend(cross),
            None => series.push(Series::new(name, colour, Mark::Line, cross)),
        }
    }
    series
}

fn look(grip: &str) -> (&str, RGBColor) {
    let colour = match grip {
        HAND => colour::VERMILLION,
        "causal oracle" => colour::GREEN,
        "the bound" => colour::SKY,
        "s1 alone" => colour::BLUE,
        "s2 alone" => colour::ORANGE,
        "mlp alone" => colour::PURPLE,
        "no reflex" => colour::YELLOW,
        _ => colour::GREY,
    };
    (if grip.starts_with("constant") { CONSTANT } else { grip }, colour)
}

/// Where the motor is the limit: what is on its way when the force is seen comes beyond what is needed.
fn flight_panel(worlds: &[World]) -> Panel {
    let place = |world: &World| {
        let needed_n = world.needed_n.filter(|&n| n > 0.0)?;
        let hand = world.runs.iter().find(|run| run.grip == HAND)?;
        Some((world.in_flight_n / needed_n, hand.fate.peak_grip_n? / needed_n, hand.fate.kept()))
    };
    let places: Vec<(f64, f64, bool)> = worlds.iter().filter_map(place).collect();
    let of = |kept: bool| places.iter().filter(move |place| place.2 == kept).map(|&(x, y, _)| (x, y));
    let ends = |least: f64, most: f64, of: &dyn Fn(&(f64, f64, bool)) -> f64| {
        let all = places.iter().map(of);
        all.fold((least, most), |(low, high), value| (low.min(0.9 * value), high.max(1.1 * value)))
    };
    let (left, right) = ends(0.1, 1.0, &|place| place.0);
    let (low, high) = ends(0.5, 2.0, &|place| place.1);
    let theory = (0..=40).map(|n| left * (right / left).powf(f64::from(n) / 40.0)).map(|x| (x, 1.0 + x));
    let series = vec![
        Series::new(THEORY, colour::GREY, Mark::Dashes, theory.filter(|point| point.1 <= high)),
        Series::new(KEPT, colour::VERMILLION, Mark::Dots, of(true)),
        Series::new(LOST, colour::BLUE, Mark::Crosses, of(false)),
    ];
    let x = Axis::log("force in flight over what is needed", left, right);
    Panel::new("where the motor is the limit", x, Axis::log("peak over what is needed", low, high), series)
}
