//! The onset of a detector is the frame in which its evidence says that it decided.

use tenax_hal_shim::detector::DetectorId;
use tenax_hal_shim::frame::Frame;
use tenax_host_tests::Bench;
use tenax_host_tests::onsets::{Onsets, held_against_evidence};
use tenax_host_tests::teaching::SLIP_MV;
use tenax_logic::detectors::Said;

/// Changes of the bench, one after the other.
const PARTS: [fn(&mut Bench); 8] = [
    |_| {},
    |bench| {
        bench.load(4.0, 0.6);
        bench.press(700.0);
    },
    |bench| bench.vibration_mv = SLIP_MV,
    |bench| bench.vibration_mv = 0.0,
    |bench| bench.vibration_mv = 300.0,
    |bench| {
        bench.vibration_mv = 0.0;
        bench.load(4.0, 2.4);
    },
    |bench| {
        bench.load(4.0, 0.6);
        bench.sliding_mv = 60.0;
    },
    |bench| bench.sliding_mv = 0.0,
];
/// Frames of a part: long enough for the slowest detector.
const PART_FRAMES: u32 = 2_000;
/// Frames of injected slip.
const INJECTED: std::ops::Range<u32> = 777..1_234;
/// Detectors that report the changes above, if the Hebbian one was taught.
const SPEAK: [DetectorId; 5] =
    [DetectorId::S1, DetectorId::S2, DetectorId::Hebbian, DetectorId::Mlp, DetectorId::Injected];

/// Onsets in a run through all parts that loses some frames.
fn run(bench: &mut Bench, is_lost: impl Fn(u32) -> bool) -> Onsets {
    for n in 0..PARTS.len() as u32 * PART_FRAMES {
        if n.is_multiple_of(PART_FRAMES) {
            PARTS[(n / PART_FRAMES) as usize](bench);
        }
        bench.fingertip.inject(Said::slip(INJECTED.contains(&n)));
        let frame = bench.frame();
        bench.give(&if is_lost(n) { Frame::lost(frame.sequence) } else { frame });
    }
    held_against_evidence(&bench.slows)
}

#[test]
fn an_onset_is_the_frame_that_decided_it() {
    for (mut bench, taught) in [(Bench::new(2), false), (Bench::taught(3), true)] {
        let first = bench.frames;
        let onsets = run(&mut bench, |_| false);
        for id in SPEAK {
            let speaks = !onsets[id as usize].is_empty();
            assert_eq!(speaks, taught || id != DetectorId::Hebbian, "{id:?}, taught: {taught}");
        }
        assert_eq!(onsets[DetectorId::Injected as usize], [first + INJECTED.start]);
        let slots = |id: DetectorId| onsets[id as usize].iter().map(|frame| frame % 25);
        assert!(slots(DetectorId::Mlp).all(|slot| slot == 14), "when the fifth share of its work is done");
        assert!(slots(DetectorId::S2).all(|slot| slot == 15), "when the last quadrant has been read");
    }
}

#[test]
fn lost_frames_do_not_part_onset_and_evidence() {
    // A whole slow frame, and the frames in which detectors decide that do so once in it.
    for lost in [0..25u32, 14..16, 9..12, 3..4] {
        let onsets = run(&mut Bench::new(4), |n| n / 25 % 8 == 3 && lost.contains(&(n % 25)));
        assert!(!onsets[DetectorId::S1 as usize].is_empty(), "{lost:?}");
    }
}
