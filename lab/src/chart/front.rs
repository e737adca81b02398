//! `tenax chart front`: what a grip pays in newtons for what it loses and lets slide, on drawn worlds.

mod rivals;

use plotters::style::RGBColor;
use rayon::prelude::*;
use tenax_hal_shim::channel::{FRAME_HZ, FRAMES_PER_SLOW_FRAME};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_scene::SceneFile;
use tenax_scene::drawn::nth;
use tenax_scene::plant::Plant;
use tenax_sim::board::simulated::Grips;
use tenax_sim::drawn::HALF_PAD_MM;
use tenax_sim::jobs::Jobs;
use tenax_sim::plot::colour;
use tenax_sim::plot::sheet::{Axis, Mark, Panel, Series, Sheet};
use tenax_sim::report::fate::Fate;
use tenax_sim::session::controls;

use super::table::scored::wilson;
use super::{Chart, Progress, csv};
use rivals::{BAND_MN, Grip, Rival};

const CONSTANTS_N: [f64; 6] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
const CONSTANT: &str = "constant grip, 1 to 32 N";
const HAND: &str = "the hand";
const NOBODY: &str = "no reflex";
const RIVALS: [(&str, Rival); 3] = [
    ("S1, fixed pulses", Rival::Fixed),
    ("S1, S2, sized pulses", Rival::Sized),
    ("proportional with lead", Rival::Lead),
];
/// Newtons that the axis begins with.
const LEAST_N: f64 = 2.0;
const PAD_MM: f64 = 18.0;
/// Peak over what is needed from which a loop counts as too fast.
const OVER: f64 = 1.5;
/// Peak over the wearer's own from which the hand has closed.
const CLOSES: f64 = 1.02;
const MARKS: [(&str, RGBColor); 3] =
    [("the hand leaves it", colour::GREY), ("closes", colour::VERMILLION), ("loses", colour::BLUE)];
/// Deviations of an interval of 95 %.
const WIDE: f64 = 1.96;

/// A world in one grip.
struct Run {
    grip: String,
    fate: Fate,
}

struct World {
    name: String,
    dead_s: f64,
    rate_n_s: f64,
    hysteresis: f64,
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
            let numbers = own.into_iter().chain([world.needed_n]);
            let numbers = numbers.chain([world.dead_s, world.rate_n_s, world.hysteresis].map(Some));
            words.into_iter().chain(numbers.map(number)).collect()
        })
    });
    let csv = csv("world,grip,kept,slid_mm,beyond_need_n,peak_n,needed_n,dead_s,rate_n_s,hysteresis", rows)?;
    let sheet = Sheet::new(
        "What a grip pays for what it saves",
        format!(
            "{} of {count} drawn worlds of seed {seed}, those that a causal oracle holds within half a pad; crosses are intervals of 95 %; lower left is best",
            worlds.len()
        ),
        3,
        vec![
            lost_panel(&worlds),
            slid_panel(&worlds),
            flight_panel(&worlds),
            gain_panel(&worlds),
            hysteresis_panel(&worlds),
        ],
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
    let s1 = controls::gripped(file, seed, Grips::Reflex(DetectorSet::only(DetectorId::S1)));
    let nobody = controls::gripped(file, seed, Grips::Reflex(DetectorSet::NONE));
    let rivals = RIVALS.map(|(name, rival)| {
        let mut grip = Grip::new(rival);
        let mut choose = |own, fingertip: &_, _: &dyn Plant| grip.drive(own, fingertip);
        (name.to_owned(), controls::chosen(file, seed, &mut choose))
    });
    let constant =
        CONSTANTS_N.map(|n| (format!("constant {n} N"), controls::gripped(file, seed, Grips::Constant(n))));
    let own = [(HAND, hand), ("the hand, S1 alone", s1), ("causal oracle", oracle), ("the bound", bound)];
    let own = own.into_iter().chain([(NOBODY, nobody)]).map(|(grip, fate)| (grip.to_owned(), fate));
    let runs = own.chain(rivals).chain(constant).map(|(grip, fate)| Run { grip, fate }).collect();
    let [dead_s, rate_n_s] = file.motor();
    Ok(Some(World { name, dead_s, rate_n_s, hysteresis: file.hysteresis(), needed_n, runs }))
}

