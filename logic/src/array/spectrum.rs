//! Sliding discrete Fourier transform of the elements' sum (Bamshad 2023, section 4.3), in integers, so that
//! nothing drifts. The phase is counted from a fixed frame.

use super::{BINS, SPECTRUM_WINDOW};

/// `cos(2 pi n / 40)` for n = 0 to 10, Q30, rounded to nearest.
const QUARTER_WAVE: [i32; SPECTRUM_WINDOW / 4 + 1] = [
    1_073_741_824,
    1_060_522_280,
    1_021_189_159,
    956_710_970,
    868_675_383,
    759_250_125,
    631_129_609,
    487_468_587,
    331_804_471,
    167_970_228,
    0,
];
const TWIDDLE_Q: u32 = 30;

/// `(cos, -sin)` of `2 pi n / 40`, Q30.
const TWIDDLES: [[i32; 2]; SPECTRUM_WINDOW] = {
    let mut twiddles = [[0; 2]; SPECTRUM_WINDOW];
    let mut n = 0;
    while n < SPECTRUM_WINDOW {
        // -sin(a) = cos(a + a quarter turn).
        twiddles[n] = [cosine(n), cosine(n + SPECTRUM_WINDOW / 4)];
        n += 1;
    }
    twiddles
};

const fn cosine(n: usize) -> i32 {
    let half = SPECTRUM_WINDOW / 2;
    let n = n % SPECTRUM_WINDOW;
    let n = if n > half { SPECTRUM_WINDOW - n } else { n };
    if n > half / 2 { -QUARTER_WAVE[half - n] } else { QUARTER_WAVE[n] }
}

/// Sliding DFT of the last 40 sums of all taxels, bins 0 to 20.
#[derive(Clone, Debug)]
pub struct SlidingSpectrum {
    window: [i32; SPECTRUM_WINDOW],
    place: usize,
    /// Real and imaginary part, Q30. Ten elements of 14 bits and 40 sums stay below 2^53.
    bins: [[i64; 2]; BINS],
}

impl Default for SlidingSpectrum {
    fn default() -> Self {
        Self { window: [0; SPECTRUM_WINDOW], place: 0, bins: [[0; 2]; BINS] }
    }
}

impl SlidingSpectrum {
    /// `sum`: samples within +-2^20.
    #[inline]
    pub fn push(&mut self, sum: i32) {
        let Some(oldest) = self.window.get_mut(self.place) else { return };
        let change = i64::from(sum - core::mem::replace(oldest, sum));
        let step = self.place;
        self.place = if self.place + 1 < SPECTRUM_WINDOW { self.place + 1 } else { 0 };
        let mut angle = 0;
        for [re, im] in &mut self.bins {
            let [cos, minus_sin] = TWIDDLES.get(angle).copied().unwrap_or_default();
            *re += change * i64::from(cos);
            *im += change * i64::from(minus_sin);
            angle += step;
            angle = if angle >= SPECTRUM_WINDOW { angle - SPECTRUM_WINDOW } else { angle };
        }
    }

    /// Adds a constant to the whole window. Only bin 0 changes: the other bins' twiddle factors add up to 0.
    pub fn shift(&mut self, by: i32) {
        for sum in &mut self.window {
            *sum += by;
        }
        if let Some([re, _]) = self.bins.first_mut() {
            *re += (i64::from(by) * SPECTRUM_WINDOW as i64) << TWIDDLE_Q;
        }
    }

    /// `|sum over n of s_n exp(-2 pi i k n / 40)|^2`, each part rounded down to the sums' unit.
    #[inline]
    pub fn powers(&self) -> [f32; BINS] {
        self.bins.map(|[re, im]| {
            // Below 2^23 for elements of 14 bits: exact as a single.
            let (re, im) = ((re >> TWIDDLE_Q) as i32 as f32, (im >> TWIDDLE_Q) as i32 as f32);
            re * re + im * im
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shifted_window_is_that_of_shifted_sums() {
        let sum = |n: i32| (n * n) % 1_000;
        let (mut shifted, mut plain) = (SlidingSpectrum::default(), SlidingSpectrum::default());
        for n in 0..100 {
            if n == 63 {
                shifted.shift(5_000);
            }
            shifted.push(sum(n) + if n >= 63 { 5_000 } else { 0 });
            plain.push(sum(n) + 5_000);
            if n >= 63 {
                assert_eq!(shifted.powers()[1..], plain.powers()[1..], "{n}");
            }
        }
        assert_eq!(shifted.bins, plain.bins);
    }
}
