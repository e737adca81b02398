//! What a run is witnessed by: everything that its report and its figure are made from.

use tenax_hal_shim::frame::Scan;
use tenax_hal_shim::motor::MotorDrive;
use tenax_hal_shim::wire::Slow;
use tenax_logic::emg::model::EmgModel;
use tenax_scene::World;
use tenax_scene::plant::{Pins, Plant};
use tenax_scene::truth::Row;

use crate::board::Recorder;
use crate::figure::sketch::{Needs, Sketch};
use crate::report::added::{Added, Grips};
use crate::report::wearer::Judge;
use crate::timeline::Timeline;
use tenax_frames::serve::Teller;
use tenax_frames::truth::{self, Truth};

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
    teller: Teller,
    rows: u32,
}

impl Drawn {
    pub(super) fn new(world: World, span_s: (f64, f64), teller: Teller) -> Self {
        Self { world, needs: Needs::new(span_s), grips: Grips::default(), teller, rows: 0 }
    }

    pub(super) fn draw(&mut self) {
        let mut newest = None;
        for row in self.world.take_trace() {
            self.needs.push(&row);
            self.grips.push(&row);
            newest = Some(row);
        }
        let Some(row) = newest.filter(|_| self.teller.is_served()) else { return };
        self.rows += 1;
        if self.rows.is_multiple_of(truth::ROWS) {
            self.teller.tell(&truth_of(&self.world, &row));
        }
    }
}

fn truth_of(world: &World, row: &Row) -> Truth {
    let truth = world.truth();
    Truth {
        t_s: row.t_s,
        slide_mm_s: row.slide_mm_s.abs(),
        stuck_part: row.stuck_part,
        grip_n: row.grip_n,
        needed_n: row.needed_n,
        slips: truth.slips.iter().filter(|slip| !slip.meant).count(),
        slipped_mm: truth.slip_distance_mm,
        dropped: truth.dropped,
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