/// Grips in their order, with every run of each.
fn by_grip(worlds: &[World]) -> Vec<(&str, Vec<&Fate>)> {
    let grips = worlds.first().map_or(0, |world| world.runs.len());
    let of = |n: usize| worlds.iter().map(move |world| &world.runs[n]);
    (0..grips).map(|n| (worlds[0].runs[n].grip.as_str(), of(n).map(|run| &run.fate).collect())).collect()
}

/// Least, value and most.
type Interval = [f64; 3];

fn mean(all: impl Iterator<Item = f64> + Clone) -> Interval {
    let count = all.clone().count().max(1) as f64;
    let mean = all.clone().sum::<f64>() / count;
    let variance = all.map(|n| (n - mean) * (n - mean)).sum::<f64>() / count;
    let wide = WIDE * (variance / count).sqrt();
    [mean - wide, mean, mean + wide]
}

/// Newtons beyond need while it was carried, mean of the worlds.
fn paid(fates: &[&Fate]) -> Interval {
    mean(fates.iter().filter_map(|fate| fate.beyond_need_n)).map(|n| n.max(LEAST_N))
}

fn part(some: usize, of: usize) -> Interval {
    let all = of.max(1) as f64;
    let (low, high) = wilson(some as f64 / all, all);
    [low, some as f64 / all, high]
}

fn lost_panel(worlds: &[World]) -> Panel {
    let lost = |fates: &[&Fate]| part(fates.iter().filter(|fate| !fate.kept()).count(), fates.len());
    let most = by_grip(worlds).iter().map(|(_, fates)| lost(fates)[2]).fold(0.1, f64::max);
    Panel::new("what is lost", Axis::even("lost, part", 0.0, 1.1 * most), cost(worlds), points(worlds, &lost))
}

fn slid_panel(worlds: &[World]) -> Panel {
    let mm = |fate: &&Fate| if fate.kept() { fate.distance_mm.min(PAD_MM) } else { PAD_MM };
    let slid = |fates: &[&Fate]| mean(fates.iter().map(mm));
    let most = by_grip(worlds).iter().map(|(_, fates)| slid(fates)[2]).fold(1.0, f64::max);
    let axis = Axis::even("slid, mean, mm; the pad of 18 mm where it is lost", 0.0, 1.1 * most);
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
        "the hand, S1 alone" => colour::BLUE,
        "causal oracle" => colour::GREEN,
        "the bound" => colour::SKY,
        NOBODY => colour::YELLOW,
        "S1, fixed pulses" => colour::ORANGE,
        "S1, S2, sized pulses" => colour::PURPLE,
        "proportional with lead" => colour::BLACK,
        _ => colour::GREY,
    };
    (if grip.starts_with("constant") { CONSTANT } else { grip }, colour)
}

impl World {
    fn fate(&self, grip: &str) -> Option<&Fate> {
        self.runs.iter().find(|run| run.grip == grip).map(|run| &run.fate)
    }

    /// Peak force over the bound's; 0 for what is lost.
    fn peak(&self, grip: &str) -> Option<f64> {
        let (fate, needed_n) = (self.fate(grip)?, self.needed_n.filter(|&n| n > 0.0)?);
        if fate.kept() { Some(fate.peak_grip_n? / needed_n) } else { Some(0.0) }
    }
}

/// Where each world lies on two axes, and what became of it: the number of a mark.
type Placed = (f64, f64, usize);

