//! The scenes' side of the chart.

use tenax_hal_shim::channel::{FRAME_HZ, PVDF_COUNT, SCAN_HZ, SCANS_PER_FRAME, mv_from_sample};
use tenax_hal_shim::front_end::PVDF_REST_MV;
use tenax_hal_shim::motor::MotorDrive;
use tenax_scene::plant::Plant;
use tenax_scene::{SceneFile, World, builtin};

use tenax_bench::board::simulated;

/// Gain of the films' front end in the scenes (`[pvdf] gain`).
const GAIN: f64 = 20.0;
/// Half of a recorded cut, frames: 50 ms.
const HALF_CUT: usize = FRAME_HZ as usize / 20;
/// The carriage of the scene `rig` passes the recording's mark of first motion, 2 mm/s, here, s: 40 mm/s times
/// 3 p^2 - 2 p^3 of a ramp of 230 ms from 1.496 s on.
const RIG_MOVES_S: f64 = 1.5266;

/// A line of a panel.
#[derive(Clone, Debug)]
pub struct Curve {
    pub name: String,
    /// Time, s (or frequency, Hz), and value.
    pub points: Vec<(f64, f64)>,
}

/// What camera and contact say of a pick-up.
#[derive(Clone, Debug, Default)]
pub struct PickUp {
    /// The camera's words.
    pub v1: Vec<(f64, f64)>,
    /// Part of the contact's area.
    pub stuck_part: Vec<(f64, f64)>,
}

/// Three of the twelve films when the held glass gets wet, under the fingertip: the quietest, the middle, the loudest.
/// `progress` is told the part that is done, 0 to 1.
pub fn films(progress: &mut dyn FnMut(f64)) -> anyhow::Result<Vec<Curve>> {
    let glass = text("glass")?.replace("[contact]\n", "[contact]\nlevel = \"l1\"\n");
    let glass = SceneFile::parse(&glass, "glass, l1")?;
    let mut told = |s: f64| progress(s / glass.duration_s());
    let (run, world) = simulated::run(World::new(&glass, 1), &mut told);
    let onset_s = world.truth().slips.first().map_or(0.0, |slip| slip.macro_onset_s);
    let (frames, _) = run.scans.as_chunks::<SCANS_PER_FRAME>();
    let middle = (onset_s * f64::from(FRAME_HZ)) as usize;
    let cut = &frames[middle.saturating_sub(HALF_CUT)..(middle + HALF_CUT).min(frames.len())];
    let mut films: Vec<Curve> = (0..PVDF_COUNT)
        .map(|film| {
            let mv = cut.iter().map(|scans| {
                let sum: u16 = scans.iter().map(|scan| scan[film]).sum();
                (f64::from(mv_from_sample(sum)) - f64::from(PVDF_REST_MV)) / GAIN
            });
            Curve { name: format!("film {}", film + 1), points: peak_at_zero(mv.collect()) }
        })
        .collect();
    films.sort_by(|a, b| peak(&a.points).total_cmp(&peak(&b.points)));
    Ok([0, PVDF_COUNT / 2, PVDF_COUNT - 1].map(|n| films[n].clone()).to_vec())
}

/// Values at the frame rate, their largest turned up and at time 0.
pub fn peak_at_zero(mut mv: Vec<f64>) -> Vec<(f64, f64)> {
    let peak = (0..mv.len()).max_by(|&a, &b| mv[a].abs().total_cmp(&mv[b].abs())).unwrap_or(0);
    if mv.get(peak).is_some_and(|peak| *peak < 0.0) {
        mv.iter_mut().for_each(|mv| *mv = -*mv);
    }
    let at_s = |n: usize| (n as f64 - peak as f64) / f64::from(FRAME_HZ);
    mv.into_iter().enumerate().map(|(n, mv)| (at_s(n), mv)).collect()
}

fn peak(points: &[(f64, f64)]) -> f64 {
    points.iter().map(|point| point.1).fold(0.0, f64::max)
}

/// Ft/Fn of the rig's finger.
pub fn rig() -> anyhow::Result<Vec<Curve>> {
    let mut world = World::new(&SceneFile::parse(text("rig")?, "rig")?, 1);
    let mut points = Vec::new();
    for _ in 0..2 * SCAN_HZ {
        world.scan(MotorDrive::Coast);
        let touch = world.touch();
        let t_s = world.now_s() - RIG_MOVES_S;
        if t_s > -0.02 && t_s < 0.12 {
            points.push((t_s, touch.shear_n / touch.normal_n));
        }
    }
    Ok(vec![Curve { name: "rig".to_owned(), points }])
}

/// The first of the three pick-ups, under the fingertip. `progress` is told the part that is done, 0 to 1.
pub fn pick_up(progress: &mut dyn FnMut(f64)) -> anyhow::Result<PickUp> {
    let scene = SceneFile::parse(text("pick-up")?, "pick-up")?;
    let mut told = |s: f64| progress(s / scene.duration_s());
    let (_, world) = simulated::record(World::new(&scene, 1), &mut (), &mut told);
    let truth = world.truth();
    Ok(PickUp {
        v1: truth.camera.iter().map(|seen| (seen.t_s, f64::from(seen.v1))).collect(),
        stuck_part: truth.trace.iter().map(|row| (row.t_s, row.stuck_part)).collect(),
    })
}

fn text(name: &str) -> anyhow::Result<&'static str> {
    let found = builtin().iter().find(|(builtin, _)| *builtin == name);
    found
        .map(|(_, text)| *text)
        .ok_or_else(|| anyhow::anyhow!("the scene {name} is missing from the program"))
}
