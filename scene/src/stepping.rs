//! The step of every scene, and the Stribeck slider, a hair away from sliding evenly, to measure it with.

use crate::physics::stribeck::{Slider, StribeckSlider};

pub const SHIPPED_S: f64 = crate::schedule::STEP_S;

const DEVIATION_M: f64 = 1e-13;
/// Watched for so many swings.
const SWINGS: usize = 5;

/// Growth of a small deviation from even sliding at `surface_m_s` under `normal_n`, 1/s. Above 0 the slider vibrates by itself. None if
/// it does not swing.
pub fn growth_per_s(slider: Slider, normal_n: f64, surface_m_s: f64) -> Option<f64> {
    let even_m = slider.friction.mu(surface_m_s) * normal_n / slider.stiffness_n_per_m;
    let omega_rad_s = (slider.stiffness_n_per_m / slider.mass_kg).sqrt();
    // Twice as long as the undamped slider would take.
    let steps = (2.0 * (SWINGS + 1) as f64 * std::f64::consts::TAU / omega_rad_s / SHIPPED_S) as usize;
    let mut slider = StribeckSlider::new(slider).with_motion(even_m + DEVIATION_M, 0.0);
    let (mut before_m, mut before_m_s) = (DEVIATION_M, 0.0);
    // Instant and speed of each rise through even sliding.
    let mut rises = Vec::new();
    for n in 1..=steps {
        slider.step(normal_n, surface_m_s, SHIPPED_S);
        let (at_m, at_m_s) = (slider.position_m() - even_m, slider.speed_m_s());
        if before_m <= 0.0 && at_m > 0.0 {
            let part = at_m / (at_m - before_m);
            rises.push(((n as f64 - part) * SHIPPED_S, at_m_s + part * (before_m_s - at_m_s)));
        }
        (before_m, before_m_s) = (at_m, at_m_s);
        if rises.len() > SWINGS {
            break;
        }
    }
    let (first, last) = (rises.first()?, rises.last()?);
    (rises.len() > 1).then(|| libm::log(last.1 / first.1) / (last.0 - first.0))
}
