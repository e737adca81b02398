//! Mains hum, taken off each PVDF film before its filters.
//!
//! All films hear the mains at one frequency, each as loud and as late as it lies. So one oscillator is shared, and each film
//! has a pair of weights of its cosine and sine. Every tick subtracts all twelve; one film after the other adapts (LMS), each
//! 83 times a second, by what its band hears of the error, which passes 45 to 65 Hz with less than 6 degrees of phase.
//!
//! Weights that follow in 0.4 s leave a slip's burst of 25 ms alone, but cannot follow a mains that is 0.5 Hz off: they would have
//! to turn by 70 degrees in that time. So the oscillator follows the frequency: each weight that turns votes which way.
//!
//! What is louder than hum is not learned from: the error is clipped, and nothing adapts while the films are loud.
//!
//! Fixed point: the oscillator is the coupled form, whose amplitude is kept at 2^29; a weight has 19 fraction bits,
//! so the upper word of its product with the oscillator is hum in Q16, as the films' samples are.

use tenax_hal_shim::channel::{FRAME_HZ, PVDF_COUNT};

/// Amplitude of the oscillator.
const AMPLITUDE: i32 = 1 << 29;
/// No weight is beyond it, Q19: 2048 samples.
const WEIGHT_MAX: i32 = 1 << 30;
/// An error beyond it is not hum's alone, Q16: 64 samples.
const ERROR_MAX: i32 = 64 << 16;
/// Ticks between two films that adapt.
const EVERY: usize = 2;
/// How far a weight goes: four times the upper word of error times oscillator is 1/16 of the error.
const RATE: i32 = 4;
/// `2 pi / fs` in Q32: what a Hz more turns the oscillator further in a tick.
const PER_HZ: f64 = 2.0 * core::f64::consts::PI / FRAME_HZ as f64 * 4_294_967_296.0;
/// The mains, Hz, and how far from it the oscillator may be.
const NOMINAL_HZ: [f64; 2] = [50.0, 60.0];
const OFF_HZ: f64 = 1.0;
/// The oscillator's slowest and fastest step at either mains.
const WITHIN: [[i32; 2]; 2] = [within(NOMINAL_HZ[0]), within(NOMINAL_HZ[1])];
/// How far a vote moves the frequency: 0.25 Hz in a second of votes that agree.
const VOTE: i32 = (0.25 * EVERY as f64 / FRAME_HZ as f64 * PER_HZ) as i32;

/// One film's weights of cosine and sine, Q19 samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Weights {
    cosine: i32,
    sine: i32,
}

/// The oscillator in one tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turn {
    cosine: i32,
    sine: i32,
}

impl Weights {
    /// The film's hum in this tick, Q16 samples.
    #[inline]
    #[must_use]
    pub const fn heard(self, now: Turn) -> i32 {
        high(self.cosine, now.cosine).wrapping_add(high(self.sine, now.sine))
    }
}

/// The oscillator that follows the mains, shared by all films.
#[derive(Clone, Debug)]
pub struct Mains {
    now: Turn,
    /// `2 sin(pi f / fs)`, Q32.
    step: i32,
    /// Ticks since the first film adapted.
    ticks: u8,
}

impl Default for Mains {
    fn default() -> Self {
        Self { now: Turn { cosine: AMPLITUDE, sine: 0 }, step: step(NOMINAL_HZ[0]), ticks: 0 }
    }
}

/// `2 sin(x / 2)` of the angle x in a tick, by its series: within 1e-6 of it.
const fn step(hz: f64) -> i32 {
    let x = 2.0 * core::f64::consts::PI * hz / FRAME_HZ as f64;
    ((x - x * x * x / 24.0) * 4_294_967_296.0) as i32
}

const fn within(hz: f64) -> [i32; 2] {
    [step(hz - OFF_HZ), step(hz + OFF_HZ)]
}

/// The upper word of a product: one instruction.
#[inline]
const fn high(a: i32, b: i32) -> i32 {
    ((a as i64 * b as i64) >> 32) as i32
}

impl Mains {
    /// Advances by one tick.
    #[inline]
    pub fn turn(&mut self) -> Turn {
        let cosine = self.now.cosine.wrapping_sub(high(self.step, self.now.sine));
        let sine = self.now.sine.wrapping_add(high(self.step, cosine));
        self.now = Turn { cosine, sine };
        self.now
    }

    /// The film that adapts in this tick, if one does. Call it once a tick.
    #[inline]
    pub fn asks(&mut self) -> Option<usize> {
        let ticks = usize::from(self.ticks);
        self.ticks = if ticks + 1 < EVERY * PVDF_COUNT { self.ticks + 1 } else { self.renew() };
        ticks.is_multiple_of(EVERY).then_some(ticks / EVERY)
    }

    /// A new frequency leaves the oscillator a little larger or smaller: it goes back to its size. Gives the first tick.
    fn renew(&mut self) -> u8 {
        let Turn { cosine, sine } = self.now;
        let missing = high(AMPLITUDE, AMPLITUDE) - high(cosine, cosine) - high(sine, sine);
        self.now = Turn { cosine: cosine + high(cosine, missing), sine: sine + high(sine, missing) };
        0
    }

    /// Adapts a film's weights by the error in its band, Q16 samples: the signal that the weights do not explain.
    #[inline]
    pub fn adapt(&mut self, mains_60_hz: bool, film: &mut Weights, error: i32) {
        let [slowest, fastest] = WITHIN[usize::from(mains_60_hz)];
        let error = error.clamp(-ERROR_MAX, ERROR_MAX);
        let (by_cosine, by_sine) = (high(error, self.now.cosine), high(error, self.now.sine));
        // Which way the weights turn: back, if the mains is ahead of the oscillator.
        let ahead = high(film.sine, by_cosine << 8) - high(film.cosine, by_sine << 8);
        self.step = (self.step + VOTE * ahead.signum()).max(slowest).min(fastest);
        film.cosine = (film.cosine + RATE * by_cosine).clamp(-WEIGHT_MAX, WEIGHT_MAX);
        film.sine = (film.sine + RATE * by_sine).clamp(-WEIGHT_MAX, WEIGHT_MAX);
    }
}

#[cfg(test)]
mod tests;
