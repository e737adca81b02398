//! What a run is witnessed by: everything that its report and its figure are made from.

use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::Slow;
use tenax_logic::emg::model::EmgModel;
use tenax_scene::World;
use tenax_scene::plant::{Pins, Plant};

use crate::board::Recorder;
use crate::figure::sketch::{Needs, Sketch};
use crate::report::added::{Added, Grips};
use crate::report::wearer::Judge;
use crate::timeline::Timeline;

pub(super) struct Witness {
    pub(super) timeline: Timeline,
    pub(super) judge: Judge,
    pub(super) added: Added,
    pub(super) sketch: Sketch,
}

impl Witness {
    pub(super) fn new(zero_s: f64, span_s: (f64, f64), calibrated: Option<&EmgModel>) -> Self {
        let sketch = Sketch::new(zero_s, span_s);
        Self {
            timeline: Timeline::new(zero_s),
            judge: Judge::new(calibrated),
            added: Added::default(),
            sketch,
        }
    }
}

impl Recorder for Witness {
    fn scan(&mut self, codes: &Scan, drive: MotorDrive) {
        self.judge.scan(codes, drive);
    }

    fn slow(&mut self, slow: &Slow) {
        self.timeline.slow(slow);
        self.judge.slow(slow);
        self.added.slow(slow);
        self.sketch.slow(slow);
    }
}

pub(super) struct Drawn {
    pub(super) world: World,
    pub(super) needs: Needs,
    pub(super) grips: Grips,
}

impl Drawn {
    pub(super) fn new(world: World, span_s: (f64, f64)) -> Self {
        Self { world, needs: Needs::new(span_s), grips: Grips::default() }
    }

    pub(super) fn draw(&mut self) {
        for row in self.world.take_trace() {
            self.needs.push(&row);
            self.grips.push(&row);
        }
    }
}

impl Plant for Drawn {
    tenax_scene::put_around!(world);

    fn scan(&mut self, drive: MotorDrive) -> &Pins {
        self.draw();
        self.world.scan(drive)
    }

    fn duration_s(&self) -> f64 {
        self.world.duration_s()
    }
}
