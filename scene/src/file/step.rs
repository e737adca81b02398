//! Check that the step of one scan fits twice into each bound (`docs/stepping.md`).

use super::SceneFile;
use super::check::{Checked, demand};
use super::sections::{Object, Robot};
use crate::bounds;
use crate::schedule::STEP_S;

/// The step must go into each bound at least so often.
const MARGIN: f64 = 2.0;

pub(super) fn step(scene: &SceneFile) -> Checked {
    if let Some(object) = &scene.object {
        let mat =
            "the object on the table's mat needs more mass_kg, less poured out, or a softer mat_n_per_mm";
        demand(fits(mat_s(scene, object.get_ref())), object.span(), || {
            refusal(mat, mat_s(scene, object.get_ref()))
        })?;
        let grip = "the gripper on the object needs a smaller stiffness_n_per_mm, a lower speed_mm_s, or more force_n";
        let bound_s = gripper_s(scene, object.get_ref());
        demand(fits(bound_s), object.span(), || refusal(grip, bound_s))?;
    }
    if let Some(robot) = &scene.robot {
        let arm = "the probe on the arm needs more probe_kg, or a smaller stiffness_n_per_mm";
        demand(fits(arm_s(robot.get_ref())), robot.span(), || refusal(arm, arm_s(robot.get_ref())))?;
    }
    Ok(())
}

fn fits(bound_s: f64) -> bool {
    STEP_S * MARGIN <= bound_s
}

fn refusal(what: &str, bound_s: f64) -> String {
    let (bound_us, step_us) = (bound_s * 1e6, STEP_S * 1e6);
    format!(
        "{what}: it can be stepped by {bound_us:.0} us at most, and the step of {step_us} us must fit {MARGIN} times"
    )
}

/// The longest stable step of the object on the mat, whose damping is that under the empty object, s.
fn mat_s(scene: &SceneFile, object: &Object) -> f64 {
    let empty_kg = object.mass_kg.get();
    let poured = scene.fill.iter().scan(empty_kg, |mass_kg, fill| {
        *mass_kg += fill.add_kg.get_ref().get();
        Some(*mass_kg)
    });
    let lightest_kg = poured.fold(empty_kg, f64::min);
    let mat_n_per_m = scene.table.mat_n_per_mm.get() * 1e3;
    let mat_ns_per_m = 2.0 * scene.table.damping.get() * (mat_n_per_m * empty_kg).sqrt();
    bounds::semi_implicit_oscillator_s(lightest_kg, mat_n_per_m, mat_ns_per_m)
}

fn gripper_s(scene: &SceneFile, object: &Object) -> f64 {
    let stiffness_n_per_m = object.stiffness_n_per_mm.get() * 1e3;
    bounds::gripper_s(scene.gripper.force_n.get(), stiffness_n_per_m, scene.gripper.speed_mm_s.get() / 1e3)
}

/// The longest stable step of the probe on the arm, s.
fn arm_s(robot: &Robot) -> f64 {
    let (mass_kg, stiffness_n_per_m) = (robot.probe_kg.get(), robot.stiffness_n_per_mm.get() * 1e3);
    let damping_ns_per_m = 2.0 * robot.damping.get() * (stiffness_n_per_m * mass_kg).sqrt();
    bounds::semi_implicit_oscillator_s(mass_kg, stiffness_n_per_m, damping_ns_per_m)
}
