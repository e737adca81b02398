//! The image takes every code right and decides what the host's own build of the logic decides.

use std::num::NonZeroU64;

use tenax::board::emulated::Options;
use tenax::board::simulated::{self, replay_scans};

use crate::{Swing, run};

#[test]
fn ten_seconds_without_a_lost_code() {
    let run = run(Swing::new(10.0), &Options::default());
    assert_eq!(run.starts, [None]);
    let counters = run.counters;
    assert_eq!((counters.overruns, counters.frames_lost, counters.ticks_late), (0, 0, 0));
    assert_eq!((counters.telemetry_dropped, counters.bad_frames), (0, 0));
    assert_eq!((run.bad_frames, run.messages_missed), (0, 0));
    assert_eq!(counters.ticks, counters.frames);
    assert!(counters.frames > 19_500, "{counters:?}");
    // Each slow frame carries the CRC of its samples, so this is every code of every channel too.
    let host = replay_scans(&run.scans, &[]);
    assert_eq!(host.len(), 800);
    assert!(host == run.slows, "the image and the host disagree, first at slow frame {:?}", {
        host.iter().zip(&run.slows).position(|(host, image)| host != image)
    });
}

/// The check above can fail: one code off by one is another CRC.
#[test]
fn one_wrong_code_is_noticed() {
    let mut run = run(Swing::new(0.1), &Options::default());
    assert!(replay_scans(&run.scans, &[]) == run.slows);
    run.scans[250][3] ^= 1;
    assert!(replay_scans(&run.scans, &[]) != run.slows);
}

#[test]
fn the_simulated_board_keeps_the_images_time() {
    let image = run(Swing::new(1.0), &Options::default());
    let (host, _) = simulated::run(Swing::new(1.0), &mut |_| {});
    assert!(host.scans == image.scans);
    assert_eq!(host.drives, image.drives);
    assert_eq!(host.slows, image.slows);
    assert_eq!(host.events, image.events);
}

/// At two cycles an instruction, the slow end of the bracket, no code is lost; only ticks that end a slow frame may run
/// into the next frame.
#[test]
fn three_quarters_as_fast_a_core_is_fast_enough() {
    let options = Options {
        instructions_per_second: NonZeroU64::new(75_000_000).expect("not zero"),
        ..Options::default()
    };
    let run = run(Swing::new(2.0), &options);
    assert_eq!((run.counters.overruns, run.counters.frames_lost), (0, 0));
    // In a slow frame, the tick that judges the array and those around its end are late at this speed, and nothing is lost.
    assert!(run.counters.ticks_late <= run.counters.ticks / 25 * 4, "{:?}", run.counters);
    assert!(replay_scans(&run.scans, &[]) == run.slows);
}

#[test]
fn a_tick_costs_less_than_a_fifth_of_the_core() {
    let run = run(Swing::new(2.0), &Options::default());
    let cost = run.tick_cost.expect("ticks were counted");
    // 0.5 ms at 100 MHz are 50 000 cycles; three cycles an instruction at worst.
    assert!(cost.count > 3_900 && cost.instructions_mean > 100.0, "{cost:?}");
    assert!(3.0 * cost.instructions_mean < 10_000.0, "{cost:?}");
    assert!(
        3 * cost.instructions_max < 50_000,
        "the dearest tick ends in its own half millisecond: {cost:?}"
    );
    let stack = run.stack_bytes.expect("the stack was painted");
    assert!((256..32 * 1024).contains(&stack), "{stack} bytes");
}
