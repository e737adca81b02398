use proptest::prelude::*;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use tenax_hal_shim::channel::SAMPLE_MAX;
use tenax_logic::array::past::Past;
use tenax_logic::array::structure::{FULL_AFTER, LAGS, READY_AFTER, Structure, WINDOWS};
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

fn trembling(random: &mut ChaCha8Rng, frames: usize, size: i32) -> Vec<Reading> {
    let mut frame = || std::array::from_fn(|_| Some((4_000 + random.random_range(-size..=size)) as u16));
    (0..frames).map(|_| frame()).collect()
}

#[test]
fn the_quiet_level_is_the_noise_and_outlasts_a_slip_and_an_element() {
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
