//! Mains in an envelope: a spectrum of 0.8 s, outside the tick. At 80 readings a second the lines fold: 50 Hz
//! to 30, 100 to 20, 200 to 40; 60 Hz to 20, 120 to 40, 180 to 20. A muscle's envelope lies below 10 Hz.

/// Readings in a window, one a slow frame: 0.8 s, bins of 1.25 Hz.
pub const WINDOW: usize = 64;
pub const UNIT_UV: i32 = 128;
const LINES: [bool; WINDOW / 2] = {
    let mut lines = [false; WINDOW / 2];
    let mut n = 0;
    while n < 3 {
        lines[15 + n] = true;
        lines[23 + n] = true;
        n += 1;
    }
    lines[31] = true;
    lines
};
const FIRST_BIN: usize = 4;
/// Least amplitude of a mains line, uV: four times what the noise of a pin makes.
const LEAST_LINE_UV: u32 = 400;
/// Least share of the alternating power above 5 Hz, per mille. White noise has 230.
const LEAST_SHARE_PERMILLE: u16 = 600;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mains {
    pub line_uv: u32,
    pub share_permille: u16,
}

impl Mains {
    pub const fn is_heard(self) -> bool {
        self.line_uv >= LEAST_LINE_UV && self.share_permille >= LEAST_SHARE_PERMILLE
    }
}

/// About 4000 instructions: for the thread, not the tick.
pub fn mains_of(window: &[i16; WINDOW]) -> Mains {
    // A straight line is no vibration: without it, a contraction that begins fills every bin.
    let mean = window.iter().map(|&v| f32::from(v)).sum::<f32>() / WINDOW as f32;
    let from_centre = |n: usize| n as f32 - (WINDOW as f32 - 1.0) / 2.0;
    let (mut product, mut square) = (0.0, 0.0);
    for (n, &value) in window.iter().enumerate() {
        product += from_centre(n) * f32::from(value);
        square += from_centre(n) * from_centre(n);
    }
    let slope = product / square;
    let mut values = [0.0; WINDOW];
    for (n, (out, &value)) in values.iter_mut().zip(window).enumerate() {
        *out = (f32::from(value) - mean - slope * from_centre(n)) * HANN[n];
    }
    let bins = microfft::real::rfft_64(&mut values);
    let (mut lines, mut all) = (0.0, 0.0);
    for (n, bin) in bins.iter().enumerate().skip(FIRST_BIN) {
        let power = bin.re * bin.re + bin.im * bin.im;
        all += power;
        if LINES[n] {
            lines += power;
        }
    }
    // A line of amplitude A has the power (A / 2)^2 * sum of HANN^2 * N over its bins: N * 3 / 8 * N * A^2 / 4.
    let square_units = lines * (32.0 / (3.0 * (WINDOW * WINDOW) as f32));
    let square_uv = square_units * (UNIT_UV * UNIT_UV) as f32;
    Mains {
        line_uv: (square_uv as u64).isqrt() as u32,
        share_permille: if all > 0.0 { (1_000.0 * lines / all) as u16 } else { 0 },
    }
}

/// Raised cosine, (1 - cos(2 pi n / N)) / 2. The cosine is Bhaskara's, at most 0.0017 off.
const HANN: [f32; WINDOW] = {
    let mut hann = [0.0; WINDOW];
    let mut n = 0;
    while n < WINDOW {
        // (1 - cos(2x)) / 2 = sin^2(x), x = pi * n / N; Bhaskara: sin(pi * p) = 16 p (1 - p) / (5 - 4 p (1 - p)).
        let p = n as f32 / WINDOW as f32;
        let sine = 16.0 * p * (1.0 - p) / (5.0 - 4.0 * p * (1.0 - p));
        hann[n] = sine * sine;
        n += 1;
    }
    hann
};

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn window(of: impl Fn(f64) -> f64) -> [i16; WINDOW] {
        core::array::from_fn(|n| (of(n as f64 / 80.0) * 1e3 / f64::from(UNIT_UV)) as i16)
    }

    #[test]
    fn the_lines_of_both_mains_are_heard_with_their_size() {
        for hz in [49.8, 50.0, 50.2, 99.6, 100.0, 100.4, 120.0, 60.0] {
            let mains = mains_of(&window(|t| 300.0 + 4.0 * (TAU * hz * t + 0.7).sin()));
            assert!(mains.is_heard(), "{hz} Hz: {mains:?}");
            // On the fold at 40 Hz, a line's size depends on its phase.
            if hz != 120.0 {
                assert!((3_300..4_600).contains(&mains.line_uv), "{hz} Hz: {mains:?}");
            }
        }
    }

    #[test]
    fn a_contraction_a_ramp_and_silence_are_no_mains() {
        for of in [
            (|t| 800.0 * (1.0 - (-t / 0.08f64).exp())) as fn(f64) -> f64,
            |t| 100.0 + 900.0 * t,
            |_| 300.0,
            |t| 500.0 + 100.0 * (TAU * 3.1 * t).sin() + 30.0 * (TAU * 8.0 * t).sin(),
        ] {
            let mains = mains_of(&window(of));
            assert!(!mains.is_heard(), "{mains:?}");
        }
        assert_eq!(mains_of(&[0; WINDOW]), Mains::default());
    }
}
