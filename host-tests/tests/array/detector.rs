use proptest::prelude::*;
use tenax_logic::array::{ArrayDetector, ArrayVerdict, Judgement, Model, Reading, shipped};

use super::readings;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn slip_begins_and_ends_only_after_enough_frames_say_so(
        frames in readings(60..200),
        on_frames in 1..6u8,
        off_frames in 1..6u8,
    ) {
        let judgement = Judgement { on_frames, off_frames, ..shipped::MODEL.judgement };
        let model = Model { judgement, ..shipped::MODEL.clone() };
        let mut detector = ArrayDetector::new(&model);
        let mut before = ArrayVerdict::NONE;
        let (mut sure, mut unsure) = (0, 0);
        for reading in &frames {
            let verdict = detector.push(reading);
            prop_assert!(verdict.confidence_permille <= 1_000);
            let judged = detector.logit().is_some();
            sure = if judged && verdict.confidence_permille >= judgement.on_permille { sure + 1 } else { 0 };
            unsure = if judged && verdict.confidence_permille < judgement.off_permille { unsure + 1 } else { 0 };
            if verdict.slip && !before.slip {
                prop_assert!(sure >= u32::from(on_frames));
            }
            if !verdict.slip && before.slip && judged {
                prop_assert!(unsure >= u32::from(off_frames));
            }
            prop_assert_eq!(judged, verdict.age_ms == 0);
            before = verdict;
        }
    }
}

// Shows R5.
#[test]
fn without_readings_it_stands_down_and_says_for_how_long() {
    let mut detector = ArrayDetector::new(&shipped::MODEL);
    assert_eq!(detector.verdict(), ArrayVerdict::NONE);
    let load = |n: u16| -> Reading { std::array::from_fn(|e| Some(2_000 + n % 7 * (e as u16 + 1))) };
    for n in 0..39 {
        assert_eq!(detector.push(&load(n)), ArrayVerdict::NONE, "{n}");
    }
    assert_eq!(detector.push(&load(39)).age_ms, 0);
    let gone = [None; 10];
    for (frames, age_ms) in [(1, 12), (2, 25), (80, 1_000), (4_000, 50_000)] {
        let mut detector = detector.clone();
        let verdict = (0..frames).map(|_| detector.push(&gone)).last().unwrap();
        assert_eq!(verdict, ArrayVerdict { slip: false, confidence_permille: 0, age_ms });
    }
    for _ in 0..100_000 {
        detector.push(&gone);
    }
    assert_eq!(detector.verdict(), ArrayVerdict::NONE);
    assert_eq!(detector.push(&load(1)).age_ms, 0);
}
