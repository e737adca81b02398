//! What stands beside a scene's run: its bound, and its controls. Always on the host.

use rayon::prelude::*;
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_scene::bound::Plan;
use tenax_scene::{SceneFile, World};

use super::witness::Drawn;
use crate::board::simulated::{self, Choose, Grips, frames_in, seconds_of};
use crate::report::bound::{Control, SAME_MM};
use crate::report::fate::Fate;

const WITHIN: f64 = 0.01;

pub fn gripped(file: &SceneFile, seed: u64, grips: Grips) -> Fate {
    fate(file, World::new(file, seed), grips)
}

/// In the grip of somebody else, beside a hand without a reflex.
pub fn chosen(file: &SceneFile, seed: u64, choose: &mut Choose<'_>) -> Fate {
    let plant = simulated::run_chosen(drawn(file, World::new(file, seed)), choose);
    Fate::of(plant.world.truth(), file)
}

fn fate(file: &SceneFile, world: World, grips: Grips) -> Fate {
    let (_kept_by_the_plant, plant) = simulated::record(drawn(file, world), grips, &mut (), &mut |_| {});
    Fate::of(plant.world.truth(), file)
}

fn drawn(file: &SceneFile, world: World) -> Drawn {
    let span_s = (0.0, seconds_of(frames_in(file.duration_s())));
    Drawn::new(world, span_s)
}

/// The bound of a scene beside `run`. It plans the least force from which nothing slides. Beside a run that kept the object with
/// less, it plans the least force that lets it slide no further than it did there; where the object had turned and so needed less
/// than any plan can know ahead, it is what the object needed as it hung in that run.
pub fn bound(file: &SceneFile, seed: u64, run: &Fate) -> Fate {
    let plan = Plan::of(file);
    let planned = |most_n| {
        let plan = plan.clone().map(|plan| plan.at_most(most_n));
        fate(file, World::new(file, seed).planning(plan), Grips::Bound)
    };
    let holds = planned(f64::INFINITY);
    let (Some(run_n), Some(holds_n)) = (run.peak_grip_n, holds.peak_grip_n) else { return holds };
    if !run.kept() || run_n >= holds_n {
        return holds;
    }
    let as_good = |own: &Fate| own.kept() && own.distance_mm <= run.distance_mm + SAME_MM;
    let mut best = planned(run_n);
    if !as_good(&best) {
        return Fate {
            peak_grip_n: run.needed_force_n.filter(|_| run.turned_rad != 0.0).or(Some(holds_n)),
            ..holds
        };
    }
    // Where the scene's own grip is enough, no plan is the least, and the search below would not end.
    let unplanned = planned(0.0);
    if as_good(&unplanned) {
        return unplanned;
    }
    let (mut least_n, mut most_n) = (0.0, run_n);
    while most_n - least_n > WITHIN * most_n {
        let half_n = 0.5 * (least_n + most_n);
        let own = planned(half_n);
        if as_good(&own) {
            (best, most_n) = (own, half_n);
        } else {
            least_n = half_n;
        }
    }
    best
}

/// A causal oracle in the hand's place: [`tenax_scene::World::with_oracle`].
pub fn oracle(file: &SceneFile, seed: u64) -> Fate {
    fate(file, World::new(file, seed).with_oracle(), Grips::Bound)
}

pub fn runs(file: &SceneFile, seed: u64, truth: &Fate) -> Vec<(String, Fate)> {
    let each = || {
        DetectorId::ALL.into_iter().filter(|&id| match id {
            DetectorId::Injected => false,
            DetectorId::Photoelastic => file.fits_head(),
            _ => true,
        })
    };
    let mut all = vec![("no reflex".to_owned(), Grips::Reflex(DetectorSet::NONE))];
    all.extend(truth.mean_grip_n.map(|grip_n| ("constant grip".to_owned(), Grips::Constant(grip_n))));
    all.extend(each().map(|id| (format!("{} alone", id.name()), Grips::Reflex(DetectorSet::only(id)))));
    all.extend(
        each().map(|id| (format!("without {}", id.name()), Grips::Reflex(DetectorSet::ALL.with(id, false)))),
    );
    all.into_par_iter().map(|(name, grips)| (name, gripped(file, seed, grips))).collect()
}

pub fn controls(file: &SceneFile, seed: u64, truth: &Fate) -> Vec<Control> {
    runs(file, seed, truth).iter().map(|(name, fate)| Control::of(name, fate)).collect()
}
