//! What a recording itself tells of what was recorded, to hold a replay's detections against.

use serde::Serialize;
use tenax_frames::quantile::middle;
use tenax_logic::config::Config;

use super::filter::{Pass, pass};
use super::resample::Grid;
use super::{Recipe, Recording};

const CREST_FALL: f64 = 0.2;
const CREST_LEAST: f64 = 0.2;
/// The part of the recording's 95th percentile of normal force above which the finger counts as loaded.
const LOADED_PART: f64 = 0.5;
/// Length of the mean that takes the load cell's noise away, s.
const FORCE_MEAN_S: f64 = 0.001;
/// Length of the centred mean that stands for a muscle's activity, s.
const MUSCLE_MEAN_S: f64 = 0.05;

/// No finger's friction is greater: dry skin at small loads has 2 to 3 (Derler and Gerhardt, Tribology Letters 45, 2012).
const RATIO_MOST: f64 = 3.0;
/// Normal forces that a finger may have, N: from a touch to the end of a motor of 140 N.
const NORMAL_N: [f64; 2] = [0.05, 140.0];

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Crest {
    pub peak_ratio: f64,
    pub peak_s: f64,
}

struct Rows {
    normal: Vec<f64>,
    shear: Vec<f64>,
    /// The normal force above which the finger is loaded, and its 95th percentile.
    loaded_n: f64,
    high_n: f64,
}

/// What the recipe presses the force sensor with, before its scale. None if it does not.
fn forces(recording: &Recording, recipe: &Recipe) -> anyhow::Result<Option<Rows>> {
    let Some(force) = &recipe.force else {
        return Ok(None);
    };
    let width = (FORCE_MEAN_S * recording.rate_hz()).clamp(1.0, 1e4) as usize;
    let normal = centred_mean(&recording.series(&force.normal)?, width);
    let x = centred_mean(&recording.series(&force.shear_x)?, width);
    let y = match &force.shear_y {
        Some(column) => centred_mean(&recording.series(column)?, width),
        None => vec![0.0; x.len()],
    };
    let sign = force.scale.get_ref().signum();
    let normal: Vec<f64> = normal.iter().map(|n| n * sign).collect();
    let mut sorted = normal.clone();
    sorted.sort_by(f64::total_cmp);
    let high_n = sorted[sorted.len() * 95 / 100];
    let shear = x.iter().zip(&y).map(|(x, y)| x.hypot(*y)).collect();
    Ok(Some(Rows { normal, shear, loaded_n: LOADED_PART * high_n, high_n }))
}

pub fn doubts(recording: &Recording, recipe: &Recipe) -> anyhow::Result<Vec<String>> {
    let (Some(rows), Some(map)) = (forces(recording, recipe)?, &recipe.force) else {
        return Ok(Vec::new());
    };
    let mut doubts = Vec::new();
    let high_n = rows.high_n * map.scale.get_ref().abs();
    let [least_n, most_n] = NORMAL_N;
    if !(least_n..=most_n).contains(&high_n) {
        doubts.push(format!(
            "`{}` is {high_n:.3} N at its 95th percentile, a finger's is {least_n} to {most_n} N: is it a normal force, and in newtons \
             (scale)?",
            map.normal
        ));
    }
    let loaded = rows.normal.iter().zip(&rows.shear).filter(|&(&normal, _)| normal > rows.loaded_n.max(0.0));
    if let Some(ratio) =
        middle(loaded.map(|(normal, shear)| shear / normal)).filter(|&ratio| ratio > RATIO_MOST)
    {
        doubts.push(format!(
            "`{}` is {ratio:.1} times `{}` while the finger is loaded (median), more than any friction holds: is it a shear in the same \
             unit, without an offset?",
            map.shear_x, map.normal
        ));
    }
    Ok(doubts)
}

/// The first crest of Ft/Fn, climbed to while the finger is loaded, then fallen from by a fifth. None if there is none, or no force.
pub fn crest(recording: &Recording, recipe: &Recipe) -> anyhow::Result<Option<Crest>> {
    let Some(rows) = forces(recording, recipe)? else {
        return Ok(None);
    };
    let mut best: Option<Crest> = None;
    for (index, &t) in recording.t_s().iter().enumerate() {
        let normal = rows.normal[index];
        if normal <= rows.loaded_n {
            best = None;
            continue;
        }
        let ratio = rows.shear[index] / normal;
        match best {
            Some(crest)
                if ratio < crest.peak_ratio * (1.0 - CREST_FALL) && crest.peak_ratio >= CREST_LEAST =>
            {
                return Ok(best);
            }
            Some(crest) if ratio <= crest.peak_ratio => {}
            _ => {
                best = Some(Crest { peak_ratio: ratio, peak_s: t });
            }
        }
    }
    Ok(None)
}

