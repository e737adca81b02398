//! L2 against the linearised equation.

use proptest::prelude::*;
use tenax_scene::physics::stribeck::{BLOCK_N, METAL, STRIP, Slider, Stribeck, StribeckSlider};
use tenax_scene::stepping::{SHIPPED_S, SelfExcited};

#[test]
fn growth_and_frequency_are_the_linearised_ones_and_growth_begins_where_c_plus_p_slope_is_negative() {
    // The sliding speed at which `c + P dmu/dv = 0`, m/s.
    let steepest = BLOCK_N * (METAL.mu_s - METAL.mu_d) / METAL.speed_m_s;
    let critical_m_s = METAL.speed_m_s * (steepest / STRIP.damping_ns_per_m).ln();
    for part in [0.8, 0.9, 0.99, 1.01, 1.1, 1.3, 1.6] {
        let surface_m_s = part * critical_m_s;
        let theory = STRIP.small_signal(BLOCK_N, surface_m_s);
        let scene = SelfExcited { slider: STRIP, normal_n: BLOCK_N, surface_m_s };
        let measured = scene.measured(SHIPPED_S).expect("it swings");
        assert_eq!(measured.growth_per_s > 0.0, part < 1.0, "{part}: {measured:?}");
        let omega = measured.omega_rad_s / theory.omega_rad_s;
        assert!((omega - 1.0).abs() < 0.02, "{part}: {omega}");
        if !(0.95..1.05).contains(&part) {
            let growth = measured.growth_per_s / theory.growth_per_s;
            assert!((growth - 1.0).abs() < 0.02, "{part}: {growth}");
        }
    }
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
        let friction = Stribeck { mu_s: mu_d + excess, mu_d, speed_m_s: 1e-3 };
        let free = Slider { stiffness_n_per_m: 1e-9, damping_ns_per_m: 0.0, friction, ..STRIP };
        let mut slider = StribeckSlider::new(free).with_motion(position_m, speed_m_s);
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
