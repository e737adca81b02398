//! Friction that falls with speed, under a mass on a spring.
//!
//! The mass vibrates by itself exactly when `c + P dmu/dv < 0` at the sliding speed. That vibration is the continuous signal of the
//! photoelastic sensor (Dubey 2006, section 3).

use super::GRAVITY_M_S2;

/// mu(v) = mu_d + (mu_s - mu_d) exp(-v / v_s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stribeck {
    pub mu_s: f64,
    /// At high speed. At most `mu_s`.
    pub mu_d: f64,
    pub speed_m_s: f64,
}

impl Stribeck {
    pub fn mu(&self, slide_m_s: f64) -> f64 {
        self.mu_d + (self.mu_s - self.mu_d) * libm::exp(-slide_m_s.abs() / self.speed_m_s)
    }

    /// dmu/dv at a sliding speed, s/m: never positive.
    pub fn slope_s_m(&self, slide_m_s: f64) -> f64 {
        (self.mu_d - self.mu(slide_m_s)) / self.speed_m_s
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slider {
    pub mass_kg: f64,
    pub stiffness_n_per_m: f64,
    pub damping_ns_per_m: f64,
    pub friction: Stribeck,
}

impl Slider {
    /// The longest inner step that keeps the growth rate within 1 % and the frequency within 0.2 %, s.
    ///
    /// The step multiplies an amplitude by `sqrt(1 - D)` with `D = dt (c + P dmu/dv) / m`, which is exp(growth dt) but
    /// for a part `D/2`, and has the frequency `omega (1 + (omega dt)^2 / 24)`. Both are held at the steepest slope.
    fn inner_step_s(&self, normal_n: f64) -> f64 {
        let steepest_ns_per_m = self.damping_ns_per_m - normal_n * self.friction.slope_s_m(0.0);
        let omega_rad_s = (self.stiffness_n_per_m / self.mass_kg).sqrt();
        (0.02 * self.mass_kg / steepest_ns_per_m).min(0.2 / omega_rad_s)
    }
}

/// The longest inner step is cut no further than this: a slider that wants more is too light for its friction, and what
/// it does between two scans is no longer resolved. It stays stable.
const INNER_STEPS_MAX: f64 = 1_000.0;

#[derive(Clone, Debug, PartialEq)]
pub struct StribeckSlider {
    slider: Slider,
    position_m: f64,
    speed_m_s: f64,
}

impl StribeckSlider {
    pub const fn new(slider: Slider) -> Self {
        Self { slider, position_m: 0.0, speed_m_s: 0.0 }
    }

    pub const fn with_motion(mut self, position_m: f64, speed_m_s: f64) -> Self {
        self.position_m = position_m;
        self.speed_m_s = speed_m_s;
        self
    }

    /// Goes on by `dt_s` over a surface that moves at `surface_m_s`, pressed with `normal_n`.
    ///
    /// Inside, a Moreau step with mu taken at the speed before it; as many as the accuracy needs. It sticks exactly:
    /// the slider then has the speed of the surface, not nearly.
    pub fn step(&mut self, normal_n: f64, surface_m_s: f64, dt_s: f64) {
        let normal_n = normal_n.max(0.0);
        let count = (dt_s / self.slider.inner_step_s(normal_n)).ceil().clamp(1.0, INNER_STEPS_MAX);
        for _ in 0..count as u32 {
            self.inner(normal_n, surface_m_s, dt_s / count);
        }
    }

    fn inner(&mut self, normal_n: f64, surface_m_s: f64, dt_s: f64) {
        let Slider { mass_kg, stiffness_n_per_m, damping_ns_per_m, friction } = self.slider;
        let pull_n = -stiffness_n_per_m * self.position_m - damping_ns_per_m * self.speed_m_s;
        let free_m_s = self.speed_m_s + pull_n / mass_kg * dt_s;
        let stopping_ns = mass_kg * (surface_m_s - free_m_s);
        let limit_ns = friction.mu(self.speed_m_s - surface_m_s) * normal_n * dt_s;
        self.speed_m_s = if stopping_ns.abs() <= limit_ns {
            surface_m_s
        } else {
            free_m_s + limit_ns.copysign(stopping_ns) / mass_kg
        };
        self.position_m += self.speed_m_s * dt_s;
    }

    pub const fn position_m(&self) -> f64 {
        self.position_m
    }

    pub const fn speed_m_s(&self) -> f64 {
        self.speed_m_s
    }
}

/// Metal on the metal strip of Dubey 2006. Assumed.
pub const METAL: Stribeck = Stribeck { mu_s: 0.35, mu_d: 0.30, speed_m_s: 0.003 };

/// Plastic on the metal strip. Assumed: friction falls less than on metal ("higher in metal-metal contacts", section 6).
pub const PLASTIC: Stribeck = Stribeck { mu_s: 0.30, mu_d: 0.27, speed_m_s: 0.003 };

pub const BLOCK_N: f64 = 0.105 * GRAVITY_M_S2;
