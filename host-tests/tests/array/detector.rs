use proptest::prelude::*;
use tenax_logic::array::{ArrayDetector, ArrayVerdict, Judgement, Model, Reading, shipped};

use super::readings;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn slip_begins_and_ends_at_its_own_confidence(
        frames in readings(60..200),
        [off_permille, on_permille] in [0..500u16, 500..1_000u16],
    ) {
        let judgement = Judgement { on_permille, off_permille, ..shipped::MODEL.judgement };
        let model = Model { judgement, ..shipped::MODEL.clone() };
        let mut detector = ArrayDetector::new(&model);
        let mut slip = false;
        for reading in &frames {
            let verdict = detector.push(reading);
            prop_assert!(verdict.confidence_permille <= 1_000);
            let judged = detector.logit().is_some();
            let from = if slip { off_permille } else { on_permille };
            slip = judged && verdict.confidence_permille >= from;
            prop_assert_eq!((verdict.slip, verdict.age_ms == 0), (slip, judged));
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
