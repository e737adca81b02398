//! The step of every scene, and the Stribeck slider, a hair away from sliding evenly, to measure it with.

use crate::physics::stribeck::{Slider, SmallSignal, StribeckSlider};

pub const SHIPPED_S: f64 = crate::schedule::STEP_S;

/// Measures how a small deviation from even sliding grows and how fast it swings, as [`StribeckSlider`] steps it: to be
/// held against [`Slider::small_signal`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfExcited {
    pub slider: Slider,
    pub normal_n: f64,
    pub surface_m_s: f64,
}

const DEVIATION_M: f64 = 1e-13;
/// Watched for so many swings.
const SWINGS: usize = 5;

impl SelfExcited {
    pub fn measured(&self, dt_s: f64) -> Option<SmallSignal> {
        let friction_n = self.slider.friction.mu(self.surface_m_s) * self.normal_n;
        let even_m = friction_n / self.slider.stiffness_n_per_m;
        let mut slider = StribeckSlider::new(self.slider).with_motion(even_m + DEVIATION_M, 0.0);
        let omega_rad_s = (self.slider.stiffness_n_per_m / self.slider.mass_kg).sqrt();
        // Twice as long as the undamped slider would take.
        let steps = (2.0 * (SWINGS + 1) as f64 * std::f64::consts::TAU / omega_rad_s / dt_s) as usize;
        let (mut before_m, mut before_m_s) = (DEVIATION_M, 0.0);
        let mut crossings = Vec::new();
        for n in 1..=steps {
            slider.step(self.normal_n, self.surface_m_s, dt_s);
            let (at_m, at_m_s) = (slider.position_m() - even_m, slider.speed_m_s());
            if before_m <= 0.0 && at_m > 0.0 {
                let part = at_m / (at_m - before_m);
                crossings.push(((n as f64 - part) * dt_s, at_m_s + part * (before_m_s - at_m_s)));
            }
            (before_m, before_m_s) = (at_m, at_m_s);
            if crossings.len() > SWINGS {
                break;
            }
        }
        let (first, last) = (crossings.first()?, crossings.last()?);
        let for_s = last.0 - first.0;
        let swings = (crossings.len() - 1) as f64;
        (swings > 0.0).then(|| SmallSignal {
            growth_per_s: libm::log(last.1 / first.1) / for_s,
            omega_rad_s: std::f64::consts::TAU * swings / for_s,
        })
    }
}
