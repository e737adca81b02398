use proptest::prelude::*;
use tenax_hal_shim::channel::SAMPLE_MAX;
use tenax_logic::array::covariance::SlidingCovariance;
use tenax_logic::array::spectrum::SlidingSpectrum;
use tenax_logic::array::structure::{FULL_AFTER, WINDOWS};
use tenax_logic::array::{
    COVARIANCE_WINDOW, COVARIANCES, ELEMENTS, FEATURES, Features, PAPER_FEATURES, Preprocessor,
    PreprocessorConfig, Reading, SPECTRUM_WINDOW,
};

use super::oracle::{compressed, covariances, magnitudes, structures, sums};
use super::{alive, readings};

fn some(samples: &[u16; ELEMENTS]) -> Reading {
    samples.map(Some)
}

proptest! {
    #[test]
    fn the_covariance_is_that_of_differences_to_the_reading_a_lag_before(
        frames in prop::collection::vec(alive(), 90..150),
        lag in 1..=40u8,
        dead in 0..ELEMENTS,
        gone in 0..200usize,
    ) {
        let config = PreprocessorConfig { lag, ..PreprocessorConfig::DEFAULT };
        let mut preprocessor = Preprocessor::new(config);
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
    fn features_are_the_logarithms_of_the_oracles(
        frames in prop::collection::vec(alive(), SPECTRUM_WINDOW..120),
    ) {
        let config = PreprocessorConfig::DEFAULT;
        let mut preprocessor = Preprocessor::new(config);
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
        for (feature, exact) in features[COVARIANCES..PAPER_FEATURES].iter().zip(magnitudes(&sums(&frames))) {
            // Each part of the transform is rounded down by less than one sample, and its magnitude by less than 1.5.
            let (low, high) = ((exact - 1.5).max(0.0), exact + 1.5);
            let low = compressed(low * low, config.spectrum_knee) - 1.01;
            let high = compressed(high * high, config.spectrum_knee) + 0.01;
            prop_assert!((low..=high).contains(&f64::from(*feature)), "{feature} {exact}");
        }
        let widths = [1, 1, 2, 4, 8, 16];
        let energies = structures(&frames).into_iter().flat_map(|sums| sums.into_iter().zip(widths));
        for (n, (feature, (exact, width))) in features[PAPER_FEATURES..].iter().zip(energies).enumerate() {
            // The quiet level remembers more than the windows.
            if n == WINDOWS - 1 {
                continue;
            }
            let size = compressed(exact as f64, config.structure_knee * width);
            prop_assert!((f64::from(*feature) - size).abs() <= 1.01, "{feature} {exact}");
        }
    }

    #[test]
    fn with_too_many_dead_elements_there_are_no_features(frames in readings(60..100), dead_max in 0..=10u8) {
        let config = PreprocessorConfig { dead_max, ..PreprocessorConfig::DEFAULT };
        let mut preprocessor = Preprocessor::new(config);
        for (n, reading) in frames.iter().enumerate() {
            let dead = reading.iter().filter(|sample| sample.is_none()).count();
            let ready = n + 1 >= SPECTRUM_WINDOW && dead <= usize::from(dead_max);
            prop_assert_eq!(preprocessor.push(reading).is_some(), ready, "frame {}", n);
        }
    }

    #[test]
    fn readings_older_than_the_windows_leave_no_trace(
        past in readings(100..300),
        frames in prop::collection::vec(alive(), FULL_AFTER + 1..90),
    ) {
        let mut old = Preprocessor::default();
        // Whole turns of the spectrum: the rounding of a bin's parts depends on its phase.
        for reading in past.chunks_exact(SPECTRUM_WINDOW).flatten() {
            old.push(reading);
        }
        let mut fresh = Preprocessor::default();
        let (mut from_old, mut from_fresh) = (None, None);
        for frame in &frames {
            from_old = old.push(&some(frame)).copied();
            from_fresh = fresh.push(&some(frame)).copied();
        }
        prop_assert!(from_old.is_some());
        // The quiet level is to remember.
        let traceless = |features: Option<Features>| {
            features.map(|mut features| {
                features[PAPER_FEATURES + WINDOWS - 1] = 0;
                features
            })
        };
        prop_assert_eq!(traceless(from_old), traceless(from_fresh));
    }
}

/// From rail to rail at every bin's own frequency in turn; all elements together, and every other one against its neighbours.
#[test]
fn the_largest_changes_of_a_converter_stay_in_range() {
    for apart in [false, true] {
        let mut preprocessor = Preprocessor::default();
        let mut most = [0; FEATURES];
        for n in 0..400 {
            let reading: Reading = std::array::from_fn(|element| {
                let phase = n / (1 + n / 80) + if apart { element } else { 0 };
                Some(if phase % 2 == 0 { SAMPLE_MAX } else { 0 })
            });
            for (most, feature) in most.iter_mut().zip(preprocessor.push(&reading).into_iter().flatten()) {
                *most = (*most).max(*feature);
            }
        }
        let (paper, structures) = most.split_at(PAPER_FEATURES);
        let (covariances, bins) = paper.split_at(COVARIANCES);
        if apart {
            // 10 10 (2^10)^2 of 16 frames over a knee of 2^4 and more is below 2^30.
            assert!(structures.iter().all(|&f| (0..30 * 512).contains(&f)), "{most:?}");
            assert!(structures.iter().filter(|&&f| f > 0).count() > structures.len() / 2);
        } else {
            // 10 (2^13)^2 over the knee of 2^7 is 2^22.3; ten elements' 2^14, 40 times, squared over 2^11, is below 2^34.3.
            assert!(covariances.iter().all(|&f| f > 11_000 && f < 12_000), "{most:?}");
            assert!(bins.iter().all(|&f| f < 18_000) && bins.last() > Some(&16_000), "{most:?}");
            // Together they change nothing that they do apart, and the quiet level is nothing.
            assert_eq!(structures, [0; FEATURES - PAPER_FEATURES]);
        }
    }
}

#[test]
fn the_covariance_does_not_overflow() {
    const N: usize = COVARIANCE_WINDOW;
    let d_max = i64::from(SlidingCovariance::D_MAX);
    let largest = d_max * d_max * N as i64;
    assert!(largest < i64::from(i32::MAX) && 4 * largest > i64::from(i32::MAX));
    let mut covariance = SlidingCovariance::default();
    for (difference, size) in [(i32::MIN, d_max), (i32::MAX, d_max - 1), (i32::MAX, d_max - 1)] {
        (0..N).for_each(|_| covariance.push(&[difference; ELEMENTS]));
        assert!(covariance.entries().iter().all(|&entry| i64::from(entry) == size * size * N as i64));
    }
}

#[test]
fn after_any_time_the_spectrum_is_the_transform_of_its_window() {
    const FULL: i32 = 10 * SAMPLE_MAX as i32;
    let noise = |n: u32| (n.wrapping_mul(0x9E37_79B9) >> 12) as i32 % FULL;
    let square = |n: u32| if (n / 20).is_multiple_of(2) { FULL } else { -FULL };
    let waves: [fn(u32) -> i32; 3] = [noise, square, |_| FULL];
    for (length, wave) in
        [40, 41, 77, 100_000].into_iter().flat_map(|length| waves.map(|wave| (length, wave)))
    {
        let sums: Vec<i32> = (0..length).map(wave).collect();
        let mut spectrum = SlidingSpectrum::default();
        sums.iter().for_each(|&sum| spectrum.push(sum));
        for (found, exact) in spectrum.powers().into_iter().zip(magnitudes(&sums)) {
            // Each part is rounded down to one unit: at most sqrt(2) of them; and a single has 24 bits.
            let found = f64::from(found).sqrt();
            assert!((found - exact).abs() < 1.5 + 2e-7 * exact, "{length}: {found} {exact}");
        }
    }
}
