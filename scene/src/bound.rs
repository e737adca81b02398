//! The bound of a scene: the least force that holds, planned by one who knows friction, load and pulls of all of it ahead of
//! time and is limited by the gripper alone.

use tenax_hal_shim::channel::{FRAME_HZ, SCANS_PER_FRAME};

use crate::file::SceneFile;
use crate::physics::grasp::Grasp;
use crate::physics::hand::Hand;
use crate::schedule::{FRAME_S, STEP_S};

/// The part of the force above what holds exactly: nothing holds on the edge of sliding.
const EDGE: f64 = 0.02;
/// The part of its speed at which the gripper is taken to close: drives are whole per mille, forces one frame old.
const SPEED_PART: f64 = 0.8;
const EARLY_FRAMES: usize = 4;

/// Force of each finger at each frame of a scene, N, once it touches something.
///
/// The demand is what the object needs while it moves with the hand; the plan closes as late as gripper speed and dead time
/// let it meet every demand to come.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    target_n: Vec<f32>,
    most_n: f64,
}

impl Plan {
    pub fn of(scene: &SceneFile) -> Option<Self> {
        let needed_n = needed_n(scene)?;
        let gripper = &scene.gripper;
        // Twice the dead time: what came out short of the first closing is made up for within the second.
        let lead = (2.0 * gripper.dead_time_ms.get() / 1e3 / FRAME_S).round() as usize + EARLY_FRAMES;
        let stiffness_n_per_mm = scene.object.as_ref()?.get_ref().stiffness_n_per_mm.get();
        let fastest_n = SPEED_PART * gripper.speed_mm_s.get() * stiffness_n_per_mm / 2.0 * FRAME_S;
        let mut target_n = vec![0.0; needed_n.len()];
        let mut later_n = 0.0_f64;
        for (frame, target_n) in target_n.iter_mut().enumerate().rev() {
            let soon = &needed_n[frame..needed_n.len().min(frame + lead)];
            let soon_n = (1.0 + EDGE) * f64::from(soon.iter().copied().fold(0.0, f32::max));
            // The fuller the load, the slower it closes.
            let step_n = fastest_n * (1.0 - later_n / gripper.force_n.get()).max(0.0);
            later_n = soon_n.max(later_n - step_n);
            *target_n = later_n as f32;
        }
        Some(Self { target_n, most_n: f64::INFINITY })
    }

    pub fn at_most(self, most_n: f64) -> Self {
        Self { most_n, ..self }
    }

    pub fn target_n(&self, t_s: f64, stops_n: Option<f64>) -> f64 {
        let frame = (t_s * f64::from(FRAME_HZ)) as usize;
        let planned_n = self.target_n.get(frame).copied().map_or(0.0, f64::from);
        planned_n.max(stops_n.unwrap_or(0.0)).min(self.most_n)
    }
}

fn needed_n(scene: &SceneFile) -> Option<Vec<f32>> {
    let mut object = scene.object.as_ref()?.get_ref().clone();
    (object.crush_n, object.break_n) = (None, None);
    let mut grasp = Grasp::new(scene, &object);
    let mut hand = Hand::new(&scene.moves, &scene.swing);
    let frames = (scene.duration_s() * f64::from(FRAME_HZ)) as usize;
    let mut scans = 0_u64;
    let frame = |_| {
        (0..SCANS_PER_FRAME).fold(0.0, |most_n: f64, _| {
            scans += 1;
            let t_s = scans as f64 * STEP_S;
            hand.step(t_s, scene.arm.felt(grasp.table_part()));
            grasp.step(t_s, &hand, scene.gripper.force_n.get());
            most_n.max(grasp.carries_n())
        }) as f32
    };
    Some((0..frames).map(frame).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::GRAVITY_M_S2;

    fn scene(name: &str) -> SceneFile {
        let (_, text) = crate::builtin().iter().find(|(own, _)| *own == name).unwrap();
        SceneFile::parse(text, name).unwrap()
    }

    #[test]
    fn it_closes_before_the_glass_is_wet_and_no_sooner_than_it_must() {
        let plan = Plan::of(&scene("glass")).unwrap();
        // 0.55 kg by two fingers: 0.5 dry, 0.25 from 42.02 s on.
        let needed_n = |mu: f64| 0.55 * GRAVITY_M_S2 / 2.0 / mu;
        let at = |t_s| plan.target_n(t_s, None);
        assert!((1.0..1.03).contains(&(at(41.5) / needed_n(0.5))), "{} N", at(41.5));
        // The dead time of 30 ms before all of it is wet, it has to press as hard as then.
        assert!((1.0..1.03).contains(&(at(41.99) / needed_n(0.25))), "{} N", at(41.99));
        assert_eq!(plan.clone().at_most(5.0).target_n(41.99, None), 5.0);
        assert_eq!(plan.at_most(50.0).target_n(41.99, Some(20.0)), 20.0);
    }
}
