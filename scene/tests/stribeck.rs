//! L2 against the linearised equation, and what the levels below get wrong without it.

use proptest::prelude::*;
use tenax_scene::physics::brush::{BrushPatch, ELEMENTS, Pad};
use tenax_scene::physics::contact::RigidCoulomb;
use tenax_scene::physics::friction::Friction;
use tenax_scene::physics::stribeck::{BLOCK_N, METAL, STRIP, Slider, Stribeck, StribeckSlider};
use tenax_scene::stepping::{SHIPPED_S, SelfExcited};

/// The sliding speed at which `c + P dmu/dv = 0`, m/s.
fn critical_m_s() -> f64 {
    let steepest = BLOCK_N * (METAL.mu_s - METAL.mu_d) / METAL.speed_m_s;
    METAL.speed_m_s * (steepest / STRIP.damping_ns_per_m).ln()
}

#[test]
fn growth_and_frequency_are_the_linearised_ones_within_2_percent() {
    for part in [0.8, 0.9, 1.1, 1.3, 1.6] {
        let surface_m_s = part * critical_m_s();
        let theory = STRIP.small_signal(BLOCK_N, surface_m_s);
        let scene = SelfExcited { slider: STRIP, normal_n: BLOCK_N, surface_m_s };
        let measured = scene.measured(SHIPPED_S).expect("it swings");
        let growth = measured.growth_per_s / theory.growth_per_s;
        let omega = measured.omega_rad_s / theory.omega_rad_s;
        assert!((growth - 1.0).abs() < 0.02 && (omega - 1.0).abs() < 0.02, "{part}: {growth}, {omega}");
    }
}

#[test]
fn it_vibrates_by_itself_exactly_when_c_plus_p_slope_is_negative() {
    for (part, grows) in [(0.99, true), (1.01, false)] {
        let scene = SelfExcited { slider: STRIP, normal_n: BLOCK_N, surface_m_s: part * critical_m_s() };
        let measured = scene.measured(SHIPPED_S).expect("it swings");
        assert_eq!(measured.growth_per_s > 0.0, grows, "{part}: {measured:?}");
    }
}

/// Half the way between the extremes of the strip's deflection in the last quarter of a second, m.
fn vibration_m(mut deflection_m: impl FnMut() -> f64) -> f64 {
    let (mut low_m, mut high_m) = (f64::INFINITY, f64::NEG_INFINITY);
    for n in 0..8_000 {
        let at_m = deflection_m();
        if n >= 6_000 {
            (low_m, high_m) = (low_m.min(at_m), high_m.max(at_m));
        }
    }
    (high_m - low_m) / 2.0
}

fn stribeck_m(friction: Stribeck, surface_m_s: f64) -> f64 {
    let mut slider = StribeckSlider::new(Slider { friction, ..STRIP });
    vibration_m(|| {
        slider.step(BLOCK_N, surface_m_s, SHIPPED_S);
        slider.position_m()
    })
}

/// The strip, rubbed by the level that `shear_n` is: given free speed over the surface, and the step.
fn constant_friction_m(surface_m_s: f64, mut speed_m_s_after: impl FnMut(f64) -> f64) -> f64 {
    // It begins a little off even sliding, and moving with it: a vibration that would live is given its chance.
    let mut position_m = METAL.mu_d * BLOCK_N / STRIP.stiffness_n_per_m + 1e-6;
    let mut speed_m_s = 0.0;
    vibration_m(|| {
        let pull_n = -STRIP.stiffness_n_per_m * position_m - STRIP.damping_ns_per_m * speed_m_s;
        let free_m_s = speed_m_s + pull_n / STRIP.mass_kg * SHIPPED_S;
        speed_m_s = speed_m_s_after(free_m_s - surface_m_s) + surface_m_s;
        position_m += speed_m_s * SHIPPED_S;
        position_m
    })
}

