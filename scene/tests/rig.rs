//! The friction model against a real finger on a friction rig: the rise, the peak and the fall of Ft/Fn.
//!
//! The figures are measured from the project's evaluation recording `friction_rig_10khz.csv` (GitHub
//! data-driven-playback-of-natural-tactile-texture, 10 kHz, 0.5 N, plate driven off to 40 mm/s) by the
//! definitions below. None of its samples is here; where the recording is at hand, it is measured once more.

use std::path::Path;

use crate::common::{Reflex, parsed, run, scene, truth};

const MOVES_MM_S: f64 = 2.0;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Onset {
    peak: f64,
    rise_s: f64,
    passes_s: [f64; 3],
    /// From the peak to the mean over 31 to 71 ms after it.
    drop: f64,
}

/// The recording's, by [`onset`].
const RECORDED: Onset =
    Onset { peak: 0.690, rise_s: 0.0420, passes_s: [0.0236, 0.0169, 0.0122], drop: 0.2276 };

fn onset(rows: &[(f64, f64, f64, f64)]) -> Onset {
    let moves = rows.iter().position(|row| row.0 > 1.0 && row.1 >= MOVES_MM_S).expect("it moves");
    let moves_s = rows[moves].0;
    let soon: Vec<(f64, f64)> = rows[moves..]
        .iter()
        .take_while(|row| row.0 < moves_s + 0.15)
        .map(|row| (row.0, row.2 / row.3))
        .collect();
    let &(peak_s, peak) = soon.iter().max_by(|a, b| a.1.total_cmp(&b.1)).expect("150 ms of rows");
    let passes = |level: f64| peak_s - soon.iter().find(|row| row.1 > level).map_or(f64::NAN, |row| row.0);
    let later: Vec<f64> =
        soon.iter().filter(|row| (0.031..0.071).contains(&(row.0 - peak_s))).map(|row| row.1).collect();
    let sliding = later.iter().sum::<f64>() / later.len() as f64;
    Onset { peak, rise_s: peak_s - moves_s, passes_s: [0.3, 0.5, 0.6].map(passes), drop: peak - sliding }
}

fn within(value: f64, figure: f64, part: f64) -> bool {
    (value / figure - 1.0).abs() <= part
}

/// The model beside an onset that was recorded.
fn assert_reproduced(recorded: &Onset) {
    let mut rows = Vec::new();
    run(&scene("rig"), Reflex::None, |world, _| {
        let touch = world.touch();
        let p = ((world.now_s() - 1.496) / 0.230).clamp(0.0, 1.0);
        rows.push((world.now_s(), 40.0 * p * p * (3.0 - 2.0 * p), touch.shear_n, touch.normal_n));
    });
    let modelled = onset(&rows);
    println!("recorded {recorded:?}\nmodelled {modelled:?}");
    assert!(within(modelled.peak, recorded.peak, 0.05) && within(modelled.rise_s, recorded.rise_s, 0.20));
    assert!(within(modelled.drop, recorded.drop, 0.10));
}

#[test]
fn the_rig_s_onset_is_reproduced() {
    assert_reproduced(&RECORDED);
}

#[test]
fn rigid_friction_gets_the_rise_wrong() {
    // The same scene at L0: the arm is nearly rigid, so the ratio is at its peak as soon as the plate moves.
    let (_, text) = tenax_scene::builtin().iter().find(|(name, _)| *name == "rig").unwrap();
    let lines = text.lines().filter(|line| !line.starts_with("skin_"));
    let lines = lines.map(|line| if line.starts_with("level") { "level = \"l0\"" } else { line });
    let rigid = parsed(&lines.collect::<Vec<_>>().join("\n"));
    let [first, second] = [rigid, scene("rig")].map(|scene| truth(&scene, Reflex::None).slips[0]);
    assert_eq!(first.micro_onset_s, first.macro_onset_s);
    assert!(second.macro_onset_s - first.macro_onset_s > 0.02, "{first:?}, {second:?}");
    assert!(second.macro_onset_s - second.micro_onset_s > 0.02, "{second:?}");
}

#[test]
#[cfg_attr(not(recordings), ignore = "no recordings in ../shared/data")]
fn the_figures_are_the_recording_s() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/friction_rig_10khz.csv");
    let text = std::fs::read_to_string(&file).expect("the recording");
    let rows: Vec<(f64, f64, f64, f64)> = text
        .lines()
        .skip(1)
        .map(|line| {
            let n: Vec<f64> = line.split(',').map(|n| n.parse().expect("a number")).collect();
            (n[0], n[3], n[1], n[2])
        })
        .collect();
    let recorded = onset(&rows);
    assert!(within(recorded.peak, RECORDED.peak, 1e-3) && within(recorded.rise_s, RECORDED.rise_s, 5e-3));
    assert!(within(recorded.drop, RECORDED.drop, 5e-3), "{recorded:?}");
    for (now, then) in recorded.passes_s.into_iter().zip(RECORDED.passes_s) {
        assert!((now - then).abs() < 2e-4, "{recorded:?}");
    }
    assert_reproduced(&recorded);
}
