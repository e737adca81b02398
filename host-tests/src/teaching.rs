//! Lessons on the bench: vibration and shear that go with what a camera says.

use tenax_hal_shim::channel::{STRAIN, STRAIN_COUNT};
use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::wire::Down;
use tenax_hal_shim::words::{Code, Codes, GripMode};

use crate::Bench;

pub const SLIPS_UP: Codes = [Code::Minus, Code::Plus];
const LIFTS: Codes = [Code::Plus, Code::Plus];
const LOWERS: Codes = [Code::Plus, Code::Minus];
const SLIPS_DOWN: Codes = [Code::Minus, Code::Minus];

/// Vibration of a slip, below S1: only a network that has learned can answer it.
pub const SLIP_MV: f64 = 70.0;
pub const PICTURE_FRAMES: u32 = 66;
pub const AGE_MS: u16 = 40;

impl Bench {
    /// Holds something, and was taught seven pick-ups. Nothing vibrates, and the teacher has gone.
    pub fn taught(seed: u64) -> Self {
        let mut bench = Self::holding(seed);
        // Nothing is learned from a hand that moves, and S1 hears slips as quiet as these.
        bench.fingertip.act_on(DetectorSet::ALL.without(DetectorSet::only(DetectorId::S1)));
        for _ in 0..7 {
            for (codes, slips, up) in
                [(SLIPS_UP, true, 0.6), (LIFTS, false, 1.0), (LOWERS, false, 1.0), (SLIPS_DOWN, true, -0.8)]
            {
                bench.vibration_mv = if slips { SLIP_MV } else { 0.0 };
                bench.shear(up);
                bench.teach(codes, 45);
            }
        }
        bench.vibration_mv = 0.0;
        bench.shear(1.0);
        // Long enough for the last codes to be too old, and the pulses of the lessons to have settled.
        bench.run(1_000);
        bench.fingertip.act_on(DetectorSet::ALL);
        let network = bench.fingertip.network();
        assert!(network.updates > 7 * 3_000 && network.no_lesson.is_some(), "{network:?}");
        assert_eq!(bench.fingertip.mode(), GripMode::Watch);
        bench.events.clear();
        bench.slows.clear();
        bench
    }

    /// Shear on the gauges, 1 upwards: some feel it, the others the grasp.
    pub fn shear(&mut self, up: f64) {
        for gauge in 0..STRAIN_COUNT {
            let feels = if gauge % 2 == 0 { up * (40.0 + 10.0 * gauge as f64) } else { 80.0 };
            self.pins_mv[STRAIN + gauge] = 1_650.0 + feels;
        }
    }

    pub fn teach(&mut self, codes: Codes, pictures: u32) {
        for _ in 0..pictures {
            self.accepts(Down::Teach { codes, age_ms: AGE_MS });
            self.run(PICTURE_FRAMES);
        }
    }
}
