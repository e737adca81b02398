//! A detector's onset is the frame in which it says that it decided: frame by frame, and in the record of every cycle.

use tenax_hal_shim::detector::{DetectorId, DetectorSet};
use tenax_hal_shim::frame::Frame;
use tenax_host_tests::Bench;
use tenax_host_tests::onsets::{Onsets, held_against_evidence};
use tenax_host_tests::teaching::SLIP_MV;
use tenax_logic::detectors::Said;

use super::sensing::{Sensing, taught_detectors};

/// What is done to a bench, one part after the other.
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
/// A second: long enough for the slowest detector.
const PART_FRAMES: u32 = 2_000;
/// The frames for which an outsider injects slip.
const INJECTED: std::ops::Range<u32> = 777..1_234;

/// The frames of all parts.
fn frames(seed: u64) -> impl Iterator<Item = Frame> {
    let mut bench = Bench::new(seed);
    (0..PARTS.len() as u32 * PART_FRAMES).map(move |n| {
        if n.is_multiple_of(PART_FRAMES) {
            PARTS[(n / PART_FRAMES) as usize](&mut bench);
        }
        bench.frame()
    })
}

fn counts(onsets: &Onsets) -> [(DetectorId, usize); DetectorId::COUNT] {
    DetectorId::ALL.map(|id| (id, onsets[id as usize].len()))
}

/// What is done to the bench makes these speak, if the Hebbian one was taught.
const SPEAK: [DetectorId; 5] =
    [DetectorId::S1, DetectorId::S2, DetectorId::Hebbian, DetectorId::Mlp, DetectorId::Injected];

fn spoke(onsets: &Onsets, id: DetectorId) -> bool {
    !onsets[id as usize].is_empty()
}

#[test]
fn frame_by_frame_an_onset_is_the_frame_that_decided_it() {
    let (mut sensing, mut detectors) = (Sensing::default(), taught_detectors(1));
    let mut onsets = Onsets::default();
    let mut before = DetectorSet::NONE;
    for frame in frames(1) {
        if INJECTED.contains(&frame.sequence) {
            detectors.injected.inject(Said::slip(true));
        } else if frame.sequence == INJECTED.end {
            detectors.injected.inject(Said::NOTHING);
        }
        let config = sensing.config;
        detectors.step(&config, &sensing.take(&frame));
        let said = detectors.slip().or(detectors.incipient());
        for (id, evidence) in detectors.evidence(&config) {
            assert_eq!(evidence.says(), said.contains(id));
            if said.contains(id) && !before.contains(id) {
                assert_eq!(evidence.decided_at, frame.sequence, "{id:?}");
                onsets[id as usize].push(frame.sequence);
            }
        }
        before = said;
    }
    assert!(SPEAK.into_iter().all(|id| spoke(&onsets, id)), "{:?}", counts(&onsets));
    assert_eq!(onsets[DetectorId::Injected as usize], [INJECTED.start]);
    let slots = |id: DetectorId| onsets[id as usize].iter().map(|frame| frame % 25);
    assert!(slots(DetectorId::Mlp).all(|slot| slot == 14), "when the fifth share of its work is done");
    assert!(slots(DetectorId::S2).all(|slot| slot == 15), "when the last quadrant has been read");
}

/// The whole fingertip, whose reflex answers what it hears.
fn whole(bench: &mut Bench, frames: impl Iterator<Item = Frame>) -> Onsets {
    for frame in frames {
        bench.fingertip.inject(Said::slip(INJECTED.contains(&frame.sequence)));
        bench.give(&frame);
    }
    held_against_evidence(&bench.slows)
}

#[test]
fn in_the_record_of_every_cycle_an_onset_is_where_the_evidence_says() {
    let mut bench = Bench::new(2);
    let onsets = whole(&mut bench, frames(2));
    for id in SPEAK {
        let taught = id != DetectorId::Hebbian;
        assert_eq!(spoke(&onsets, id), taught, "{:?}", counts(&onsets));
    }

    let mut taught = Bench::taught(3);
    taught.vibration_mv = SLIP_MV;
    taught.run(1_000);
    let onsets = held_against_evidence(&taught.slows);
    assert!(spoke(&onsets, DetectorId::Hebbian), "{:?}", counts(&onsets));
}

#[test]
fn frames_that_are_lost_do_not_part_the_two() {
    // All of a cycle, and the frames in which the detectors decide that do so once in it.
    for lost in [0..25u32, 14..16, 9..12, 3..4] {
        let mut bench = Bench::new(4);
        let with_losses = frames(4).map(|frame| {
            let gone = frame.sequence / 25 % 8 == 3 && lost.contains(&(frame.sequence % 25));
            if gone { Frame::lost(frame.sequence) } else { frame }
        });
        let onsets = whole(&mut bench, with_losses);
        assert!(spoke(&onsets, DetectorId::S1), "{lost:?}: {:?}", counts(&onsets));
    }
}

/// The check above can fail.
#[test]
#[should_panic(expected = "changed its mind")]
fn an_onset_in_another_slot_is_noticed() {
    let mut bench = Bench::new(2);
    let _ = whole(&mut bench, frames(2));
    for slow in &mut bench.slows {
        let (_, mlp) = &mut slow.evidence[DetectorId::Mlp as usize];
        mlp.decided_at -= 1;
    }
    let _ = held_against_evidence(&bench.slows);
}
