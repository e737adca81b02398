//! Trials one after the other on a board that is never switched off: the image itself learns from each to the next.
//! It is asked for its network at the end of each.

use tenax_hal_shim::channel::{FRAMES_PER_SLOW_FRAME, SCAN_HZ, SCANS_PER_FRAME};
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::Down;
use tenax_scene::World;
use tenax_scene::plant::{Calibrated, Pins, Plant};

use super::trial::{Setup, Trial, by_network};
use tenax_sim::board::Run;
use tenax_sim::board::agreement::Said;

const SLOW_FRAME_SCANS: usize = FRAMES_PER_SLOW_FRAME as usize * SCANS_PER_FRAME;

/// Whole slow frames of a world.
pub(super) fn slow_frames(world: &World) -> usize {
    (world.duration_s() * f64::from(SCAN_HZ)) as usize / SLOW_FRAME_SCANS
}

/// The trials, of which each begins where the one before it ends.
#[derive(Debug)]
pub struct Chain {
    setups: Vec<Setup>,
    now: usize,
    left: usize,
}

impl Chain {
    /// A chain of at least one trial.
    pub fn new(setups: Vec<Setup>) -> Self {
        let left = setups.first().map_or(0, |setup| slow_frames(&setup.world) * SLOW_FRAME_SCANS);
        Self { setups, now: 0, left }
    }

    /// The trials as the board ran them. `host` has the reports of the host's logic to the same codes: it tells slip from a
    /// warning, which the line does not, and is the board's own where the two agree.
    pub fn trials(self, run: &Run, host: &Said) -> Vec<Trial> {
        let mut slows = run.slows.iter().peekable();
        let mut begins = 0;
        let trial = |setup: Setup| {
            let ends = begins + slow_frames(&setup.world);
            let mut trial = Trial { lift_s: setup.lift_s, ..Trial::default() };
            let place = |frame: u32| frame as usize / usize::from(FRAMES_PER_SLOW_FRAME);
            while let Some(slow) = slows.next_if(|slow| place(slow.frame) < ends) {
                let first = place(slow.frame) * usize::from(FRAMES_PER_SLOW_FRAME);
                let ticks = host.slip_and_warning.iter().skip(first).take(slow.ticks.len());
                let said: Vec<_> = ticks.map(|&sets| by_network(sets)).collect();
                trial.hear(place(slow.frame) - begins, slow, &said);
            }
            trial.truth = setup.world.truth().clone();
            begins = ends;
            trial
        };
        self.setups.into_iter().map(trial).collect()
    }
}

impl Plant for Chain {
    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        if self.left == 0 && self.now + 1 < self.setups.len() {
            self.now += 1;
            self.left = slow_frames(&self.setups[self.now].world) * SLOW_FRAME_SCANS;
        }
        self.left = self.left.saturating_sub(1);
        self.setups[self.now].world.scan(drive)
    }

    fn commands(&mut self) -> Vec<Down> {
        let mut commands = self.setups[self.now].world.commands();
        if self.left == SLOW_FRAME_SCANS {
            commands.push(Down::Network);
        }
        commands
    }

    fn trusts_line(&self) -> bool {
        self.setups.iter().any(|setup| setup.world.trusts_line())
    }

    fn calibrated(&self) -> Option<Calibrated> {
        self.setups.first()?.world.calibrated()
    }

    fn slipping(&self) -> bool {
        self.setups[self.now].world.slipping()
    }

    fn duration_s(&self) -> f64 {
        let frames: usize = self.setups.iter().map(|setup| slow_frames(&setup.world)).sum();
        (frames * SLOW_FRAME_SCANS) as f64 / f64::from(SCAN_HZ)
    }
}
