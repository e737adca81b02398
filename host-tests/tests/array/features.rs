//! Features against the oracle.

use proptest::prelude::*;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_hal_shim::channel::SAMPLE_MAX;
use tenax_logic::array::covariance::SlidingCovariance;
use tenax_logic::array::structure::{FULL_AFTER, WINDOWS};
use tenax_logic::array::{
    COVARIANCES, ELEMENTS, FEATURES, Features, PAPER_FEATURES, Preprocessor, PreprocessorConfig, Reading,
    SPECTRUM_WINDOW,
};

use super::oracle::{compressed, covariances, magnitudes, structures};
use super::{alive, readings};

fn some(samples: &[u16; ELEMENTS]) -> Reading {
    samples.map(Some)
}

fn entries_of(element: usize) -> impl Iterator<Item = usize> {
    let pairs = (0..ELEMENTS).flat_map(|a| (a..ELEMENTS).map(move |b| (a, b)));
    pairs.enumerate().filter(move |(_, (a, b))| *a == element || *b == element).map(|(n, _)| n)
}

proptest! {
    #[test]
    fn the_sliding_covariance_is_that_of_its_window(
        frames in prop::collection::vec(alive(), SPECTRUM_WINDOW + 1..120),
    ) {
        let mut preprocessor: Preprocessor = Preprocessor::new(PreprocessorConfig::DEFAULT);
        for frame in &frames {
            preprocessor.push(&some(frame));
        }
        let found = preprocessor.covariance().entries().map(i64::from);
        prop_assert_eq!(found, covariances(&frames));
    }

    #[test]
    fn a_difference_is_to_the_reading_a_lag_before(
        frames in prop::collection::vec(alive(), 90..150),
        lag in 1..=40u8,
        dead in 0..ELEMENTS,
        gone in 0..200usize,
    ) {
        let config = PreprocessorConfig { lag, ..PreprocessorConfig::DEFAULT };
        let mut preprocessor: Preprocessor = Preprocessor::new(config);
        let ready_after = SPECTRUM_WINDOW.max(usize::from(lag) + 10);
        for (n, frame) in frames.iter().enumerate() {
            let mut reading = some(frame);
            if n == gone {
                reading[dead] = None;
            }
            let ready = preprocessor.push(&reading).is_some();
            prop_assert_eq!(ready, n + 1 >= ready_after);
            let lag = usize::from(lag);
            if n < lag + 10 {
                continue;
            }
            // Every lag-th reading from the newest back to the window's oldest difference, as if there were no others.
            let difference = |at: usize, element: usize| {
                let is_known = element != dead || gone + lag < at || gone > n;
                let change = i64::from(frames[at][element]) - i64::from(frames[at - lag][element]);
                if is_known { change.clamp(-8_192, 8_191) } else { 0 }
            };
            let pairs = (0..ELEMENTS).flat_map(|a| (a..ELEMENTS).map(move |b| (a, b)));
            for (entry, (a, b)) in preprocessor.covariance().entries().iter().zip(pairs) {
                let exact: i64 = (n - 9..=n).map(|at| difference(at, a) * difference(at, b)).sum();
                prop_assert_eq!(i64::from(*entry), exact, "frame {}, {} {}", n, a, b);
            }
        }
    }

    #[test]
    fn features_are_the_logarithms_of_what_the_oracle_finds(
        frames in prop::collection::vec(alive(), SPECTRUM_WINDOW..120),
    ) {
        let config = PreprocessorConfig::DEFAULT;
        let mut preprocessor: Preprocessor = Preprocessor::new(config);
        let mut last = None;
        for frame in &frames {
            last = preprocessor.push(&some(frame)).copied();
        }
        let features = last.expect("the windows are full");
        for (feature, exact) in features.iter().zip(covariances(&frames)) {
            let size = compressed(exact.unsigned_abs() as f64, config.covariance_knee);
            // Down to a unit; a single's 24 bits are far below one.
            prop_assert!((f64::from(feature.abs()) - size).abs() <= 1.01, "{feature} {exact}");
            prop_assert!(*feature == 0 || (*feature > 0) == (exact > 0), "{feature} {exact}");
        }
        for (feature, exact) in features[COVARIANCES..PAPER_FEATURES].iter().zip(magnitudes(&frames)) {
            // Each part of the transform is rounded down by less than one sample, and its magnitude by less than 1.5.
            let (low, high) = ((exact - 1.5).max(0.0), exact + 1.5);
            let low = compressed(low * low, config.spectrum_knee) - 1.01;
            let high = compressed(high * high, config.spectrum_knee) + 0.01;
            prop_assert!((low..=high).contains(&f64::from(*feature)), "{feature} {exact}");
        }
        let widths = [1, 1, 2, 4, 8, 16];
        let sums = structures(&frames).into_iter().flat_map(|sums| sums.into_iter().zip(widths));
        for (n, (feature, (exact, width))) in features[PAPER_FEATURES..].iter().zip(sums).enumerate() {
            // The quiet level is there, which remembers more than the windows.
            if n == WINDOWS - 1 {
                continue;
            }
            let size = compressed(exact as f64, config.structure_knee * width);
            prop_assert!((f64::from(*feature) - size).abs() <= 1.01, "{feature} {exact}");
        }
    }

    #[test]
    fn without_a_reading_an_element_has_no_covariance_and_makes_no_sound(
        frames in prop::collection::vec(alive(), 100..140),
        dead in 0..ELEMENTS,
        dies_at in 45..60usize,
        back_at in 61..95usize,
    ) {
        let mut with_gap: Preprocessor = Preprocessor::new(PreprocessorConfig::DEFAULT);
        let mut held: Preprocessor = Preprocessor::new(PreprocessorConfig::DEFAULT);
        for (n, frame) in frames.iter().enumerate() {
            let is_dead = (dies_at..back_at).contains(&n);
            let mut reading = some(frame);
            // To its neighbours it is an element that holds still, and then goes on from where it was.
            let mut still = *frame;
            if is_dead {
                reading[dead] = None;
            }
            let offset = i32::from(frames[back_at][dead]) - i32::from(frames[dies_at - 1][dead]);
            if n >= back_at {
                still[dead] = (i32::from(frame[dead]) - offset) as u16;
            } else if is_dead {
                still[dead] = frames[dies_at - 1][dead];
            }
            let found = with_gap.push(&reading).copied();
            // A sample of its own cannot stand for every one of those, so only where it can.
            if n >= back_at && i32::from(frame[dead]) < offset {
                break;
            }
            let expected = held.push(&some(&still)).copied();
            if let (Some(found), Some(expected)) = (found, expected) {
                if is_dead {
                    for entry in entries_of(dead) {
                        prop_assert_eq!(found[entry], 0);
                    }
                }
                // Bin 0 alone knows what the element missed.
                let others = COVARIANCES + 1..PAPER_FEATURES;
                prop_assert_eq!(&found[others.clone()], &expected[others]);
                let others: Vec<_> =
                    (0..COVARIANCES).filter(|n| !entries_of(dead).any(|own| own == *n)).collect();
                prop_assert!(others.iter().all(|&n| found[n] == expected[n]));
            }
        }
    }

    #[test]
    fn too_many_dead_elements_leave_nothing_to_judge_by(frames in readings(60..100), dead_max in 0..=10u8) {
        let config = PreprocessorConfig { dead_max, ..PreprocessorConfig::DEFAULT };
        let mut preprocessor: Preprocessor = Preprocessor::new(config);
        for (n, reading) in frames.iter().enumerate() {
            let dead = reading.iter().filter(|sample| sample.is_none()).count();
            let ready = n + 1 >= SPECTRUM_WINDOW && dead <= usize::from(dead_max);
            prop_assert_eq!(preprocessor.push(reading).is_some(), ready, "frame {}", n);
        }
    }

    #[test]
    fn what_was_long_ago_leaves_no_trace(
        past in readings(100..300),
        frames in prop::collection::vec(alive(), FULL_AFTER + 1..90),
    ) {
        let mut old: Preprocessor = Preprocessor::default();
        // Whole turns, so that both count phases from the same frame: the rounding of a bin's parts knows about it.
        for reading in past.chunks_exact(SPECTRUM_WINDOW).flatten() {
            old.push(reading);
        }
        let mut fresh: Preprocessor = Preprocessor::default();
        let (mut from_old, mut from_fresh) = (None, None);
        for frame in &frames {
            from_old = old.push(&some(frame)).copied();
            from_fresh = fresh.push(&some(frame)).copied();
        }
        prop_assert!(from_old.is_some());
        // But for the quiet level, which is to remember.
        let traceless = |features: Option<Features>| {
            features.map(|mut features| {
                features[PAPER_FEATURES + WINDOWS - 1] = 0;
                features
            })
        };
        prop_assert_eq!(traceless(from_old), traceless(from_fresh));
    }
}

