//! The map: step by stiffness, the error as colour, and theory's bound over it.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use tenax_scene::bounds;
use tenax_scene::stepping::problem::{Impact, Problem, Stroke, error};
use tenax_scene::stepping::{LuGre, Method, Moreau, methods};

use super::{Chart, FAILED, Progress, SHIPPED_US, csv, draw};
use tenax_plot::figure::colour;
use tenax_plot::sheet::{Axis, Cell, Mark, Panel, Series, Sheet};

/// The longest step, cut into so many.
const CUTS: [u32; 16] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256];
/// The reference is the same method at a step so many times shorter than the shortest of the map.
const FINER: f64 = 1_024.0;
/// Bristles, N/m: three a decade from 10^3 to 10^8.
const BRISTLES: (i32, i32) = (9, 24);
/// Mats, N/m: three a decade from 10^3 to 10^6, the stiffest that a scene file may state.
const MATS: (i32, i32) = (9, 18);
/// Of the colours.
const ERRORS: (f64, f64) = (1e-5, 1.0);

/// A column of the map: one stiffness.
struct Column {
    panel: usize,
    stiffness_n_per_m: f64,
    errors: Vec<f64>,
}

pub fn chart(progress: Progress) -> anyhow::Result<Chart> {
    let columns = columns(progress);
    let titles = methods(LuGre::SHARP).map(|method| format!("{} (stroke)", method.name()));
    let titles = titles.into_iter().chain(["Moreau, Coulomb (impact with the table)".to_owned()]);
    let panels = titles.enumerate().map(|(n, title)| panel(n, title, &columns)).collect();
    let rows = columns.iter().flat_map(|column| {
        let name = panel_name(column.panel);
        CUTS.iter().zip(&column.errors).map(move |(cuts, error)| {
            let figures = [
                column.stiffness_n_per_m,
                step_s(*cuts) * 1e6,
                *error,
                bound_s(column.panel, column.stiffness_n_per_m) * 1e6,
            ];
            std::iter::once(name.clone()).chain(figures.map(|figure| format!("{figure:.4e}"))).collect()
        })
    });
    let header = ["method", "stiffness_n_per_m", "step_us", "error", "bound_us"];
    let csv = csv(&header, rows)?;
    let sheet = Sheet {
        title: "Where each step fails: step by stiffness".to_owned(),
        subtitle: "Stroke: worst error of the way, over 1 mm, against the same method at a step at least 1024 times shorter. \
                   Impact: against the closed form."
            .to_owned(),
        columns: 3,
        panels,
        errors: Some(ERRORS),
    };
    Ok(Chart { name: "stepping-map", svg: draw::svg(&sheet)?, csv })
}

fn columns(progress: Progress) -> Vec<Column> {
    let third = |n: i32| 10_f64.powf(f64::from(n) / 3.0);
    // Moreau has no bristle: its column is the same at each stiffness, and is run once.
    let mut jobs: Vec<(usize, f64)> =
        (BRISTLES.0..=BRISTLES.1).flat_map(|n| (0..4).map(move |panel| (panel, third(n)))).collect();
    jobs.push((4, third(BRISTLES.0)));
    jobs.extend((MATS.0..=MATS.1).map(|n| (5, third(n))));
    let done = AtomicUsize::new(0);
    let all = jobs.len() as f64;
    let run = |&(panel, stiffness_n_per_m): &(usize, f64)| {
        let column = Column { panel, stiffness_n_per_m, errors: errors(panel, stiffness_n_per_m) };
        progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / all);
        column
    };
    let mut columns: Vec<Column> = jobs.par_iter().map(run).collect();
    let alike = columns.iter().find(|column| column.panel == 4).map(|column| column.errors.clone());
    columns.extend((BRISTLES.0 + 1..=BRISTLES.1).map(|n| Column {
        panel: 4,
        stiffness_n_per_m: third(n),
        errors: alike.clone().unwrap_or_default(),
    }));
    columns
}

