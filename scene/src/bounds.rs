//! Where theory says that a step stops being stable. Each bound is the longest step, s.

/// Explicit Euler on a sliding LuGre bristle: `2 g(v) / (sigma0 |v|)` (`docs/stepping.md`).
///
/// A sliding bristle forgets at the rate `sigma0 |v| / g`; the step multiplies what is left by `1 - rate dt`.
#[must_use]
pub fn explicit_bristle_s(limit_n: f64, stiffness_n_per_m: f64, slide_m_s: f64) -> f64 {
    2.0 * limit_n / (stiffness_n_per_m * slide_m_s.abs())
}

/// RK4 on a sliding LuGre bristle: where `1 - r + r^2/2 - r^3/6 + r^4/24` passes 1, r = 2.785.
#[must_use]
pub fn runge_kutta_bristle_s(limit_n: f64, stiffness_n_per_m: f64, slide_m_s: f64) -> f64 {
    const REAL_AXIS: f64 = 2.785_293_563_405_282;
    REAL_AXIS / 2.0 * explicit_bristle_s(limit_n, stiffness_n_per_m, slide_m_s)
}

/// Explicit Euler on an oscillator: `c / k` below critical damping, `2 / rate` of its fast part above. 0 undamped: it
/// then gains energy at every step.
#[must_use]
pub fn explicit_oscillator_s(mass_kg: f64, stiffness_n_per_m: f64, damping_ns_per_m: f64) -> f64 {
    let square = damping_ns_per_m * damping_ns_per_m - 4.0 * mass_kg * stiffness_n_per_m;
    if square > 0.0 {
        4.0 * mass_kg / (damping_ns_per_m + square.sqrt())
    } else {
        damping_ns_per_m / stiffness_n_per_m
    }
}

/// Semi-implicit Euler on an oscillator: `(sqrt(c^2 + 4 k m) - c) / k`, which is `2 / omega` undamped.
///
/// From Jury's test of `z^2 - (2 - k dt^2/m - c dt/m) z + (1 - c dt/m)`: damping that is taken at the old speed makes it
/// shorter, not longer.
#[must_use]
pub fn semi_implicit_oscillator_s(mass_kg: f64, stiffness_n_per_m: f64, damping_ns_per_m: f64) -> f64 {
    let square = damping_ns_per_m * damping_ns_per_m + 4.0 * stiffness_n_per_m * mass_kg;
    // The form that subtracts no two numbers that are nearly equal.
    4.0 * mass_kg / (square.sqrt() + damping_ns_per_m)
}

/// RK4 on an oscillator: the step at which `|R(lambda dt)|` passes 1, found along the ray of its eigenvalue.
#[must_use]
pub fn runge_kutta_oscillator_s(mass_kg: f64, stiffness_n_per_m: f64, damping_ns_per_m: f64) -> f64 {
    let omega_rad_s = (stiffness_n_per_m / mass_kg).sqrt();
    let damping = (damping_ns_per_m / (2.0 * mass_kg * omega_rad_s)).min(1.0);
    let (re, im) = (-damping, (1.0 - damping * damping).sqrt());
    // Undamped, the first part of the ray grazes the edge: rounding must not end it there.
    let stable = |length: f64| runge_kutta_factor(re * length, im * length) <= 1.0 + 1e-12;
    const FINE: f64 = 1e-3;
    let mut steps = 1_u32;
    while stable(f64::from(steps) * FINE) {
        steps += 1;
    }
    f64::from(steps) * FINE / omega_rad_s
}

/// |1 + z + z^2/2 + z^3/6 + z^4/24|, by Horner.
fn runge_kutta_factor(re: f64, im: f64) -> f64 {
    let (mut a, mut b) = (1.0, 0.0);
    for divisor in [4.0, 3.0, 2.0, 1.0] {
        (a, b) = (1.0 + (a * re - b * im) / divisor, (a * im + b * re) / divisor);
    }
    (a * a + b * b).sqrt()
}

/// Explicit Euler on a gripper that slows under load and presses a spring: `2 F_max / (k v_max)`, 1 over the rate at
/// which the force nears its stall.
///
/// `F' = k/2 v_max (duty - F / F_max)`, as the two fingers share the change of the opening. The gear does not run back, so
/// nothing can swing; beyond the bound a single step presses harder than the motor can, and stays there.
#[must_use]
pub fn gripper_s(force_max_n: f64, stiffness_n_per_m: f64, speed_max_m_s: f64) -> f64 {
    2.0 * force_max_n / (stiffness_n_per_m * speed_max_m_s)
}
