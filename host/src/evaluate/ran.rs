//! A run of a board as a labelled recording: what its converter read of the array, and when the object slipped.

use tenax_hal_shim::channel::{ARRAY_COUNT, FRAMES_PER_SLOW_FRAME, RANK_SWITCH_B, SCANS_PER_FRAME};

use crate::board::Run;
use crate::labelled::Step;

/// The steps of a run. A step slipped if the object did for at least half of the time since the step before.
#[must_use]
pub fn steps(run: &Run) -> Vec<Step> {
    let (mut steps, mut samples) = (Vec::new(), [0; ARRAY_COUNT]);
    let (mut slipped, mut scanned) = (0, 0);
    let frames = run.scans.chunks_exact(SCANS_PER_FRAME).zip(run.slipping.chunks_exact(SCANS_PER_FRAME));
    for (frame, (scans, slipping)) in frames.enumerate() {
        slipped += slipping.iter().filter(|slips| **slips).count();
        scanned += SCANS_PER_FRAME;
        let place = frame % usize::from(FRAMES_PER_SLOW_FRAME);
        if let Some(sample) = samples.get_mut(place) {
            *sample = scans.iter().map(|scan| scan[RANK_SWITCH_B]).sum();
        }
        if place == ARRAY_COUNT - 1 {
            steps.push(Step { samples, slip: 2 * slipped >= scanned });
            (slipped, scanned) = (0, 0);
        }
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::simulated;
    use crate::session::load_scene;
    use tenax_hal_shim::channel::SAMPLE_MAX;
    use tenax_scene::World;

    #[test]
    fn a_run_has_eighty_steps_a_second_and_slips_where_its_world_does() {
        let scene = load_scene("array-pick").unwrap();
        let (run, world) = simulated::run(World::new(&scene, 1), &mut |_| {});
        let steps = steps(&run);
        assert_eq!(steps.len(), 9 * 80);
        assert!(
            steps.iter().flat_map(|step| step.samples).all(|sample| sample > 500 && sample <= SAMPLE_MAX)
        );
        let slipped = steps.iter().filter(|step| step.slip).count() as f64 / 80.0;
        let spans = world.truth().slips.iter().map(|slip| slip.end_s.unwrap_or(9.0) - slip.macro_onset_s);
        assert!((slipped - spans.sum::<f64>()).abs() < 0.5, "{slipped} s");
    }
}
