//! The region of self-excited vibration, by theory and by measurement, and that of reported slip.

use tenax_scene::physics::stribeck::{BLOCK_N, METAL, Slider, Stribeck};
use tenax_scene::sensor::photoelastic::HEAD_STRIP;
use tenax_scene::stepping::growth_per_s;

use super::rate::{Material, Rig, rig_of};

/// The load: the weight of the aluminium block, N.
pub const LOAD_N: f64 = BLOCK_N;
const DROPS: [f64; 9] = [0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.07, 0.1];
/// Slip rates of the map, mm/s.
const RATES_MM_S: [f64; 11] = [0.05, 0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.5, 4.0, 6.0, 9.0];
/// Slip rates at which the floor is looked for, mm/s, falling.
const FLOORS_MM_S: [f64; 9] = [0.3, 0.2, 0.15, 0.1, 0.07, 0.05, 0.03, 0.02, 0.01];
/// Slip counts as seen if it is said in this part of the time.
const SEEN: f64 = 0.95;

/// The strip under a friction that falls by this much.
fn slider(drop: f64) -> Slider {
    Slider { friction: Stribeck { mu_s: METAL.mu_d + drop, ..METAL }, ..HEAD_STRIP }
}

/// The steepest fall of this friction, dmu/dv at rest, s/m.
pub fn steepness_s_m(drop: f64) -> f64 {
    -slider(drop).friction.slope_s_m(0.0)
}

/// The speed at which `c + P dmu/dv = 0`, mm/s; None if the fall is nowhere steep enough.
pub fn theory_mm_s(drop: f64) -> Option<f64> {
    let steepest = LOAD_N * steepness_s_m(drop);
    (steepest > HEAD_STRIP.damping_ns_per_m)
        .then(|| 1e3 * METAL.speed_m_s * (steepest / HEAD_STRIP.damping_ns_per_m).ln())
}

/// Whether a small vibration about even sliding grows.
fn grows(drop: f64, rate_mm_s: f64) -> bool {
    // What does not swing near the boundary creeps back.
    growth_per_s(slider(drop), LOAD_N, rate_mm_s / 1e3).is_some_and(|growth_per_s| growth_per_s > 0.0)
}

/// The speed below which it vibrates by itself as the scene's strip does, mm/s, by halving.
pub fn measured_mm_s(drop: f64) -> Option<f64> {
    let theory_mm_s = theory_mm_s(drop)?;
    let (mut low, mut high) = (0.5 * theory_mm_s, 2.0 * theory_mm_s);
    if !grows(drop, low) || grows(drop, high) {
        return None;
    }
    for _ in 0..20 {
        let middle = (low + high) / 2.0;
        if grows(drop, middle) { low = middle } else { high = middle }
    }
    Some((low + high) / 2.0)
}

#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Slip rate, mm/s.
    pub rate_mm_s: f64,
    /// Fall of friction at rest, s/m.
    pub steepness_s_m: f64,
    /// Whether the head says slip.
    pub seen: bool,
}

#[derive(Clone, Debug)]
pub struct Region {
    /// Steepness, and the boundary's speed by theory and as measured, mm/s.
    pub boundary: Vec<(f64, f64, f64)>,
    /// The largest difference of the two, %; infinite if it vibrates on the wrong side.
    pub boundary_pct: f64,
    pub points: Vec<Point>,
}

pub fn region(progress: &mut dyn FnMut(f64)) -> Region {
    let mut boundary_pct = 0.0_f64;
    let mut boundary = Vec::new();
    for drop in DROPS {
        match (theory_mm_s(drop), measured_mm_s(drop)) {
            (Some(theory), Some(measured)) => {
                boundary_pct = boundary_pct.max((measured / theory - 1.0).abs() * 100.0);
                boundary.push((steepness_s_m(drop), theory, measured));
            }
            (Some(_), None) => boundary_pct = f64::INFINITY,
            (None, _) => {
                if RATES_MM_S.iter().any(|rate| grows(drop, *rate)) {
                    boundary_pct = f64::INFINITY;
                }
            }
        }
    }
    let mut points = Vec::new();
    for (n, drop) in DROPS.into_iter().enumerate() {
        for rate_mm_s in RATES_MM_S {
            let seen = Rig::mean(slider(drop), 7).slide(LOAD_N, rate_mm_s, 0.8 + 0.06 / rate_mm_s);
            points.push(Point { rate_mm_s, steepness_s_m: steepness_s_m(drop), seen: seen.said > SEEN });
        }
        progress((n + 1) as f64 / DROPS.len() as f64);
    }
    Region { boundary, boundary_pct, points }
}

/// The slowest slip of aluminium, mm/s, that is seen on every head of these seeds, and so is every faster one of the list.
pub fn floor_mm_s(seeds: impl IntoIterator<Item = u64>) -> f64 {
    let mut worst = 0.0_f64;
    for seed in seeds {
        let seen = |rate_mm_s: &&f64| {
            let mut rig = rig_of(seed, seed, Material::Aluminium);
            rig.slide(LOAD_N, **rate_mm_s, 0.8 + 0.06 / **rate_mm_s).said > SEEN
        };
        let floor = FLOORS_MM_S.iter().take_while(seen).last();
        worst = worst.max(floor.copied().unwrap_or(f64::INFINITY));
    }
    worst
}
