//! Constants of the analogue front ends between sensors and pins: the logic turns volts into newtons with them, a scene or a recording's
//! recipe newtons into volts. Every sensor has a live zero: at rest its pin is well above 0 V, so that a cut wire is noticed.

/// PVDF: voltage at rest, the middle of the supply, mV.
pub const PVDF_REST_MV: u32 = 1_650;
/// PVDF: voltage while the wire to the film is cut, mV: the film's end of the wire has a bias (docs/hardware.md).
pub const PVDF_CUT_MV: u32 = 1_550;

/// FSR: voltage of an unloaded quadrant, mV.
pub const FSR_REST_MV: u32 = 200;
/// FSR: voltage above rest of a quadrant under 1 N, mV (assumed: a 10 kohm-class divider behind a buffer).
pub const FSR_MV_AT_1N: f64 = 180.0;
/// FSR: exponent of the power law between force and conductance (Interlink's guide: close to 1 above the turn-on force; 0.9 assumed).
pub const FSR_EXPONENT: f64 = 0.9;

/// FSR: voltage at the pin of a quadrant under `force_n` newtons, mV, before the converter clips it.
/// `powf` is not in `core`, so the caller passes it: `f64::powf` on a PC.
pub fn fsr_mv(force_n: f64, powf: fn(f64, f64) -> f64) -> f64 {
    f64::from(FSR_REST_MV) + FSR_MV_AT_1N * powf(force_n.max(0.0), FSR_EXPONENT)
}

/// Difference between opposite pairs of quadrants for 1 N of shear at the top of the rubber cylinder, N
/// (Prosthesis, figure 1; the cylinder's height over the lever arm of the quadrants, assumed).
pub const FSR_TILT: f64 = 1.0;

/// Forces on quadrants A, B, C and D, N, under a normal force and a shear at the tilting element. The signs are those of the paper's
/// formulas: `Fx = (A + B) - (C + D)`, `Fy = (A + D) - (C + B)`. A quadrant cannot pull: where the tilt would lift one, it reads zero.
pub fn fsr_quadrants_n(normal_n: f64, shear_x_n: f64, shear_y_n: f64) -> [f64; 4] {
    let even = normal_n / 4.0;
    let x = FSR_TILT * shear_x_n / 4.0;
    let y = FSR_TILT * shear_y_n / 4.0;
    [even + x + y, even + x - y, even - x - y, even - x + y].map(|force| force.max(0.0))
}

/// Myoelectric envelope of a relaxed muscle, mV.
pub const MYO_REST_MV: u32 = 300;

/// Sensitivity of the motor's current channel, mV per A: the bridge's current mirror rises by this above its voltage at
/// rest (docs/hardware.md).
pub const MOTOR_MV_PER_A: u32 = 2_400;
