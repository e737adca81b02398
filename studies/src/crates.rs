//! What roots, logarithms, angles and transforms of public crates are off by, beside the logic's own: `tenax size --crates` lays
//! it beside what they cost on the emulated core (`firmware/src/bin/kernels/crates.rs`).

use std::f64::consts::TAU;

use micromath::F32Ext;
use tenax_logic::array::SPECTRUM_WINDOW;
use tenax_logic::array::logarithm::Knee;
use tenax_logic::array::spectrum::SlidingSpectrum;

/// A way to compute something.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What is computed.
    pub what: &'static str,
    /// By what.
    pub by: &'static str,
    /// Its kernel on the emulated core.
    pub kernel: &'static str,
    /// How far it is off at most, in words.
    pub off: String,
}

/// All of them.
#[must_use]
pub fn rows() -> Vec<Row> {
    let row = |what, by, kernel, off| Row { what, by, kernel, off };
    let part = |off: f64| format!("{:.3} %", 100.0 * off);
    let doublings = |off: f64| format!("{off:.4} doublings");
    let degrees = |off: f64| format!("{:.4} degrees", off.to_degrees());
    let leak = |off: f64| format!("{off:.4} of a held force in a bin that has none");
    vec![
        row("root of a sum of squares", "core (ours)", "root_core", part(root(|n| n.isqrt() as f64))),
        row(
            "root of a sum of squares",
            "micromath",
            "root_micromath",
            part(root(|n| f64::from(F32Ext::sqrt(n as f32) as i32))),
        ),
        row("log2(1 + x / 128), Q9", "ours", "log_ours", doublings(logarithm(|x| Knee::at(128).of(x)))),
        row(
            "log2(1 + x / 128), Q9",
            "micromath",
            "log_micromath",
            doublings(logarithm(|x| (F32Ext::log2(1.0 + x * (1.0 / 128.0)) * 512.0) as i16)),
        ),
        row(
            "log2(1 + x / 128), Q9",
            "libm",
            "log_libm",
            doublings(logarithm(|x| (libm::log2f(1.0 + x * (1.0 / 128.0)) * 512.0) as i16)),
        ),
        row("angle (no tick has one)", "micromath", "angle_micromath", degrees(angle(F32Ext::atan2))),
        row("angle (no tick has one)", "libm", "angle_libm", degrees(angle(libm::atan2f))),
        row("transform of 40 sums", "ours, sliding", "spectrum", leak(leak_of(ours))),
        row("transform of 40 sums", "microfft, 64 with zeros", "fft_microfft", leak(leak_of(padded))),
    ]
}

/// The greatest part that a root of a sum of forces' squares, 1 to 100 N in mN, is off by.
fn root(root: impl Fn(u64) -> f64) -> f64 {
    let squares = (0..4_000).map(|n| (1e6 * 10_f64.powf(4.0 * f64::from(n) / 4_000.0)) as u64);
    squares.map(|n| (root(n) / (n as f64).sqrt() - 1.0).abs()).fold(0.0, f64::max)
}

/// How much a logarithm in Q9 is off by, doublings, over what a feature may be of.
fn logarithm(log: impl Fn(f32) -> i16) -> f64 {
    let values = (0..4_000).map(|n| 10_f64.powf(9.0 * f64::from(n) / 4_000.0) as f32);
    let off = |x: f32| (f64::from(log(x)) / 512.0 - (1.0 + f64::from(x) / 128.0).log2()).abs();
    values.map(off).fold(0.0, f64::max)
}

/// How much an angle is off by, rad, all around.
fn angle(angle: impl Fn(f32, f32) -> f32) -> f64 {
    let all = (0..3_600).map(|n| TAU * (f64::from(n) + 0.5) / 3_600.0);
    let off = |at: f64| {
        let (across, along) = ((1e3 * at.sin()) as f32, (1e3 * at.cos()) as f32);
        let off = f64::from(angle(across, along)) - f64::from(across).atan2(f64::from(along));
        off.abs().min(TAU - off.abs())
    };
    all.map(off).fold(0.0, f64::max)
}

/// The greatest amplitude that a force which is only held has in a bin above 0, as a part of bin 0's.
fn leak_of(powers: impl Fn(&[i32; SPECTRUM_WINDOW]) -> Vec<f32>) -> f64 {
    let powers = powers(&[20_000; SPECTRUM_WINDOW]);
    let most = powers.iter().skip(1).copied().fold(0.0, f32::max);
    f64::from(most / powers.first().copied().unwrap_or(1.0)).sqrt()
}

fn ours(sums: &[i32; SPECTRUM_WINDOW]) -> Vec<f32> {
    let mut spectrum = SlidingSpectrum::<SPECTRUM_WINDOW>::default();
    sums.iter().for_each(|&sum| spectrum.push(sum));
    spectrum.powers().to_vec()
}

fn padded(sums: &[i32; SPECTRUM_WINDOW]) -> Vec<f32> {
    let mut values = [0.0; 64];
    values.iter_mut().zip(sums).for_each(|(value, &sum)| *value = sum as f32);
    let bins = microfft::real::rfft_64(&mut values);
    // The highest frequency is packed into the lowest one's imaginary part.
    bins.iter()
        .enumerate()
        .map(|(n, bin)| bin.re * bin.re + if n > 0 { bin.im * bin.im } else { 0.0 })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_exact_is_found_exact_and_what_is_not_is_not() {
        let of = |kernel: &str| rows().into_iter().find(|row| row.kernel == kernel).unwrap().off;
        let number = |kernel: &str| of(kernel).split(' ').next().unwrap().parse::<f64>().unwrap();
        // Rounding down is off by 1 mN of 1 N at most.
        assert!(number("root_core") <= 0.1 && number("root_micromath") > 1.0, "{:#?}", rows());
        assert!(number("log_ours") < 0.09 && number("log_libm") < 0.01);
        assert!(number("angle_libm") < 1e-3 && number("angle_micromath") > 0.01);
        assert!(number("spectrum") < 1e-6 && number("fft_microfft") > 0.1);
    }
}
