//! The chart of `tenax chart vision` on known loads: what is told of shear and normal force, each load left out in its turn, and
//! why normal force is not told better: the same weight, set down again, spreads the skin by another amount.

use std::path::Path;

use anyhow::Result;

use super::{Chart, Progress, csv};
use crate::vision::calibrate::{Sample, Skin, by_load};
use tenax_sim::plot::figure::colour;
use tenax_sim::plot::sheet::{Axis, Mark, Panel, Series, Sheet};

/// A load, and what was told of its pictures.
struct Told {
    mass_g: f64,
    truth_n: [f64; 3],
    mean_n: [f64; 3],
    /// Standard deviation of the normal force over its pictures.
    varies_n: f64,
    spread_px: f64,
}

/// Draws how the loads of a table are told. Fails if the table or its pictures cannot be read.
pub fn chart(table: &Path, progress: Progress) -> Result<Chart> {
    let skin = Skin::at_rest(table)?;
    let samples = skin.samples(table)?;
    let mut by_load = by_load(&samples);
    by_load.retain(|own| samples[own[0]].mass_g > 0.0);
    let count = by_load.len();
    let mut loads = Vec::new();
    for (number, own) in by_load.iter().enumerate() {
        let others: Vec<Sample> =
            (0..samples.len()).filter(|at| !own.contains(at)).map(|at| samples[at].clone()).collect();
        let fitted = skin.fit(&others)?;
        let told: Vec<_> = own.iter().map(|&at| samples[at].estimate_n(&fitted)).collect();
        let n = told.len() as f64;
        let mean = |of: &dyn Fn(usize) -> f64| (0..told.len()).map(of).sum::<f64>() / n;
        let mean_n = [0, 1, 2].map(|axis| mean(&|at| told[at][axis]));
        loads.push(Told {
            mass_g: samples[own[0]].mass_g,
            truth_n: samples[own[0]].force_n,
            mean_n,
            varies_n: mean(&|at| (told[at][1] - mean_n[1]).powi(2)).sqrt(),
            spread_px: mean(&|at| samples[own[at]].spread_px()),
        });
        progress((number + 1) as f64 / count as f64);
    }
    let rows = loads.iter().map(|load| {
        let numbers = load.truth_n.iter().chain(&load.mean_n).chain([&load.varies_n, &load.spread_px]);
        std::iter::once(load.mass_g).chain(numbers.copied()).map(|value| format!("{value:.4}")).collect()
    });
    let header = "mass_g,x_n,normal_n,z_n,told_x_n,told_normal_n,told_z_n,normal_sd_n,spread_px";
    let csv = csv(header, rows)?;
    let sheet = Sheet::new(
        "Known loads on a real FingerVision skin",
        "A dot is a load, the mean of ten pictures, told by a calibration on all other loads",
        2,
        vec![shear(&loads), normal(&loads), direction(&loads), again(&loads)],
    );
    Chart::new("vision-loads", &sheet, csv)
}

fn dots(name: &str, colour: plotters::style::RGBColor, points: Vec<(f64, f64)>) -> Series {
    Series::new(name, colour, Mark::Dots, points)
}

fn line(name: &str, mark: Mark, points: Vec<(f64, f64)>) -> Series {
    Series::new(name, colour::GREY, mark, points)
}

fn shear(loads: &[Told]) -> Panel {
    let points = |axis: usize| loads.iter().map(|load| (load.truth_n[axis], load.mean_n[axis])).collect();
    Panel::new(
        "shear",
        Axis::even("truth, N", -3.5, 3.5),
        Axis::even("told, N", -3.5, 3.5),
        vec![
            line("as it is", Mark::Line, vec![(-3.5, -3.5), (3.5, 3.5)]),
            dots("shear along x", colour::BLUE, points(0)),
            dots("shear along z", colour::ORANGE, points(2)),
        ],
    )
}

fn normal(loads: &[Told]) -> Panel {
    let ends = |part: f64| vec![(1.0, part), (20.0, 20.0 * part)];
    Panel::new(
        "normal force",
        Axis::log("truth, N", 0.9, 25.0),
        Axis::log("told, N", 0.5, 30.0),
        vec![
            line("as it is", Mark::Line, ends(1.0)),
            line("15 % off", Mark::Dashes, ends(1.15)),
            line("15 % off", Mark::Dashes, ends(0.85)),
            dots(
                "normal force",
                colour::GREEN,
                loads.iter().map(|load| (load.truth_n[1], load.mean_n[1])).collect(),
            ),
        ],
    )
}

fn direction(loads: &[Told]) -> Panel {
    let heavy = || loads.iter().filter(|load| load.truth_n[1] > 3.0);
    let leans = |load: &&Told| load.truth_n[0].hypot(load.truth_n[2]) > 0.1;
    let off = |load: &Told| 100.0 * (load.mean_n[1] / load.truth_n[1] - 1.0);
    let at = |load: &Told| load.truth_n[2].atan2(load.truth_n[0]).to_degrees();
    let noise = |load: &Told| 100.0 * load.varies_n / load.truth_n[1];
    Panel::new(
        "normal force above 3 N: what is wrong, by the direction of the tilt",
        Axis::even("direction of shear, degrees", -185.0, 185.0),
        Axis::even("% of the load", -60.0, 60.0),
        vec![
            line("15 % off", Mark::Dashes, vec![(-185.0, 15.0), (185.0, 15.0)]),
            line("15 % off", Mark::Dashes, vec![(-185.0, -15.0), (185.0, -15.0)]),
            dots(
                "error of a load",
                colour::VERMILLION,
                heavy().filter(leans).map(|load| (at(load), off(load))).collect(),
            ),
            Series::new(
                "scatter of its ten pictures",
                colour::SKY,
                Mark::Rings,
                heavy().filter(leans).map(|load| (at(load), noise(load))),
            ),
        ],
    )
}

fn again(loads: &[Told]) -> Panel {
    let upright = loads.iter().filter(|load| load.truth_n[0].hypot(load.truth_n[2]) < 0.01);
    let tilted = loads.iter().filter(|load| load.truth_n[0].hypot(load.truth_n[2]) >= 0.01);
    let at = |load: &Told| (load.truth_n[1], load.spread_px / load.truth_n[1]);
    Panel::new(
        "how far a newton spreads the markers",
        Axis::log("normal force, N", 0.9, 25.0),
        Axis::even("px rms for each newton", 0.0, 0.5),
        vec![
            dots("tilted", colour::GREY, tilted.map(at).collect()),
            dots("upright, each mass set down twice", colour::PURPLE, upright.map(at).collect()),
        ],
    )
}
