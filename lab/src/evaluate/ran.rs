//! A run of a board as a labelled recording: what its converter read of the array, and when the object slipped.

use tenax_hal_shim::channel::{ARRAY_COUNT, FRAME_HZ, FRAMES_PER_SLOW_FRAME, RANK_SWITCH_B, SCANS_PER_FRAME};
use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::motor::MotorDrive;

use tenax_sim::board::Recorder;
use tenax_sim::labelled::Step;

/// When the first step's last element is read, s: at the end of the tenth frame.
pub const FIRST_S: f64 = ARRAY_COUNT as f64 / FRAME_HZ as f64;

/// The steps of a run, gathered while it goes. A step slipped if the object did for at least half of the time since the
/// step before.
#[derive(Clone, Debug, Default)]
pub struct Steps {
    pub steps: Vec<Step>,
    samples: [u16; ARRAY_COUNT],
    /// The sum of the codes of the frame that is not yet whole.
    sum: u16,
    /// Scans so far, those since the last step, and those of them in which it slipped.
    scans: usize,
    scanned: usize,
    slipped: usize,
}

impl Recorder for Steps {
    fn scan(&mut self, codes: &Scan, _drive: MotorDrive, slipping: bool) {
        self.sum += codes[RANK_SWITCH_B];
        self.slipped += usize::from(slipping);
        self.scanned += 1;
        self.scans += 1;
        if self.scans.is_multiple_of(SCANS_PER_FRAME) {
            self.frame(self.scans / SCANS_PER_FRAME - 1);
        }
    }
}

impl Steps {
    fn frame(&mut self, frame: usize) {
        let place = frame % usize::from(FRAMES_PER_SLOW_FRAME);
        let sum = std::mem::take(&mut self.sum);
        if let Some(sample) = self.samples.get_mut(place) {
            *sample = sum;
        }
        if place == ARRAY_COUNT - 1 {
            self.steps.push(Step { samples: self.samples, slip: 2 * self.slipped >= self.scanned });
            (self.slipped, self.scanned) = (0, 0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_sim::board::simulated;
    use tenax_sim::session::load_scene;
    use tenax_hal_shim::channel::SAMPLE_MAX;
    use tenax_scene::World;

    #[test]
    fn a_run_has_eighty_steps_a_second_and_slips_where_its_world_does() {
        let scene = load_scene("array-pick").unwrap();
        let mut ran = Steps::default();
        let (_, world) = simulated::record(World::new(&scene, 1), &mut ran, &mut |_| {});
        let steps = ran.steps;
        assert_eq!(steps.len(), 9 * 80);
        assert!(
            steps.iter().flat_map(|step| step.samples).all(|sample| sample > 500 && sample <= SAMPLE_MAX)
        );
        let slipped = steps.iter().filter(|step| step.slip).count() as f64 / 80.0;
        let spans = world.truth().slips.iter().map(|slip| slip.end_s.unwrap_or(9.0) - slip.macro_onset_s);
        assert!((slipped - spans.sum::<f64>()).abs() < 0.5, "{slipped} s");
    }
}
