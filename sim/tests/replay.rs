//! A recording at the pins: on the right channel, at the right time, through the right front end. What the shared recordings
//! must and must not set off is judged by `tenax check`.

use std::collections::BTreeSet;

use crate::common::{recipe, recording};
use tenax_hal_shim::channel::{self, COUNT, SCAN_HZ};
use tenax_hal_shim::front_end::fsr_mv;
use tenax_hal_shim::motor::MotorDrive;
use tenax_scene::plant::{Pins, Plant};
use tenax_sim::replay::ReplayPlant;

const NOISE_V: f64 = 0.003;

fn pins(mut plant: ReplayPlant) -> Vec<[f64; COUNT]> {
    let scans = (plant.duration_s() * f64::from(SCAN_HZ)).round() as usize;
    (0..scans).map(|_| plant.scan(MotorDrive::Coast).0).collect()
}

fn channel(name: &str) -> usize {
    channel::by_name(name).unwrap()
}

fn near(volts: f64, expected: f64) -> bool {
    (volts - expected).abs() < NOISE_V
}

#[test]
fn columns_that_are_channels_need_no_recipe() {
    let recording = recording("t,pvdf_2,opening\n0,1.0,0.5\n0.1,2.0,0.5\n");
    let plant = ReplayPlant::plain(&recording, 1).unwrap();
    assert!((plant.time_zero_s() + 1.0).abs() < 1e-12, "one second of the first row before");
    let pins = pins(plant);
    let at = |t: f64| pins[((t + 1.0) * f64::from(SCAN_HZ)).round() as usize];
    let pvdf = channel("pvdf_2");
    for (t, volts) in [(-0.5, 1.0), (0.0, 1.0), (0.025, 1.25), (0.0999, 1.999), (0.15, 2.0)] {
        assert!(near(at(t)[pvdf], volts), "{} V at {t} s", at(t)[pvdf]);
    }
    assert!(near(at(0.05)[channel("opening")], 0.5));
    assert!(near(at(0.05)[channel("myo_flexor")], 0.3), "missing channels rest");
}

#[test]
fn a_column_that_is_no_channel_is_named() {
    let error = ReplayPlant::plain(&recording("t,pdvf_2\n0,1\n1,1\n"), 1).unwrap_err().to_string();
    assert!(error.starts_with("r.csv:1: column `pdvf_2` is no channel"), "{error}");
}

#[test]
fn the_stages_of_a_front_end_act_in_their_order() {
    let recording = recording("t,a\n0,11\n0.5,7\n1,11\n");
    let recipe = recipe(
        "lead_in_s = 0.0\nlead_out_s = 0.0\n[[map]]\ncolumn = 'a'\nchannels = ['pvdf_1', 'myo_flexor']\n\
         remove_offset = { value = 10.0 }\nrectify = true\ngain = 0.5\nclip_v = [0.05, 2.0]\n",
    );
    let pins = pins(ReplayPlant::new(&recording, &recipe, 1).unwrap());
    // At 0.5 s the column is 3 below its offset; rectified and amplified that is 1.5 V above rest.
    assert!(near(pins[4_000][channel("pvdf_1")], 2.0), "1.65 V + 1.5 V, clipped");
    assert!(near(pins[4_000][channel("myo_flexor")], 0.3 + 1.5));
    assert!(near(pins[0][channel("myo_flexor")], 0.3 + 0.5));
}

#[test]
fn forces_press_the_four_quadrants() {
    let recording = recording("t,n,s\n0,2,0.5\n1,2,0.5\n");
    let recipe = recipe("lead_in_s = 0.0\n[force]\nnormal = 'n'\nshear_x = 's'\nscale = 2.0\n");
    let pins = pins(ReplayPlant::new(&recording, &recipe, 1).unwrap());
    for (name, force_n) in [("fsr_a", 1.25), ("fsr_b", 1.25), ("fsr_c", 0.75), ("fsr_d", 0.75)] {
        let expected = fsr_mv(force_n, f64::powf) / 1e3;
        assert!(
            near(pins[100][channel(name)], expected),
            "{name}: {} V, {expected}",
            pins[100][channel(name)]
        );
    }
}

#[test]
fn a_held_force_comes_on_after_the_board() {
    let recording = recording("t,a\n0,0\n1,0\n");
    let recipe = recipe(
        "[[map]]\ncolumn = 'a'\nchannels = ['pvdf_1']\ngain = 1.0\n\
         [hold.force]\nnormal_n = 4.0\nafter_s = 0.25\nramp_s = 0.5\nwhy = 'a test'\n",
    );
    let pins = pins(ReplayPlant::new(&recording, &recipe, 1).unwrap());
    let fsr = channel("fsr_c");
    assert!(near(pins[1_900][fsr], fsr_mv(0.0, f64::powf) / 1e3));
    assert!(near(pins[4_000][fsr], fsr_mv(0.5, f64::powf) / 1e3));
    assert!(near(pins[6_100][fsr], fsr_mv(1.0, f64::powf) / 1e3));
}

#[test]
fn a_pin_at_rest_is_never_quite_still_and_the_same_seed_gives_the_same_noise() {
    let recording = recording("t,pvdf_1\n0,1.65\n0.1,1.65\n");
    let pins = |seed| pins(ReplayPlant::plain(&recording, seed).unwrap());
    assert_eq!(pins(7), pins(7));
    assert_ne!(pins(7), pins(8));
    let fsr = |volts: &[f64; COUNT]| Pins(*volts).codes()[channel("fsr_a")];
    let codes: BTreeSet<u16> = pins(1).iter().map(fsr).collect();
    assert!(codes.len() > 1, "one code for ever would be a broken sensor");
}