#[test]
fn an_hour_later_it_is_still_exact() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut preprocessor: Preprocessor = Preprocessor::default();
    let mut covariance = SlidingCovariance::<10>::default();
    let mut frames = Vec::new();
    for _ in 0..80 * 3_600 {
        let frame: [u16; ELEMENTS] = std::array::from_fn(|_| random.random_range(0..=SAMPLE_MAX));
        preprocessor.push(&some(&frame));
        covariance.push(&frame.map(i32::from));
        if frames.len() == 200 {
            frames.remove(0);
        }
        frames.push(frame);
    }
    assert_eq!(preprocessor.covariance().entries().map(i64::from), covariances(&frames));
    for (power, exact) in preprocessor.spectrum().powers().iter().zip(magnitudes(&frames)) {
        assert!((f64::from(*power).sqrt() - exact).abs() < 1.5 + 2e-7 * exact, "{power} {exact}");
    }
    for _ in 0..10 {
        covariance.push(&[0; ELEMENTS]);
    }
    assert_eq!(*covariance.entries(), [0; COVARIANCES]);
}

#[test]
fn the_worst_that_a_converter_gives_stays_in_range() {
    let mut preprocessor: Preprocessor = Preprocessor::default();
    let mut most = [0; FEATURES];
    for n in 0..400 {
        // Every bin's own frequency in turn, from rail to rail.
        let half_period = 1 + n / 80;
        let sample = if n / half_period % 2 == 0 { SAMPLE_MAX } else { 0 };
        if let Some(features) = preprocessor.push(&[Some(sample); ELEMENTS]) {
            for (most, feature) in most.iter_mut().zip(features) {
                *most = (*most).max(*feature);
            }
        }
    }
    // 10 (2^13)^2 over the knee of 2^7 is 2^22.3; ten elements' 2^14, 40 times, squared over 2^11, is below 2^34.3.
    assert!(most[..COVARIANCES].iter().all(|&f| f > 11_000 && f < 12_000), "{most:?}");
    assert!(most[COVARIANCES..PAPER_FEATURES].iter().all(|&f| f < 18_000), "{most:?}");
    assert!(most[PAPER_FEATURES - 1] > 16_000);
    // All elements together: nothing that they do apart, and a quiet level of nothing.
    assert_eq!(most[PAPER_FEATURES..], [0; FEATURES - PAPER_FEATURES]);
}

fn worst_of_window<const N: usize>() {
    let d_max = i64::from(SlidingCovariance::<N>::D_MAX);
    assert!(
        (d_max * d_max * N as i64) < i64::from(i32::MAX)
            && 4 * d_max * d_max * N as i64 > i64::from(i32::MAX)
    );
    let mut covariance = SlidingCovariance::<N>::default();
    for n in 0..3 * N {
        covariance.push(&[if n < N { i32::MIN } else { i32::MAX }; ELEMENTS]);
        let size = if n < N { d_max } else { d_max - 1 };
        if (n + 1).is_multiple_of(N) {
            assert!(covariance.entries().iter().all(|&entry| i64::from(entry) == size * size * N as i64));
        }
    }
}

#[test]
fn no_window_overflows() {
    worst_of_window::<1>();
    worst_of_window::<2>();
    worst_of_window::<5>();
    worst_of_window::<10>();
    worst_of_window::<20>();
    worst_of_window::<32>();
    worst_of_window::<40>();
}