/// When a muscle first became active in the recording itself, s: the 50 ms centred mean of the rectified signal, at the recipe's gain,
/// passes the gate's threshold. None if it never does, or no column reaches a myosensor.
pub fn muscle_onset_s(recording: &Recording, recipe: &Recipe) -> anyhow::Result<Option<f64>> {
    let mut first: Option<f64> = None;
    for map in recipe.map.iter().filter(|map| map.is_muscle()) {
        let grid = Grid::new(recording.rate_hz(), recording.first_s(), recording.duration_s(), 0.0, 0.0);
        let mut rows = recording.series(&map.column)?;
        let mean = rows.iter().sum::<f64>() / rows.len() as f64;
        rows.iter_mut().for_each(|value| *value -= mean);
        let mut drawn = grid.draw(recording.t_s(), &rows);
        if let Some(corner) = &map.high_pass_hz {
            pass(Pass::High, *corner.get_ref(), grid.rate_hz(), &mut drawn);
        }
        drawn.iter_mut().for_each(|value| *value = (*value * map.gain.get_ref()).abs());
        let width = (MUSCLE_MEAN_S * grid.rate_hz()) as usize;
        let on_v = f64::from(Config::default().gate.on_mv) / 1e3;
        let onset = centred_mean(&drawn, width).iter().position(|&volts| volts >= on_v);
        let onset_s = onset.map(|n| recording.first_s() + n as f64 / grid.rate_hz());
        first = match (first, onset_s) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
    }
    Ok(first)
}

fn centred_mean(values: &[f64], width: usize) -> Vec<f64> {
    let mut sums = Vec::with_capacity(values.len() + 1);
    let mut sum = 0.0;
    sums.push(sum);
    for value in values {
        sum += value;
        sums.push(sum);
    }
    let half = width / 2;
    (0..values.len())
        .map(|n| {
            let (from, to) = (n.saturating_sub(half), (n + half + 1).min(values.len()));
            (sums[to] - sums[from]) / (to - from) as f64
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rig(ratio_of: impl Fn(f64) -> f64) -> (Recording, Recipe) {
        let mut csv = String::from("t,n,s\n");
        for row in 0..2_000 {
            let t = f64::from(row) / 1_000.0;
            let normal = if (0.2..1.8).contains(&t) { 0.5 } else { 0.01 };
            csv += &format!("{t},{normal},{}\n", ratio_of(t) * normal);
        }
        let recipe = "title = ''\ndescription = ''\n[force]\nnormal = 'n'\nshear_x = 's'\n";
        (Recording::parse(csv.as_bytes(), "rig.csv").unwrap(), Recipe::parse(recipe, "rig.toml").unwrap())
    }

    #[test]
    fn the_crest_is_where_sticking_ends() {
        // Unloaded, the ratio is huge; loaded, it climbs to 0.6 at 1 s, falls to 0.4 and climbs to 0.9 when unloading.
        let (recording, recipe) = rig(|t| match t {
            t if !(0.2..1.8).contains(&t) => 5.0,
            t if t < 1.0 => 0.6 * t,
            t if t < 1.5 => 0.4,
            _ => 0.9,
        });
        let found = crest(&recording, &recipe).unwrap().expect("there is one");
        assert!((found.peak_s - 0.999).abs() < 0.002 && (found.peak_ratio - 0.6).abs() < 0.01, "{found:?}");
        // A finger that never slides.
        let (recording, recipe) = rig(|t| 0.1 + 0.05 * (40.0 * t).sin());
        assert_eq!(crest(&recording, &recipe).unwrap(), None);
    }

    #[test]
    fn columns_that_are_no_forces_are_doubted() {
        let doubts = |ratio: f64| {
            let (recording, recipe) = rig(|_| ratio);
            doubts(&recording, &recipe).unwrap()
        };
        assert_eq!((doubts(0.5), doubts(2.9)), (vec![], vec![]));
        assert!(doubts(42.0)[0].starts_with("`s` is 42.0 times `n`"), "{:?}", doubts(42.0));
        let csv = "t,n,s\n0,2500,300\n1,2500,300\n2,2500,300\n";
        let recipe = "title = ''\ndescription = ''\n[force]\nnormal = 'n'\nshear_x = 's'\n";
        let told = |scale: &str| {
            let recipe = Recipe::parse(&format!("{recipe}{scale}"), "r.toml").unwrap();
            super::doubts(&Recording::parse(csv.as_bytes(), "r.csv").unwrap(), &recipe).unwrap()
        };
        assert!(told("")[0].contains("2500.000 N"), "{:?}", told(""));
        assert_eq!(told("scale = 0.001"), Vec::<String>::new());
    }
}