/// The error at each step.
fn errors(panel: usize, stiffness_n_per_m: f64) -> Vec<f64> {
    let at = |problem: &dyn Problem, method: &dyn Method, reference: &[f64]| {
        CUTS.iter().map(|cuts| error(&problem.figures(method, step_s(*cuts)), reference)).collect()
    };
    match methods(LuGre::stiff(stiffness_n_per_m)).get(panel) {
        Some(method) => {
            let shortest_s = step_s(CUTS[CUTS.len() - 1]);
            at(&Stroke, &**method, &Stroke.figures(&**method, shortest_s / FINER))
        }
        None => {
            let impact = Impact { mat_n_per_m: stiffness_n_per_m };
            at(&impact, &Moreau, &impact.closed_form().unwrap_or_default())
        }
    }
}

fn step_s(cuts: u32) -> f64 {
    Stroke::LONGEST_S / f64::from(cuts)
}

/// Where theory puts the edge, s; infinite where there is none. For a bristle: the shorter of that of sliding and that
/// of sticking, when it is a spring under the mass.
fn bound_s(panel: usize, k: f64) -> f64 {
    let c = LuGre::stiff(k).damping_ns_per_m(Stroke::MASS_KG);
    let (limit_n, slide_m_s, mass_kg) = (Stroke::SLIDING_N, Stroke::SPEED_M_S, Stroke::MASS_KG);
    match panel {
        0 => bounds::explicit_bristle_s(limit_n, k, slide_m_s)
            .min(bounds::explicit_oscillator_s(mass_kg, k, c)),
        1 => bounds::runge_kutta_bristle_s(limit_n, k, slide_m_s)
            .min(bounds::runge_kutta_oscillator_s(mass_kg, k, c)),
        2 => bounds::semi_implicit_oscillator_s(mass_kg, k, c),
        5 => bounds::semi_implicit_oscillator_s(Impact::MASS_KG, k, 0.0),
        _ => f64::INFINITY,
    }
}

fn panel_name(panel: usize) -> String {
    let name = methods(LuGre::SHARP).get(panel).map(|method| method.name());
    name.map_or_else(|| "Moreau, Coulomb; table's mat".to_owned(), str::to_owned)
}

fn panel(n: usize, title: String, columns: &[Column]) -> Panel {
    let (range, label) = match n {
        4 => (BRISTLES, "bristle, N/m (it has none)"),
        5 => (MATS, "mat of the table, N/m"),
        _ => (BRISTLES, "bristle stiffness, N/m"),
    };
    let sixth = |thirds: i32, sixths: i32| 10_f64.powf(f64::from(2 * thirds + sixths) / 6.0);
    let x = Axis::log(label, sixth(range.0, -1), sixth(range.1, 1));
    let edge_us = |low: u32, high: u32| 1e6 * (step_s(low) * step_s(high)).sqrt();
    let (first, last) = (CUTS[0], CUTS[CUTS.len() - 1]);
    let y = Axis::log("step, us", 1e6 * step_s(last) / 1.2, 1e6 * step_s(first) * 1.2);
    let cells = columns.iter().filter(|column| column.panel == n).flat_map(|column| {
        let half = 10_f64.powf(1.0 / 6.0);
        column.errors.iter().enumerate().map(move |(row, error)| Cell {
            x: (column.stiffness_n_per_m / half, column.stiffness_n_per_m * half),
            y: (
                CUTS.get(row + 1).map_or(1e6 * step_s(last) / 1.2, |next| edge_us(CUTS[row], *next)),
                row.checked_sub(1)
                    .map_or(1e6 * step_s(first) * 1.2, |before| edge_us(CUTS[before], CUTS[row])),
            ),
            error: (*error < FAILED).then_some(*error),
        })
    });
    let fine = (0..=200).map(|part| x.ends.0 * (x.ends.1 / x.ends.0).powf(f64::from(part) / 200.0));
    let bound = fine.map(|k| (k, bound_s(n, k) * 1e6)).collect();
    let shipped = vec![(x.ends.0, SHIPPED_US), (x.ends.1, SHIPPED_US)];
    let series = vec![
        Series {
            name: "theory's bound".to_owned(),
            colour: colour::VERMILLION,
            mark: Mark::Line,
            points: bound,
        },
        Series {
            name: "the scenes' step".to_owned(),
            colour: colour::SKY,
            mark: Mark::Dashes,
            points: shipped,
        },
    ];
    Panel { title, cells: cells.collect(), x, y, series, words: Vec::new() }
}
