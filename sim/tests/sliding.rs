//! Steady sliding on the shared friction rig: heard most of the time, and nothing before it begins or after it has ended.

use std::ops::Range;

use tenax_hal_shim::channel::FRAME_HZ;
use tenax_hal_shim::detector::DetectorId;
use tenax_sim::board::Run;
use tenax_sim::live::Use;
use tenax_sim::session::{self, Board};

const SLIDES_S: Range<f64> = 2.60..5.40;
const STILL_S: Range<f64> = 1.0..2.50;

/// Part of the ticks within a span in which S1 says slip.
fn said_part(run: &Run, span_s: &Range<f64>) -> f64 {
    let within =
        run.slows.iter().filter(|slow| span_s.contains(&(f64::from(slow.frame) / f64::from(FRAME_HZ))));
    let said: Vec<bool> =
        within.flat_map(|slow| &slow.ticks).map(|tick| tick.said.contains(DetectorId::S1)).collect();
    said.iter().filter(|said| **said).count() as f64 / said.len() as f64
}

#[test]
#[cfg_attr(not(recordings), ignore = "no recordings in ../shared/data")]
fn the_rigs_sliding_is_heard_and_its_disturbance_is_not() {
    let file = crate::common::shared("friction_rig_10khz.csv");
    for seed in 1..=4 {
        let mut run = Run::default();
        let plain = Use::default();
        session::replay_served(&file, (None, None), plain, seed, &Board::Host, &mut run, &mut |_| {})
            .unwrap();
        // By its threshold in millivolts alone: 7 %.
        let part = said_part(&run, &SLIDES_S);
        assert!(part > 0.6, "seed {seed}: {part}");
        assert_eq!(said_part(&run, &STILL_S), 0.0, "seed {seed}");
    }
}