/// A map of worlds with a line of theory. What lies beyond an axis is drawn at its end.
fn map(
    title: &str,
    [x, y]: [Axis; 2],
    theory: (&str, &dyn Fn(f64) -> f64),
    marks: [(&str, RGBColor); 3],
    placed: &[Placed],
) -> Panel {
    let (from, to) = x.ends;
    let at = |part: f64| if x.log { from * (to / from).powf(part) } else { from + (to - from) * part };
    let line = (0..=40).map(|n| at(f64::from(n) / 40.0)).map(|x| (x, theory.1(x)));
    let mut series =
        vec![Series::new(theory.0, colour::GREY, Mark::Dashes, line.filter(|point| y.shows(point.1)))];
    for (n, (name, colour)) in marks.into_iter().enumerate() {
        let own = placed.iter().filter(|placed| placed.2 == n);
        let own = own.map(|&(at, value, _)| (at.clamp(from, to), value.clamp(y.ends.0, y.ends.1)));
        series.push(Series::new(name, colour, if n == 2 { Mark::Crosses } else { Mark::Dots }, own));
    }
    Panel::new(title, x, y, series)
}

/// Dead time by stiffness: what is on its way when the force is seen comes beyond what is needed.
fn flight_panel(worlds: &[World]) -> Panel {
    let place = |world: &World| {
        let (peak, nobody) = (world.peak(HAND)?, world.fate(NOBODY)?.peak_grip_n?);
        let in_flight = world.dead_s * world.rate_n_s / world.needed_n?;
        let closes = world.fate(HAND)?.peak_grip_n? > CLOSES * nobody;
        Some((in_flight, peak, if peak == 0.0 { 2 } else { usize::from(closes) }))
    };
    let placed: Vec<Placed> = worlds.iter().filter_map(place).collect();
    let axes = [
        Axis::log("force in flight over what is needed", 0.03, 10.0),
        Axis::log("peak over what is needed", 0.8, 5.0),
    ];
    map("dead time by stiffness", axes, ("seen a dead time late", &|x| 1.0 + x), MARKS, &placed)
}

/// Delay by gain: an integrator with a dead time overshoots from 1/e on.
fn gain_panel(worlds: &[World]) -> Panel {
    let reading_s = f64::from(FRAMES_PER_SLOW_FRAME) / f64::from(FRAME_HZ);
    let place = |world: &World| {
        let peak = world.peak(RIVALS[2].0)?;
        let mark = if peak == 0.0 { 2 } else { usize::from(peak > OVER) };
        Some((1e3 * (world.dead_s + reading_s), 1e3 * world.rate_n_s / BAND_MN, mark))
    };
    let placed: Vec<Placed> = worlds.iter().filter_map(place).collect();
    let axes = [
        Axis::log("dead time and a reading, ms", 20.0, 120.0),
        Axis::log("gain of proportional with lead, 1/s", 1.0, 1_000.0),
    ];
    let marks = [("at most 1.5 times", colour::GREY), ("above", colour::VERMILLION), ("lost", colour::BLUE)];
    map("delay by gain", axes, ("gain times delay 1/e", &|ms| 1e3 / std::f64::consts::E / ms), marks, &placed)
}

/// Hysteresis by margin: a grip nearer to need than the force is read cannot be told from one that slips.
fn hysteresis_panel(worlds: &[World]) -> Panel {
    let place = |world: &World| {
        let (hand, nobody_n) = (world.fate(HAND)?, world.fate(NOBODY)?.peak_grip_n?);
        let margin = nobody_n / hand.needed_force_n.filter(|&n| n > 0.0)?;
        let closes = hand.peak_grip_n? > CLOSES * nobody_n;
        Some((world.hysteresis, margin, if hand.kept() { usize::from(closes) } else { 2 }))
    };
    let placed: Vec<Placed> = worlds.iter().filter_map(place).collect();
    let axes = [
        Axis::even("hysteresis of the force sensor, half width", 0.015, 0.085),
        Axis::log("the wearer's own grip over need", 0.3, 5.0),
    ];
    map("hysteresis by margin", axes, ("read as need", &|h| (1.0 + h) / (1.0 - h)), MARKS, &placed)
}
