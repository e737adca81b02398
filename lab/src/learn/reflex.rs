//! Benefit of the network to the hand (Tada 2006, section III-D): a lift that the reflex secures and a cup that it keeps,
//! told by the network, by the camera, and by the bound.

use rayon::prelude::*;
use tenax_scene::bound::Plan;
use tenax_scene::{Seeds, Truth, World};

use super::bench::{Bench, Judge};
use super::finger::{Change, Finger};

pub const JUDGES: [Judge; 3] = [Judge::Touch, Judge::Vision, Judge::Bound];

/// When the lift begins, s, without what chance adds.
const LIFT_S: f64 = 1.2;
/// Largest random delay, s: three of the camera's images.
const LATER_S: f64 = 0.1;
/// When the pour begins, s.
const POUR_S: f64 = 4.0;
/// Speed along the hand below which the object is secured, mm/s: the scenes' floor of slip.
const FLOOR_MM_S: f64 = 1.0;

#[derive(Clone, Copy, Debug)]
pub struct Reflexed {
    /// When the object last moved along the hand, s from the beginning of the lift or of the pour.
    pub secured_s: f64,
    /// Sunk in the end, mm, with the skin's give under the load.
    pub distance_mm: f64,
}

/// One of each judge, with the same chance.
pub type Three = [Reflexed; 3];

/// So many lifts. Fails if a scene cannot be made.
pub fn lifts(finger: &Finger, learned: &Bench, count: u64, seed: u64) -> anyhow::Result<Vec<Three>> {
    (0..count)
        .into_par_iter()
        .map(|n| {
            let lift_s = LIFT_S + LATER_S * n as f64 / count as f64;
            let grip = ("command.grip.for_s", (2.0 + 2.7 * finger.force()) / 12.0);
            three("pick-up-reflex", finger, learned, seed + n, &[("move.0.at_s", lift_s), grip], lift_s)
        })
        .collect()
}

/// So many pours. Fails if a scene cannot be made.
pub fn pours(finger: &Finger, learned: &Bench, count: u64, seed: u64) -> anyhow::Result<Vec<Three>> {
    (0..count)
        .into_par_iter()
        .map(|n| {
            let pour_s = POUR_S + LATER_S * n as f64 / count as f64;
            let force = finger.force();
            let changes = [
                ("fill.0.at_s", pour_s),
                ("fill.0.add_kg", 0.25 * finger.mass_kg() / 0.2),
                ("command.grip.for_s", (2.0 + 7.3 * force) / 12.0),
            ];
            three("pour", finger, learned, seed + n, &changes, pour_s)
        })
        .collect()
}

fn three(
    scene: &str,
    finger: &Finger,
    learned: &Bench,
    seed: u64,
    changes: &[Change],
    from_s: f64,
) -> anyhow::Result<Three> {
    let scene = finger.scene(scene, seed, changes, |_| ())?;
    let run = |judge| {
        let world = World::seeded(&scene, Seeds { making: finger.making, noise: seed });
        let world = if judge == Judge::Bound { world.planning(Plan::of(&scene)) } else { world };
        reflexed(&learned.clone().run(world, judge).truth, from_s)
    };
    Ok(JUDGES.map(run))
}

fn reflexed(truth: &Truth, from_s: f64) -> Reflexed {
    let mut reflexed = Reflexed { secured_s: 0.0, distance_mm: 0.0 };
    let mut last_s = from_s;
    for row in truth.trace.iter().filter(|row| row.t_s >= from_s) {
        reflexed.distance_mm += row.slide_mm_s * (row.t_s - last_s);
        last_s = row.t_s;
        if row.slide_mm_s.abs() > FLOOR_MM_S {
            reflexed.secured_s = row.t_s - from_s;
        }
    }
    reflexed
}
