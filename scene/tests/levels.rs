//! Where the scenes stand to S1's default of 100 mV: onset clearly above it, everything else but knocks clearly below.

use crate::common::{Reflex, run, scene};

const S1_MV: f64 = 100.0;

/// The loudest envelope between two instants, mV.
fn loudest(name: &str, seed: u64, begin_s: f64, end_s: f64) -> f64 {
    let mut loudest_mv: f64 = 0.0;
    run(&scene(name), seed, Reflex::Ratio, |world, _, mv| {
        if (begin_s..end_s).contains(&world.now_s()) {
            loudest_mv = loudest_mv.max(mv);
        }
    });
    loudest_mv
}

#[test]
fn holding_lifting_swinging_and_filling_stay_below_half_of_s1() {
    for seed in 1..=3 {
        let held_mv = loudest("glass", seed, 2.0, 19.9);
        assert!(held_mv < S1_MV / 2.0, "seed {seed}: {held_mv} mV");
    }
}

#[test]
fn the_onset_of_sliding_is_two_to_four_times_s1() {
    for seed in 1..=3 {
        let onset_mv = loudest("glass", seed, 42.0, 42.05);
        assert!((2.0 * S1_MV..4.5 * S1_MV).contains(&onset_mv), "seed {seed}: {onset_mv} mV");
    }
}

#[test]
fn knocks_are_heard_and_some_are_louder_than_s1() {
    let knock_mv = loudest("knocks", 1, 9.0, 24.0);
    assert!(knock_mv > S1_MV, "{knock_mv} mV");
}
