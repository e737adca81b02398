//! Many scenes with many seeds on the host's board: in shards that run anywhere and in any order, and merge to the same bytes.
//!
//! A folder holds `plan.json` (which runs, made by which program), a file of one line for each run that is done, and, once they are
//! merged, `runs.jsonl` and `summary.json`. A file is renamed to its name when it is whole, and read back before it is believed.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use crate::jobs::{Jobs, Told};
use crate::session::{self, Board};
use anyhow::{Context, bail, ensure};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};
use tenax_scene::{SceneFile, builtin};

use tenax_frames::quantile::middle;

const KEPT: [&str; 8] = ["scene", "seed", "object", "slip", "grip", "bound", "reflex", "margin"];
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

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: usize,
    of: usize,
}

impl FromStr for Shard {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (number, of) = text.split_once('/').ok_or("not N/OF")?;
        let own = number.parse().ok().zip(of.parse().ok()).map(|(number, of)| Self { number, of });
        own.filter(|own| (1..=own.of).contains(&own.number)).ok_or("not N/OF with N from 1 to OF")
    }
}

#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Plan {
    made_by: String,
    scenes: Vec<String>,
    seeds: Vec<u64>,
}

impl Plan {
    fn read(folder: &Path) -> anyhow::Result<Self> {
        let path = folder.join("plan.json");
        let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        serde_json::from_str(&text).with_context(|| format!("{} is no plan of a sweep", path.display()))
    }

    fn runs(&self) -> Vec<(&str, u64)> {
        self.scenes
            .iter()
            .flat_map(|scene| self.seeds.iter().map(move |&seed| (scene.as_str(), seed)))
            .collect()
    }
}

fn file_of(folder: &Path, (scene, seed): (&str, u64)) -> PathBuf {
    folder.join(format!("{scene}.{seed}.json"))
}

/// Written aside and renamed, so that a reader finds all of it or nothing.
fn write(path: &Path, text: &str) -> anyhow::Result<()> {
    let part = path.with_extension("part");
    let written = fs::write(&part, text).and_then(|()| fs::rename(&part, path));
    written.with_context(|| format!("cannot write {}", path.display()))
}

fn whole(folder: &Path, run: (&str, u64)) -> Option<(String, Value)> {
    let line = fs::read_to_string(file_of(folder, run)).ok().filter(|line| line.ends_with("}\n"))?;
    let row: Value = serde_json::from_str(&line).ok()?;
    (row["scene"] == run.0 && row["seed"] == run.1).then_some((line, row))
}

/// Runs what a shard has to run and is not done yet. Returns how many runs these were.
/// Fails if the folder is another sweep's, or a run fails; what was done by then stays.
pub fn run(
    scenes: &[String],
    seeds: &[u64],
    shard: Option<Shard>,
    folder: &Path,
    told: Told<'_>,
) -> anyhow::Result<usize> {
    let all = scenes.iter().any(|scene| scene == "all");
    let names = builtin().iter().map(|(name, _)| (*name).to_owned()).filter(|_| all);
    let asked = names.chain(scenes.iter().filter(|scene| *scene != "all").cloned());
    let files: Vec<SceneFile> =
        asked.map(|scene| session::load_scene(&scene)).collect::<anyhow::Result<_>>()?;
    let mut made_by = Sha256::new_with_prefix(fs::read(std::env::current_exe()?)?);
    made_by.update(format!("{files:?}"));
    let plan = Plan {
        made_by: made_by.finalize().iter().map(|byte| format!("{byte:02x}")).collect(),
        scenes: files.iter().map(|file| file.name.clone()).collect(),
        seeds: seeds.to_vec(),
    };
    let runs = plan.runs();
    ensure!(runs.iter().collect::<BTreeSet<_>>().len() == runs.len(), "a scene or a seed is asked for twice");
    if let Ok(there) = Plan::read(folder) {
        ensure!(
            there == plan,
            "{} holds another sweep, or another build's: choose another folder",
            folder.display()
        );
    }
    write(&folder.join("plan.json"), &serde_json::to_string_pretty(&plan)?)?;
    let Shard { number, of } = shard.unwrap_or(Shard { number: 1, of: 1 });
    let own = (number - 1..runs.len()).step_by(of);
    let missing: Vec<usize> = own.filter(|&n| whole(folder, runs[n]).is_none()).collect();
    let jobs = Jobs::new(missing.len(), told);
    // Some bounds take a hundred times as long as others: each run is any core's to take.
    missing.par_iter().with_max_len(1).try_for_each(|&n| {
        let (_, seed) = runs[n];
        let file = &files[n / seeds.len()];
        let mut job = jobs.begin();
        // The search for the bound follows the run, and takes as long or longer.
        let outcome = session::scene(file, seed, &Board::Host, &mut |s| job.at(0.3 * s / file.duration_s()))?;
        let Value::Object(mut report) = serde_json::to_value(&outcome.report)? else {
            bail!("a report is no object")
        };
        let row: Map<String, Value> = KEPT.iter().filter_map(|key| report.remove_entry(*key)).collect();
        write(&file_of(folder, runs[n]), &format!("{}\n", serde_json::to_string(&row)?))
    })?;
    Ok(missing.len())
}

