//! Many scenes with many seeds on the host's board, each beside its bound.

use std::str::FromStr;

use rayon::prelude::*;
use serde::Serialize;
use tenax_frames::quantile::middle;
use tenax_scene::{SceneFile, builtin};

use crate::jobs::{Jobs, Told};
use crate::report::Report;
use crate::session::{self, Board};

const OVER: f64 = 1.5;

/// Seeds: `7`, or `1..5` for 1, 2, 3, 4 and 5.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seeds(pub Vec<u64>);

impl FromStr for Seeds {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (first, last) = text.split_once("..").unwrap_or((text, text));
        let number = |text: &str| text.parse().map_err(|_| "neither N nor FIRST..LAST");
        let (first, last) = (number(first)?, number(last)?);
        if first > last { Err("the first is above the last") } else { Ok(Self((first..=last).collect())) }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Case {
    pub scene: String,
    pub seed: u64,
    pub value: Option<f64>,
}

/// Fate of the object in a run and in its bound's.
#[derive(Clone, Debug)]
struct Row {
    scene: String,
    seed: u64,
    kept: [Option<bool>; 2],
    distance_mm: Option<f64>,
    force_ratio: Option<f64>,
    distance_ratio: Option<f64>,
}

impl From<Report> for Row {
    fn from(Report { scene, seed, object, slip, bound, .. }: Report) -> Self {
        Self {
            scene,
            seed,
            kept: [object.kept, bound.kept],
            distance_mm: slip.distance_mm,
            force_ratio: bound.peak_force_ratio,
            distance_ratio: bound.distance_ratio,
        }
    }
}

#[derive(Debug, PartialEq, Serialize)]
pub struct Summary {
    pub runs: usize,
    pub lost_mm: Vec<Case>,
    /// The hand pressed more than 1.5 times as hard as the bound; and how many times, the worst first.
    pub above_1_5_times: Vec<Case>,
    pub force_ratio_median: Option<f64>,
    pub distance_ratio_median: Option<f64>,
}

impl Summary {
    /// Runs these scenes, or all for `all`, with each seed. Fails if one cannot be run.
    pub fn run(scenes: &[String], seeds: &[u64], told: Told<'_>) -> anyhow::Result<Self> {
        let all = scenes.iter().any(|scene| scene == "all");
        let names = builtin().iter().map(|(name, _)| (*name).to_owned()).filter(|_| all);
        let asked = names.chain(scenes.iter().filter(|scene| *scene != "all").cloned());
        let files: Vec<SceneFile> =
            asked.map(|scene| session::load_scene(&scene)).collect::<anyhow::Result<_>>()?;
        let runs: Vec<(&SceneFile, u64)> =
            files.iter().flat_map(|file| seeds.iter().map(move |&seed| (file, seed))).collect();
        let jobs = Jobs::new(runs.len(), told);
        let run = |&(file, seed): &(&SceneFile, u64)| -> anyhow::Result<Row> {
            let mut job = jobs.begin();
            // The search for the bound follows the run, and takes as long or longer.
            let mut progress = |s| job.at(0.3 * s / file.duration_s());
            Ok(session::scene(file, seed, &Board::Host, &mut progress)?.report.into())
        };
        // Some bounds take a hundred times as long as others: each run is any core's to take.
        let rows: Vec<Row> = runs.par_iter().with_max_len(1).map(run).collect::<anyhow::Result<_>>()?;
        Ok(Self::of(&rows))
    }

    fn of(rows: &[Row]) -> Self {
        let case = |row: &Row, value| Case { scene: row.scene.clone(), seed: row.seed, value };
        let lost = rows.iter().filter(|row| row.kept == [Some(false), Some(true)]);
        let over = rows.iter().filter(|row| row.force_ratio.is_some_and(|ratio| ratio > OVER));
        let mut over: Vec<Case> = over.map(|row| case(row, row.force_ratio)).collect();
        over.sort_by(|a, b| b.value.unwrap_or(0.0).total_cmp(&a.value.unwrap_or(0.0)));
        Self {
            runs: rows.len(),
            lost_mm: lost.map(|row| case(row, row.distance_mm)).collect(),
            above_1_5_times: over,
            force_ratio_median: middle(rows.iter().filter_map(|row| row.force_ratio)),
            distance_ratio_median: middle(rows.iter().filter_map(|row| row.distance_ratio)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_are_read_or_refused() {
        assert_eq!("7".parse(), Ok(Seeds(vec![7])));
        assert_eq!("1..3".parse(), Ok(Seeds(vec![1, 2, 3])));
        assert!(["", "3..1", "a", "1..", "-1"].iter().all(|text| text.parse::<Seeds>().is_err()));
    }

    #[test]
    fn a_summary_names_what_is_lost_and_what_is_pressed_too_hard() {
        let row = |seed, kept, bound_kept, force_ratio: Option<f64>| Row {
            scene: "a".to_owned(),
            seed,
            kept: [Some(kept), Some(bound_kept)],
            distance_mm: Some(40.0),
            force_ratio,
            distance_ratio: None,
        };
        let rows = [
            row(1, false, true, None),
            row(2, false, false, None),
            row(3, true, true, Some(1.6)),
            row(4, true, true, Some(1.5)),
            row(5, true, false, Some(1.1)),
            row(6, true, true, Some(2.0)),
        ];
        let summary = Summary::of(&rows);
        let seeds = |cases: &[Case]| cases.iter().map(|case| (case.seed, case.value)).collect::<Vec<_>>();
        assert_eq!(seeds(&summary.lost_mm), [(1, Some(40.0))]);
        assert_eq!(seeds(&summary.above_1_5_times), [(6, Some(2.0)), (3, Some(1.6))]);
        assert_eq!((summary.force_ratio_median, summary.distance_ratio_median), (Some(1.6), None));
    }
}
