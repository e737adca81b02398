//! Roots, logarithms, angles and transforms of `micromath`, `libm` and `microfft`, beside what the logic uses: `tenax size --crates`.

use core::hint::black_box;

use micromath::F32Ext;
use tenax_logic::array::Reading;
use tenax_logic::array::logarithm::Knee;

/// Runs each of them once, on numbers as large as the logic has them.
pub fn run(reading: &Reading) {
    let numbers = reading.map(|sample| u32::from(sample.unwrap_or(0)));
    let squares: u64 = numbers.iter().take(4).map(|&n| u64::from(n) * u64::from(n)).sum();
    black_box(tenax_kernel_root_core(black_box(squares)));
    black_box(tenax_kernel_root_micromath(black_box(squares)));
    let power = squares as f32;
    black_box(tenax_kernel_log_ours(black_box(Knee::at(128)), black_box(power)));
    black_box(tenax_kernel_log_micromath(black_box(power)));
    black_box(tenax_kernel_log_libm(black_box(power)));
    let [along, across, ..] = numbers.map(|n| n as f32 - 2_050.0);
    black_box(tenax_kernel_angle_micromath(black_box(across), black_box(along)));
    black_box(tenax_kernel_angle_libm(black_box(across), black_box(along)));
    let mut values = [0.0; 64];
    values.iter_mut().zip(numbers.iter().cycle()).take(40).for_each(|(value, &n)| *value = n as f32);
    black_box(tenax_kernel_fft_microfft(black_box(&mut values)));
}

/// As the forces have it: of a sum of squares, rounded down.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_root_core(squares: u64) -> i32 {
    squares.isqrt() as i32
}

/// From the same integer to the same integer.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_root_micromath(squares: u64) -> i32 {
    F32Ext::sqrt(squares as f32) as i32
}

/// As the array's features have it: `log2(1 + x / 128)`, Q9.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_log_ours(knee: Knee, power: f32) -> i16 {
    knee.of(power)
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_log_micromath(power: f32) -> i16 {
    (F32Ext::log2(1.0 + power * (1.0 / 128.0)) * 512.0) as i16
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_log_libm(power: f32) -> i16 {
    (libm::log2f(1.0 + power * (1.0 / 128.0)) * 512.0) as i16
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_angle_micromath(across: f32, along: f32) -> f32 {
    F32Ext::atan2(across, along)
}

#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_angle_libm(across: f32, along: f32) -> f32 {
    libm::atan2f(across, along)
}

/// Forty sums with zeros behind them, and the powers of the 21 bins that a transform of forty has.
#[inline(never)]
#[unsafe(no_mangle)]
fn tenax_kernel_fft_microfft(values: &mut [f32; 64]) -> [f32; 21] {
    let bins = microfft::real::rfft_64(values);
    core::array::from_fn(|n| bins[n].re * bins[n].re + bins[n].im * bins[n].im)
}
