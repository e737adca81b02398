//! Equations 1 to 4, the transform and the structure functions, from the readings of the whole window, in `f64` and `i64`.

use std::f64::consts::PI;

use tenax_hal_shim::channel::{ARRAY, CHANNELS, sample_from_mv};
use tenax_logic::array::structure::{LAGS, WINDOWS};
use tenax_logic::array::{BINS, COVARIANCE_WINDOW, COVARIANCES, ELEMENTS, SPECTRUM_WINDOW};

const D_MAX: i64 = 1 << 13;

pub fn covariances(readings: &[[u16; ELEMENTS]]) -> [i64; COVARIANCES] {
    let last = &readings[readings.len() - COVARIANCE_WINDOW - 1..];
    let difference = |frame: usize, element: usize| {
        let change = i64::from(last[frame + 1][element]) - i64::from(last[frame][element]);
        change.clamp(-D_MAX, D_MAX - 1)
    };
    let entry = |(a, b): (usize, usize)| {
        (0..COVARIANCE_WINDOW).map(|frame| difference(frame, a) * difference(frame, b)).sum()
    };
    let pairs: Vec<_> = (0..ELEMENTS).flat_map(|a| (a..ELEMENTS).map(move |b| (a, b))).collect();
    std::array::from_fn(|n| entry(pairs[n]))
}

/// Elements' sums above rest.
pub fn sums(readings: &[[u16; ELEMENTS]]) -> Vec<i32> {
    let rest = ELEMENTS as i32 * i32::from(sample_from_mv(CHANNELS[ARRAY].rest_mv));
    readings
        .iter()
        .map(|reading| reading.iter().map(|&sample| i32::from(sample)).sum::<i32>() - rest)
        .collect()
}

pub fn magnitudes(sums: &[i32]) -> [f64; BINS] {
    let last = &sums[sums.len() - SPECTRUM_WINDOW..];
    std::array::from_fn(|bin| {
        let part = |wave: fn(f64) -> f64| -> f64 {
            let angle = |n: usize| 2.0 * PI * (n * bin % SPECTRUM_WINDOW) as f64 / SPECTRUM_WINDOW as f64;
            last.iter().enumerate().map(|(n, &sum)| f64::from(sum) * wave(angle(n))).sum()
        };
        part(f64::cos).hypot(part(f64::sin))
    })
}

/// For each lag and each window of it: ten times the squares of the elements' changes about the mean of all, samples^2.
pub fn structures(readings: &[[u16; ELEMENTS]]) -> [[i64; WINDOWS]; LAGS.len()] {
    // From so many frames ago to so many, the newest being none.
    let windows = [0..1, 1..2, 2..4, 4..8, 8..16, 16..32];
    let of = |lag: usize, ago: usize| -> i64 {
        let now = readings.len() - 1 - ago;
        // There is nothing yet to differ from.
        if now < lag {
            return 0;
        }
        let change = |n: usize| {
            (f64::from(readings[now][n]) - f64::from(readings[now - lag][n])).clamp(-1_024.0, 1_024.0)
        };
        let mean = (0..ELEMENTS).map(change).sum::<f64>() / ELEMENTS as f64;
        let squares: f64 = (0..ELEMENTS).map(|n| (change(n) - mean).powi(2)).sum();
        (ELEMENTS as f64 * squares).round() as i64
    };
    LAGS.map(|lag| windows.clone().map(|window| window.map(|ago| of(lag, ago)).sum()))
}

/// `log2(1 + x / knee)` as straight lines between powers of two, in units of 2^-9; the knee is a power of two.
pub fn compressed(x: f64, knee: u32) -> f64 {
    let ratio = 1.0 + x / f64::from(knee);
    let whole = ratio.log2().floor();
    512.0 * (whole + ratio / whole.exp2() - 1.0)
}
