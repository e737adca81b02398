//! The chart of `tenax chart vision` on drawn sessions: where the camera behind the skin fails, one difficulty at a time.

use anyhow::Result;
use rayon::prelude::*;
use tenax_scene::picture::Stress;
use tenax_sim::jobs::Jobs;

use super::{Chart, Progress, csv};
use crate::vision::scored::{self, Report};
use tenax_sim::plot::figure::colour;
use tenax_sim::plot::sheet::{Axis, Mark, Panel, Series, Sheet};

/// The first of the sessions, which nothing was chosen by, and how many of each difficulty are followed.
const SEED: u64 = 1101;
const SESSIONS: u64 = 6;
/// Contrast of the pattern on an object that is called plain, levels.
const PLAIN: Option<f64> = Some(4.0);

/// A difficulty: what it is called, its steps, and a session under it.
struct Difficulty {
    name: &'static str,
    axis: &'static str,
    steps: &'static [f64],
    at: fn(f64) -> Stress,
}

const DIFFICULTIES: [Difficulty; 6] = [
    Difficulty {
        name: "contrast",
        axis: "plain object: levels brighter than the wall",
        steps: &[5.0, 10.0, 20.0, 40.0, 80.0],
        at: |apart| Stress { apart: Some(apart), texture: PLAIN, ..Stress::default() },
    },
    Difficulty {
        name: "colour distance",
        axis: "plain object, as bright as the wall: levels of red less",
        steps: &[5.0, 10.0, 20.0, 40.0, 80.0],
        at: |colour| Stress { colour: Some(colour), texture: PLAIN, ..Stress::default() },
    },
    Difficulty {
        name: "texture",
        axis: "pattern on the object, levels",
        steps: &[0.0, 2.0, 5.0, 10.0, 20.0, 40.0],
        at: |texture| Stress { texture: Some(texture), ..Stress::default() },
    },
    Difficulty {
        name: "speed",
        axis: "slip, times the usual 1 to 2 px a picture",
        steps: &[0.25, 0.5, 1.0, 2.0, 3.0, 4.0],
        at: |speed| Stress { speed, ..Stress::default() },
    },
    Difficulty {
        name: "light flicker",
        axis: "light of the mains, % up and down",
        steps: &[0.0, 1.0, 2.0, 5.0, 10.0, 20.0],
        at: |percent| Stress { flicker: percent / 100.0, ..Stress::default() },
    },
    Difficulty {
        name: "markers lost",
        axis: "markers gone from the grasp on, %",
        steps: &[0.0, 20.0, 40.0, 60.0, 80.0, 100.0],
        at: |percent| Stress { markers_lost: percent / 100.0, ..Stress::default() },
    },
];

/// Shares that are drawn: name, value.
fn shares(report: &Report) -> [(&'static str, Option<f64>); 4] {
    [
        ("object seen while held", report.all.object_seen),
        ("slip: recall", report.all.recall),
        ("said to slip falsely", report.all.false_rate),
        ("seen where there is none", report.all.object_false),
    ]
}

/// Follows sessions at each step of each difficulty and draws what came of them. Fails if the chart cannot be drawn.
pub fn failures(progress: Progress) -> Result<Chart> {
    let steps: Vec<(usize, f64)> = DIFFICULTIES
        .iter()
        .enumerate()
        .flat_map(|(number, difficulty)| difficulty.steps.iter().map(move |&step| (number, step)))
        .collect();
    let jobs = Jobs::new(steps.len(), progress);
    let reports: Vec<Report> = steps
        .par_iter()
        .map(|&(number, step)| {
            let _job = jobs.begin();
            scored::score(SEED, SESSIONS, (DIFFICULTIES[number].at)(step))
        })
        .collect::<Result<_>>()?;
    let text = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.4}"));
    let rows = steps.iter().zip(&reports).map(|(&(number, step), report)| {
        let numbers = shares(report).map(|(_, value)| text(value));
        [DIFFICULTIES[number].name.to_owned(), step.to_string()].into_iter().chain(numbers).collect()
    });
    let csv = csv("difficulty,step,seen,recall,false,seen_falsely", rows)?;
    let looks = [
        (colour::BLUE, Mark::Line),
        (colour::GREEN, Mark::Dashes),
        (colour::VERMILLION, Mark::Line),
        (colour::PURPLE, Mark::Dashes),
    ];
    let panel = |(number, difficulty): (usize, &Difficulty)| {
        let own = || steps.iter().zip(&reports).filter(move |((of, _), _)| *of == number);
        let line = |share: usize| {
            let points = own().filter_map(|(&(_, step), report)| Some((step, shares(report)[share].1?)));
            let name = own().next().map_or("", |(_, report)| shares(report)[share].0);
            Series::new(name, looks[share].0, looks[share].1, points)
        };
        let (first, last) = (difficulty.steps[0], difficulty.steps[difficulty.steps.len() - 1]);
        let x = if first > 0.0 {
            Axis::log(difficulty.axis, first / 1.1, last * 1.1)
        } else {
            Axis::even(difficulty.axis, first, last)
        };
        Panel::new(
            difficulty.name,
            x,
            Axis::even("share of pictures", -0.02, 1.02),
            (0..4).map(line).collect(),
        )
    };
    let sheet = Sheet::new(
        "Where the camera behind the skin fails",
        "Drawn sessions, one difficulty at a time, six at each point; the rest as drawn",
        3,
        DIFFICULTIES.iter().enumerate().map(panel).collect(),
    );
    Chart::new("vision-failures", &sheet, csv)
}