/// Puts the shards of these folders together in the first: every run's line in `runs.jsonl`, and their summary.
/// Fails if the folders' plans differ, or a run is missing.
pub fn merge(folders: &[PathBuf]) -> anyhow::Result<Summary> {
    let [first, others @ ..] = folders else { bail!("no folder to merge") };
    let plan = Plan::read(first)?;
    for other in others {
        ensure!(
            Plan::read(other)? == plan,
            "{} and {} hold different sweeps",
            first.display(),
            other.display()
        );
    }
    let (mut lines, mut rows, mut missing) = (String::new(), Vec::new(), Vec::new());
    for run in plan.runs() {
        match folders.iter().find_map(|folder| whole(folder, run)) {
            Some((line, row)) => {
                lines += &line;
                rows.push(row);
            }
            None => missing.push(format!("{} {}", run.0, run.1)),
        }
    }
    ensure!(
        missing.is_empty(),
        "{} of {} runs are missing: {}",
        missing.len(),
        plan.runs().len(),
        missing.join(", ")
    );
    let summary = Summary::of(&rows);
    write(&first.join("runs.jsonl"), &lines)?;
    write(&first.join("summary.json"), &serde_json::to_string_pretty(&summary)?)?;
    Ok(summary)
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Case {
    pub scene: String,
    pub seed: u64,
    pub value: Option<f64>,
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
    fn of(rows: &[Value]) -> Self {
        let force = |row: &Value| row["bound"]["peak_force_ratio"].as_f64();
        let case = |row: &Value, value| Case {
            scene: row["scene"].as_str().unwrap_or_default().to_owned(),
            seed: row["seed"].as_u64().unwrap_or_default(),
            value,
        };
        let lost = rows.iter().filter(|row| row["bound"]["kept"] == true && row["object"]["kept"] == false);
        let over = rows.iter().filter(|row| force(row).is_some_and(|ratio| ratio > OVER));
        let mut over: Vec<Case> = over.map(|row| case(row, force(row))).collect();
        over.sort_by(|a, b| b.value.unwrap_or(0.0).total_cmp(&a.value.unwrap_or(0.0)));
        let distance = |row: &Value| row["bound"]["distance_ratio"].as_f64();
        Self {
            runs: rows.len(),
            lost_mm: lost.map(|row| case(row, row["slip"]["distance_mm"].as_f64())).collect(),
            above_1_5_times: over,
            force_ratio_median: middle(rows.iter().filter_map(force)),
            distance_ratio_median: middle(rows.iter().filter_map(distance)),
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn seeds_and_shards_are_read_or_refused() {
        assert_eq!("7".parse(), Ok(Seeds(vec![7])));
        assert_eq!("1..3".parse(), Ok(Seeds(vec![1, 2, 3])));
        assert_eq!("3/16".parse(), Ok(Shard { number: 3, of: 16 }));
        assert!(["", "3..1", "a", "1..", "-1"].iter().all(|text| text.parse::<Seeds>().is_err()));
        assert!(["", "3", "0/4", "5/4", "1/0", "a/b"].iter().all(|text| text.parse::<Shard>().is_err()));
    }

    #[test]
    fn a_summary_names_what_is_lost_and_what_is_pressed_too_hard() {
        let row = |seed, kept, bound_kept, ratio: Option<f64>| {
            json!({ "scene": "a", "seed": seed, "object": { "kept": kept }, "slip": { "distance_mm": 40.0 },
                "bound": { "kept": bound_kept, "peak_force_ratio": ratio } })
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