/// Dubey 2006, section 4: a continuous signal during slip, larger at 3 mm/s than at 0.1, and larger on metal.
#[test]
fn only_l2_has_a_signal_that_lasts_as_long_as_the_slip() {
    let surface_m_s = 0.003;
    let friction = Friction { mu_s: METAL.mu_s, mu_d: METAL.mu_d };
    let lasting_m = stribeck_m(METAL, surface_m_s);
    assert!(lasting_m > 2e-6, "{lasting_m} m");

    let mut rigid = RigidCoulomb::default();
    // Sliding already: its first step is beyond what sticking could hold.
    let _ = rigid.step(0.0, friction, STRIP.mass_kg, -surface_m_s, SHIPPED_S);
    let rigid_m = constant_friction_m(surface_m_s, |free_m_s| {
        rigid.step(BLOCK_N, friction, STRIP.mass_kg, free_m_s, SHIPPED_S).speed_m_s
    });
    assert!(rigid_m < 1e-3 * lasting_m, "L0: {rigid_m} m");

    let mut patch = BrushPatch::new(Pad { radius_m: 0.003, stiffness_n_per_m3: 2.55e8 }, ELEMENTS);
    // Sliding already: dragged until all of it does.
    let mut shear_n = patch.step(BLOCK_N, friction, -1e-3).shear_n;
    let patch_m = constant_friction_m(surface_m_s, |free_m_s| {
        let slide_m_s = free_m_s - shear_n / STRIP.mass_kg * SHIPPED_S;
        shear_n = patch.step(BLOCK_N, friction, slide_m_s * SHIPPED_S).shear_n;
        slide_m_s
    });
    assert!(patch_m < 1e-3 * lasting_m, "L1: {patch_m} m");
}

/// The strip's speed, rms, once it has settled, m/s: what an output that is coupled through a capacitor follows. Its way
/// hardly depends on the sliding speed, as what it sheds in a slip does not.
fn signal_m_s(friction: Stribeck, surface_m_s: f64) -> f64 {
    let even_m = friction.mu(surface_m_s) * BLOCK_N / STRIP.stiffness_n_per_m;
    let mut slider = StribeckSlider::new(Slider { friction, ..STRIP }).with_motion(even_m, 1e-6);
    let mut squares = 0.0;
    for n in 0..16_000 {
        slider.step(BLOCK_N, surface_m_s, SHIPPED_S);
        if n >= 8_000 {
            squares += slider.speed_m_s().powi(2);
        }
    }
    (squares / 8_000.0).sqrt()
}

#[test]
fn the_signal_is_larger_on_metal_and_grows_with_speed() {
    // Plastic's friction falls less with speed; too little for the strip's damping. Assumed.
    let plastic = Stribeck { mu_s: 0.31, ..METAL };
    assert!(signal_m_s(plastic, 0.003) < 1e-3 * signal_m_s(METAL, 0.003));
    // From Dubey's slowest to its fastest.
    let signals = [0.0001, 0.0003, 0.001, 0.003].map(|surface_m_s| signal_m_s(METAL, surface_m_s));
    assert!(signals[0] > 0.0 && signals.windows(2).all(|pair| pair[1] > 1.3 * pair[0]), "{signals:?}");
}

#[test]
fn a_slider_that_sticks_to_a_surface_at_rest_stays() {
    let mut slider = StribeckSlider::new(STRIP).with_motion(1e-4, 0.0);
    for _ in 0..80_000 {
        slider.step(BLOCK_N, 0.0, SHIPPED_S);
    }
    assert_eq!((slider.position_m(), slider.speed_m_s()), (1e-4, 0.0));
}

proptest! {
    #[test]
    fn over_a_surface_at_rest_friction_only_takes(
        mu_d in 0.05..1.0, excess in 0.0..0.5, normal_n in 0.0..20.0,
        position_m in -1e-3..1e-3, speed_m_s in -0.1..0.1,
    ) {
        let free = Slider { stiffness_n_per_m: 1e-9, damping_ns_per_m: 0.0, ..STRIP };
        let friction = Stribeck { mu_s: mu_d + excess, mu_d, speed_m_s: 1e-3 };
        let mut slider = StribeckSlider::new(Slider { friction, ..free }).with_motion(position_m, speed_m_s);
        let mut before_m_s = speed_m_s;
        for _ in 0..50 {
            slider.step(normal_n, 0.0, SHIPPED_S);
            let after_m_s = slider.speed_m_s();
            // The spring of the free slider is too weak to turn it: less than 1e-9 m/s in all.
            prop_assert!(after_m_s.abs() <= before_m_s.abs() + 1e-9);
            before_m_s = after_m_s;
        }
    }
}
