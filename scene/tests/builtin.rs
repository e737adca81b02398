//! Every scene that comes with the program shows what it says it shows. Each absence has its control.

use crate::common::{Reflex, changed, run, scene, truth};
use tenax_hal_shim::channel::{CHANNELS, MYO_EXTENSOR, MYO_FLEXOR, by_name};
use tenax_scene::{SceneFile, Truth, builtin};

#[test]
fn every_scene_parses_and_is_called_as_its_file() {
    for (name, text) in builtin() {
        let scene = SceneFile::parse(text, name).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.name, *name);
        assert!(!scene.title.is_empty() && !scene.from.is_empty());
    }
    assert_eq!(builtin()[0].0, "glass", "the default scene comes first");
}

/// Without its knocks, so that nothing else closes the fingers.
#[test]
fn the_glass_slips_when_it_is_wet_and_falls_unless_vibration_is_answered() {
    let lost = truth(
        &changed("glass", &[("peak_mv = 40", "peak_mv = 0"), ("peak_mv = 60", "peak_mv = 0")]),
        Reflex::Ratio,
    );
    let slip = lost.slips[0];
    assert!((42.0..42.05).contains(&slip.macro_onset_s) && !slip.meant);
    assert_eq!(slip.micro_onset_s, slip.macro_onset_s, "rigid contact has no micro slip");
    // The wet full glass needs m g / (2 mu_s) = 0.55 * 9.81 / (2 * 0.25); swings and lifts add little.
    assert!((10.7..11.5).contains(&lost.needed_grip_n), "{} N", lost.needed_grip_n);
    assert!(lost.dropped);
}

#[test]
fn nothing_slips_where_nothing_should_and_the_last_swing_needs_more_than_the_wearer_gave() {
    for name in ["glass-quiet", "knocks", "arm-swing"] {
        let truth = truth(&scene(name), Reflex::Ratio);
        assert_eq!((truth.slips.as_slice(), truth.dropped), (&[][..], false), "{name}");
    }
    let slips = truth(&scene("arm-swing"), Reflex::None).slips;
    assert!(slips.first().is_some_and(|slip| slip.macro_onset_s > 20.0), "the control: {slips:?}");
}

#[test]
fn the_wearer_pair_slips_at_the_same_time_with_and_without_muscles() {
    let onset = |truth: &Truth| {
        let mut onsets = truth.slips.iter().map(|slip| slip.macro_onset_s);
        onsets.find(|&onset_s| onset_s > 14.0).expect("it slips")
    };
    // Whether each muscle is active when it slips.
    let ran = |name| {
        let mut active = None;
        let world = run(&scene(name), Reflex::None, |world, pins| {
            if world.truth().slips.iter().any(|slip| slip.macro_onset_s > 14.0) {
                let above_mv = |channel: usize| pins.0[channel] * 1e3 - f64::from(CHANNELS[channel].rest_mv);
                active.get_or_insert([MYO_FLEXOR, MYO_EXTENSOR].map(|channel| above_mv(channel) > 160.0));
            }
        });
        (world.truth().clone(), active)
    };
    let [(with, with_active), (without, without_active)] = ["wearer", "wearer-control"].map(ran);
    // The muscles do not rise in the same scan, so the hand twitches a little before.
    assert!((onset(&with) - onset(&without)).abs() < 0.002);
    assert_eq!((with_active, without_active), (Some([true; 2]), Some([false; 2])));
    assert!(!with.dropped && !without.dropped);
}

#[test]
fn on_every_surface_and_under_every_load_it_slides_at_mu_s() {
    for (name, mu_s) in [("explore-wood", 0.5), ("explore-glass", 0.6), ("explore-card", 0.4)] {
        let truth = truth(&scene(name), Reflex::None);
        for load_n in [2.0, 4.0, 8.0] {
            let full = truth.trace.iter().filter(|row| (row.grip_n - load_n).abs() < 1e-6);
            let peak = full.map(|row| row.shear_n / row.grip_n).fold(0.0, f64::max);
            assert!((mu_s - 0.03..=mu_s).contains(&peak), "{name} under {load_n} N: {peak}");
        }
        // Two losses of contact in each of three strokes.
        let touched: Vec<bool> = truth.trace.iter().map(|row| row.grip_n > 0.05).collect();
        assert_eq!(touched.windows(2).filter(|pair| pair[0] && !pair[1]).count(), 9, "{name}");
    }
}

#[test]
fn a_fault_is_on_its_pin_from_its_first_instant_to_its_last() {
    let pin = |name: &str, channel: &str, at_s: f64| {
        let (channel, mut found_v) = (by_name(channel).unwrap(), f64::NAN);
        run(&scene(name), Reflex::None, |world, pins| {
            if world.now_s() <= at_s {
                found_v = pins.0[channel];
            }
        });
        found_v
    };
    assert!(pin("dead-sensor", "fsr_c", 11.9) > 0.19, "while it works");
    assert_eq!([12.1, 20.0].map(|at_s| pin("dead-sensor", "fsr_c", at_s)), [0.0; 2]);
    assert!(pin("pressed-at-boot", "fsr_a", 0.001) > 0.5);
    assert!((pin("pressed-at-boot", "fsr_a", 10.4) - 0.2).abs() < 0.03, "it comes back");
}

#[test]
fn a_slip_that_is_meant_is_not_counted() {
    // The wearer opens in mid-air.
    let truth = truth(&changed("glass", &[("at_s = 54.0", "at_s = 35.0")]), Reflex::Ratio);
    assert!(truth.slips[0].meant && truth.slips[0].macro_onset_s > 35.0 && truth.dropped);
    assert_eq!(truth.slip_distance_mm, 0.0);
}
