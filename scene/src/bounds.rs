//! The longest stable steps, s.

/// Semi-implicit Euler on an oscillator: `(sqrt(c^2 + 4 k m) - c) / k`, which is `2 / omega` undamped.
///
/// From Jury's test of `z^2 - (2 - k dt^2/m - c dt/m) z + (1 - c dt/m)`, with damping at the old speed.
pub fn semi_implicit_oscillator_s(mass_kg: f64, stiffness_n_per_m: f64, damping_ns_per_m: f64) -> f64 {
    let square = damping_ns_per_m * damping_ns_per_m + 4.0 * stiffness_n_per_m * mass_kg;
    // The form that subtracts no two numbers that are nearly equal.
    4.0 * mass_kg / (square.sqrt() + damping_ns_per_m)
}

/// Explicit Euler on a gripper that slows under load and presses a spring: `2 F_max / (k v_max)`, from
/// `F' = k/2 v_max (duty - F / F_max)`. Beyond it a single step presses harder than the motor can.
pub fn gripper_s(force_max_n: f64, stiffness_n_per_m: f64, speed_max_m_s: f64) -> f64 {
    2.0 * force_max_n / (stiffness_n_per_m * speed_max_m_s)
}
