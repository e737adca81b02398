//! The slider under friction that falls with speed. Growth: `lab/src/photoelastic/region.rs`.

use proptest::prelude::*;
use tenax_scene::physics::stribeck::{BLOCK_N, Slider, Stribeck, StribeckSlider};
use tenax_scene::sensor::photoelastic::HEAD_STRIP;
use tenax_scene::stepping::SHIPPED_S;

#[test]
fn a_slider_that_sticks_to_a_surface_at_rest_stays() {
    let mut slider = StribeckSlider::new(HEAD_STRIP).with_motion(2e-5, 0.0);
    for _ in 0..80_000 {
        slider.step(BLOCK_N, 0.0, SHIPPED_S);
    }
    assert_eq!((slider.position_m(), slider.speed_m_s()), (2e-5, 0.0));
}

proptest! {
    #[test]
    fn over_a_surface_at_rest_friction_only_takes(
        mu_d in 0.05..1.0, excess in 0.0..0.5, normal_n in 0.0..20.0,
        position_m in -1e-3..1e-3, speed_m_s in -0.1..0.1,
    ) {
        let friction = Stribeck { mu_s: mu_d + excess, mu_d, speed_m_s: 1e-3 };
        let free = Slider { stiffness_n_per_m: 1e-9, damping_ns_per_m: 0.0, friction, ..HEAD_STRIP };
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
