//! Check that the step of one scan fits twice into each bound (`docs/scenes.md`).

use super::SceneFile;
use super::check::{Checked, demand};
use crate::schedule::STEP_S;

/// The step must go into each bound at least so often.
const MARGIN: f64 = 2.0;

pub(super) fn step(scene: &SceneFile) -> Checked {
    let mut bounds = Vec::new();
    if let Some(object) = &scene.object {
        let (span, object) = (object.span(), object.get_ref());
        let empty_kg = object.mass_kg.get();
        let poured = scene.fill.iter().scan(empty_kg, |mass_kg, fill| {
            *mass_kg += fill.add_kg.get_ref().get();
            Some(*mass_kg)
        });
        let lightest_kg = poured.fold(empty_kg, f64::min);
        let mat_n_per_m = scene.table.mat_n_per_mm.get() * 1e3;
        // The mat's damping is a part of the critical one under the empty object.
        let mat_ns_per_m = 2.0 * scene.table.damping.get() * (mat_n_per_m * empty_kg).sqrt();
        bounds.push((
            "the object on the table's mat needs more mass_kg, less poured out, or a softer mat_n_per_mm",
            span.clone(),
            oscillator_s(lightest_kg, mat_n_per_m, mat_ns_per_m),
        ));
        bounds.push((
            "the gripper on the object needs a smaller stiffness_n_per_mm, a lower speed_mm_s, or more force_n",
            span,
            gripper_s(scene, object.stiffness_n_per_mm.get() * 1e3),
        ));
    }
    if let Some(robot) = &scene.robot {
        let (span, robot) = (robot.span(), robot.get_ref());
        let (mass_kg, stiffness_n_per_m) = (robot.probe_kg.get(), robot.stiffness_n_per_mm.get() * 1e3);
        let damping_ns_per_m = 2.0 * robot.damping.get() * (stiffness_n_per_m * mass_kg).sqrt();
        bounds.push((
            "the probe on the arm needs more probe_kg, or a smaller stiffness_n_per_mm",
            span,
            oscillator_s(mass_kg, stiffness_n_per_m, damping_ns_per_m),
        ));
    }
    bounds.into_iter().try_for_each(|(what, span, bound_s)| {
        demand(STEP_S * MARGIN <= bound_s, span, || {
            let (bound_us, step_us) = (bound_s * 1e6, STEP_S * 1e6);
            format!("{what}: it can be stepped by {bound_us:.0} us at most, and the step of {step_us} us must fit {MARGIN} times")
        })
    })
}

/// The longest stable step of semi-implicit Euler on an oscillator, s: `(sqrt(c^2 + 4 k m) - c) / k`, which is `2 / omega` undamped.
///
/// From Jury's test of `z^2 - (2 - k dt^2/m - c dt/m) z + (1 - c dt/m)`, with damping at the old speed.
fn oscillator_s(mass_kg: f64, stiffness_n_per_m: f64, damping_ns_per_m: f64) -> f64 {
    let square = damping_ns_per_m * damping_ns_per_m + 4.0 * stiffness_n_per_m * mass_kg;
    // The form that subtracts no two numbers that are nearly equal.
    4.0 * mass_kg / (square.sqrt() + damping_ns_per_m)
}

/// The longest stable step of explicit Euler on a gripper that slows under load and presses a spring, s: `2 F_max / (k v_max)`, from
/// `F' = k/2 v_max (duty - F / F_max)`. Beyond it a single step presses harder than the motor can.
fn gripper_s(scene: &SceneFile, stiffness_n_per_m: f64) -> f64 {
    2.0 * scene.gripper.force_n.get() / (stiffness_n_per_m * (scene.gripper.speed_mm_s.get() / 1e3))
}
