//! Steady sliding on the shared friction rig: heard most of the time, and nothing before it begins or after it has ended.

use std::path::Path;

use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::wire::Slow;
use tenax_sim::board::Recorder;
use tenax_sim::session::{self, Board, ReplayOptions};

const SLIDES_S: (f64, f64) = (2.60, 5.40);
const STILL_S: (f64, f64) = (1.0, 2.50);

/// Ticks in which S1 said something, and all of them, within each span.
#[derive(Default)]
struct Listener {
    sliding: (u32, u32),
    still: (u32, u32),
}

impl Recorder for Listener {
    fn slow(&mut self, slow: &Slow) {
        let t_s = f64::from(slow.frame) / f64::from(FRAME_HZ);
        for (span, into) in [(SLIDES_S, &mut self.sliding), (STILL_S, &mut self.still)] {
            if (span.0..span.1).contains(&t_s) {
                into.0 += slow.ticks.iter().filter(|tick| tick.said.contains(DetectorId::S1)).count() as u32;
                into.1 += slow.ticks.len() as u32;
            }
        }
    }
}

#[test]
#[cfg_attr(not(recordings), ignore = "no recordings in ../shared/data")]
fn the_rigs_sliding_is_heard_and_its_disturbance_is_not() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/friction_rig_10khz.csv");
    for seed in 1..=4 {
        let mut listener = Listener::default();
        let plain = ReplayOptions::default();
        session::replay_served(&file, plain, seed, &Board::Host, &mut listener, &mut |_| {}).unwrap();
        let part = f64::from(listener.sliding.0) / f64::from(listener.sliding.1);
        // By its threshold in millivolts alone: 7 %.
        assert!(part > 0.6, "seed {seed}: {part}");
        assert_eq!(listener.still.0, 0, "seed {seed}");
    }
}
