//! Every scene that comes with the program shows what it says it shows. Each absence has its control.

use crate::common::{Reflex, run, scene};
use tenax_hal_shim::channel::{MYO_EXTENSOR, MYO_FLEXOR, by_name};
use tenax_scene::truth::Slip;
use tenax_scene::{SceneFile, Truth, builtin};

fn truth(name: &str, reflex: Reflex) -> Truth {
    run(&scene(name), 1, reflex, |_, _, _| {}).truth().clone()
}

#[test]
fn every_scene_parses_and_is_called_as_its_file() {
    for (name, text) in builtin() {
        let scene = SceneFile::parse(text, name).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.name, *name);
        assert!(!scene.title.is_empty() && !scene.from.is_empty());
    }
    assert_eq!(builtin()[0].0, "glass", "the default scene comes first");
}

#[test]
fn every_number_in_every_scene_says_where_it_is_from_at_least_once() {
    // A key that is only ever an instant, a duration or a name explains itself; every other has a comment in its file.
    let explains_itself =
        "at_s for_s until_s name base without title from channel kind intent reason duration_s";
    for (name, text) in builtin().iter().chain(builtin::parts()) {
        let lines: Vec<&str> = text.lines().filter(|line| !line.trim_start().starts_with('#')).collect();
        // `key = value`, or several of them in braces; or the key of a list of such lines, which has none of its own.
        let keys = |line: &str| {
            let code = line.split('#').next().unwrap_or_default().trim_end();
            let words = |part: &str| part.rsplit(['{', ',']).next().unwrap_or_default().trim().to_owned();
            let found: Vec<String> = code.split(" = ").map(words).collect();
            let values = usize::from(code.contains(" = "));
            let list = code.ends_with('[');
            if list { Vec::new() } else { found[..values * (found.len() - 1)].to_vec() }
        };
        for key in lines.iter().flat_map(|line| keys(line)) {
            let commented = |line: &&str| line.contains('#') && keys(line).contains(&key);
            let explained = explains_itself.split(' ').any(|own| own == key) || lines.iter().any(commented);
            assert!(explained, "{name}: `{key}` has no source");
        }
    }
}

#[test]
fn the_glass_slips_once_when_it_is_wet_and_a_reflex_on_vibration_keeps_it() {
    // Without its knocks: a bare threshold answers those too, and then grips too firmly for the wet patch to matter.
    let unknocked =
        builtin()[0].1.replace("peak_mv = 40", "peak_mv = 0").replace("peak_mv = 60", "peak_mv = 0");
    let unknocked = SceneFile::parse(&unknocked, "unknocked").unwrap();
    let kept = run(&unknocked, 1, Reflex::RatioAndVibration, |_, _, _| {}).truth().clone();
    let [slip] = kept.slips[..] else { panic!("{:?}", kept.slips) };
    assert!((42.0..42.05).contains(&slip.macro_onset_s) && !slip.meant);
    assert_eq!(slip.micro_onset_s, slip.macro_onset_s, "rigid contact has no micro slip");
    assert!(!kept.dropped && kept.slip_distance_mm < 15.0, "{} mm", kept.slip_distance_mm);
    // The wet full glass needs m g / (2 mu_s) = 0.55 * 9.81 / (2 * 0.25); swings and lifts add little.
    assert!((10.7..11.5).contains(&kept.needed_grip_n), "{} N", kept.needed_grip_n);

    let lost = truth("glass", Reflex::Ratio);
    assert!(lost.dropped, "without vibration it must fall, or the scene proves nothing");
}

#[test]
fn nothing_slips_where_nothing_should() {
    for name in ["glass-quiet", "knocks"] {
        // With S2 alone: the scene is safe, so whatever S1 answers there is its own doing.
        let truth = truth(name, Reflex::Ratio);
        assert_eq!((truth.slips.as_slice(), truth.dropped), (&[][..], false), "{name}");
    }
}

#[test]
fn the_last_swing_needs_more_than_the_wearer_gave() {
    let truth_with_ratio = truth("arm-swing", Reflex::Ratio);
    let truth = truth("arm-swing", Reflex::None);
    assert!(truth_with_ratio.slips.is_empty(), "with it, it does not");
    let first = truth.slips.first().expect("without S2 the glass slips");
    assert!(first.macro_onset_s > 20.0, "{first:?}");
}

#[test]
fn the_wearer_pair_slips_at_the_same_time_with_and_without_muscles() {
    let onset = |truth: &Truth| {
        truth.slips.iter().find(|slip| slip.macro_onset_s > 14.0).map(|slip| slip.macro_onset_s)
    };
    let (with, without) = (truth("wearer", Reflex::None), truth("wearer-control", Reflex::None));
    let at_s = onset(&with).expect("it slips");
    // The muscles do not rise in the same scan, so the hand twitches a little before.
    assert!((at_s - onset(&without).expect("it slips")).abs() < 0.002);
    let active = |truth: &Truth, channel| {
        let mut over = truth.activity.iter().filter(|a| a.channel == channel);
        over.any(|a| a.on_s < at_s && a.off_s.is_none_or(|off_s| off_s > at_s))
    };
    assert!(active(&with, MYO_FLEXOR) && active(&with, MYO_EXTENSOR));
    assert!(!active(&without, MYO_FLEXOR) && !active(&without, MYO_EXTENSOR));
    assert!(!with.dropped && !without.dropped);
}

#[test]
fn on_every_surface_and_under_every_load_it_slides_at_mu_s() {
    for (name, mu_s) in [("explore-wood", 0.5), ("explore-glass", 0.6), ("explore-card", 0.4)] {
        let truth = truth(name, Reflex::None);
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
fn dead_sensors_are_dead_from_their_instant_on() {
    let fsr_c = by_name("fsr_c").unwrap();
    let (mut before, mut after) = (f64::MAX, f64::MIN);
    run(&scene("dead-sensor"), 1, Reflex::None, |world, pins, _| {
        if world.now_s() < 12.0 {
            before = before.min(pins.0[fsr_c]);
        } else {
            after = after.max(pins.0[fsr_c]);
        }
    });
    assert!(before > 0.19, "{before} V while it works");
    assert_eq!(after, 0.0);
}

#[test]
fn a_sensor_pressed_at_boot_shows_it_from_the_first_scan_and_comes_back() {
    let fsr_a = by_name("fsr_a").unwrap();
    let (mut first, mut freed) = (None, 0.0);
    run(&scene("pressed-at-boot"), 1, Reflex::None, |world, pins, _| {
        first.get_or_insert(pins.0[fsr_a]);
        if world.now_s() < 10.5 {
            freed = pins.0[fsr_a];
        }
    });
    assert!(first.unwrap() > 0.5, "{first:?} V");
    assert!((freed - 0.2).abs() < 0.03, "{freed} V");
}

#[test]
fn a_slip_that_is_meant_is_not_counted() {
    // The wearer opens in mid-air.
    let text = builtin()[0].1.replace("at_s = 54.0", "at_s = 35.0");
    let truth = run(&SceneFile::parse(&text, "t").unwrap(), 1, Reflex::Ratio, |_, _, _| {}).truth().clone();
    let Slip { meant, macro_onset_s, .. } = truth.slips[0];
    assert!(meant && macro_onset_s > 35.0 && truth.dropped);
    assert_eq!(truth.slip_distance_mm, 0.0);
}
