//! Structure functions against the oracle.

use proptest::prelude::*;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_hal_shim::channel::SAMPLE_MAX;
use tenax_logic::array::past::Past;
use tenax_logic::array::structure::{CHANGE_MAX, FULL_AFTER, LAGS, READY_AFTER, Structure, WINDOWS};
use tenax_logic::array::{ELEMENTS, Reading};

use super::oracle::structures;
use super::{alive, readings};

fn fed<'a>(readings: impl IntoIterator<Item = &'a Reading>) -> [[u32; WINDOWS]; LAGS.len()] {
    *structure_of(readings).sums()
}

fn structure_of<'a>(readings: impl IntoIterator<Item = &'a Reading>) -> Structure {
    let (mut past, mut structure) = (Past::default(), Structure::default());
    for reading in readings {
        if past.push(reading).gone.contains(&true) {
            structure.forget();
        }
        structure.push(&past);
    }
    structure
}

proptest! {
    #[test]
    fn the_sliding_sums_are_those_of_their_windows(frames in prop::collection::vec(alive(), READY_AFTER..120)) {
        let all: Vec<Reading> = frames.iter().map(|frame| frame.map(Some)).collect();
        let exact = structures(&frames);
        for (sums, exact) in fed(&all).iter().zip(exact) {
            prop_assert_eq!(sums.map(i64::from), exact);
        }
    }

    #[test]
    fn a_change_of_all_elements_together_is_not_in_them(
        walk in prop::collection::vec(-100..100i32, READY_AFTER..90),
        dead in 0..ELEMENTS,
    ) {
        let mut at = 4_000;
        let frames: Vec<Reading> = walk
            .iter()
            .map(|step| {
                at += step;
                std::array::from_fn(|n| (n != dead).then_some((at + 10 * n as i32) as u16))
            })
            .collect();
        prop_assert_eq!(fed(&frames), [[0; WINDOWS]; LAGS.len()]);
    }

    #[test]
    fn an_element_that_is_gone_leaves_nothing_of_it(
        frames in readings(60..100),
        after in prop::collection::vec(alive(), FULL_AFTER + 1..90),
        dead in 0..ELEMENTS,
    ) {
        let without = |frame: &[u16; ELEMENTS]| -> Reading {
            std::array::from_fn(|n| (n != dead).then_some(frame[n]))
        };
        // Its last reading is not believed.
        let mut last = [Some(2_000); ELEMENTS];
        last[dead] = Some(SAMPLE_MAX);
        let gone = without(&[2_000; ELEMENTS]);
        let known: Vec<Reading> = frames.into_iter().chain([last, gone]).collect();
        prop_assert!(fed(&known).iter().all(|sums| sums[2..] == [0; WINDOWS - 2]));
        let after: Vec<Reading> = after.iter().map(without).collect();
        prop_assert_eq!(fed(known.iter().chain(&after)), fed(&after));
    }
}

#[test]
fn the_largest_changes_of_a_converter_fit() {
    // Half of the elements go from rail to rail against the others: as far apart as changes can be.
    for half_period in [1, 2, 3, 4, 8, 16] {
        let frames: Vec<Reading> = (0..200)
            .map(|n| {
                std::array::from_fn(|element| {
                    Some(if (n / half_period + element) % 2 == 0 { SAMPLE_MAX } else { 0 })
                })
            })
            .collect();
        let most = 16 * (ELEMENTS * ELEMENTS) as i64 * i64::from(CHANGE_MAX).pow(2);
        assert!(fed(&frames).as_flattened().iter().all(|&sum| i64::from(sum) <= most));
        assert!(half_period != 1 || fed(&frames)[0].map(i64::from)[WINDOWS - 1] == most);
    }
}

/// Elements that tremble independently by up to `size` samples.
fn trembling(random: &mut ChaCha8Rng, frames: usize, size: i32) -> Vec<Reading> {
    let mut frame = || std::array::from_fn(|_| Some((4_000 + random.random_range(-size..=size)) as u16));
    (0..frames).map(|_| frame()).collect()
}

#[test]
fn the_quiet_level_is_the_noise_and_outlasts_a_slip_and_an_element() {
    println!("seed 5");
    let mut random = ChaCha8Rng::seed_from_u64(5);
    assert_eq!(structure_of(&trembling(&mut random, 33, 3)).quiet(), u32::MAX, "nothing is known yet");
    let noise = trembling(&mut random, 200, 3);
    let level = structure_of(&noise).quiet();
    // Sixteen frames of 90 times twice the variance of -3..3, 4; the least of many such sums is less than that.
    let exact = 16 * 90 * 2 * 4;
    assert!((exact / 2..exact).contains(&level), "{level}");
    // A second of slip, and an element that goes in it and comes back.
    let slip = trembling(&mut random, 80, 40);
    let mut gone = slip.clone();
    gone[20..40].iter_mut().for_each(|reading| reading[4] = None);
    for slip in [slip, gone] {
        let after = structure_of(noise.iter().chain(&slip)).quiet();
        assert!((level..=level * 14 / 10).contains(&after), "{after} after {level}");
    }
    // A supply that is noisy for good becomes the quiet level within 20 s.
    let worse = trembling(&mut random, 80 * 20, 40);
    let after = structure_of(noise.iter().chain(&worse)).quiet();
    assert!(after > 50 * level, "{after} after {level}");
}

/// The contacts' memory is a distance: what slides twice as fast forgets in half the time.
#[test]
fn the_lag_at_which_they_stop_rising_is_the_speed_at_any_gain() {
    println!("seed 3");
    let mut random = ChaCha8Rng::seed_from_u64(3);
    // An element's share forgets by a part `1 - kept` in each frame.
    let mut ratio = |kept: f64, gain: f64| {
        let mut shares = [0.0f64; ELEMENTS];
        let frames: Vec<Reading> = (0..4_000)
            .map(|_| {
                shares.each_mut().map(|share| {
                    // Twelve uniform draws make a normal one.
                    let normal = (0..12).map(|_| random.random_range(0.0..1.0)).sum::<f64>() - 6.0;
                    *share = kept * *share + (1.0 - kept * kept).sqrt() * normal;
                    Some((4_000.0 + gain * *share) as u16)
                })
            })
            .collect();
        // The mean of many windows: one alone is chance.
        let mut sums = [0.0; LAGS.len()];
        for end in (100..frames.len()).step_by(40) {
            for (sum, windows) in sums.iter_mut().zip(fed(&frames[end - 80..end])) {
                *sum += f64::from(windows[WINDOWS - 1]);
            }
        }
        sums[LAGS.len() - 1] / sums[0]
    };
    for gain in [40.0, 120.0] {
        for kept in [0.3, 0.6, 0.9] {
            // Of an exponential memory: (1 - k^lag) / (1 - k).
            let exact = (1.0 - f64::powi(kept, LAGS[LAGS.len() - 1] as i32)) / (1.0 - kept);
            let found = ratio(kept, gain);
            assert!((found / exact - 1.0).abs() < 0.1, "memory {kept}, gain {gain}: {found} for {exact}");
        }
    }
}
