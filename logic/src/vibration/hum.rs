//! Mains hum, taken off each PVDF film before its filters. One oscillator (coupled form, amplitude 2^29) is
//! shared; each film has weights of its cosine and sine (Q19) and adapts (LMS) 83 times a second by the error in
//! its band. The oscillator starts at the nominal frequency and follows the mains by the votes of weights that turn.

use tenax_hal_shim::channel::{FRAME_HZ, PVDF_COUNT};

const AMPLITUDE: i32 = 1 << 29;
const WEIGHT_MAX: i32 = 1 << 30;
/// Least limit of an error, Q16: 256 samples. Slip is shorter than what it takes to learn a louder hum by these
/// steps; hum that was learned and stops or jumps in phase is as large as itself.
const ERROR_MAX: i32 = 256 << 16;
const EVERY: usize = 2;
/// Four times the upper word of error times oscillator is 1/16 of the error.
const RATE: i32 = 4;
/// `2 pi / fs` in Q32: turn of the oscillator in a tick for each Hz.
const PER_HZ: f64 = 2.0 * core::f64::consts::PI / FRAME_HZ as f64 * 4_294_967_296.0;
/// Mains, Hz, and the oscillator's largest distance from it.
const NOMINAL_HZ: [f64; 2] = [50.0, 60.0];
const OFF_HZ: f64 = 1.0;
const STEPS: [i32; 2] = [step(NOMINAL_HZ[0]), step(NOMINAL_HZ[1])];
const WITHIN: [[i32; 2]; 2] = [within(NOMINAL_HZ[0]), within(NOMINAL_HZ[1])];
const VOTE: i32 = (0.25 * EVERY as f64 / FRAME_HZ as f64 * PER_HZ) as i32;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Weights {
    cosine: i32,
    sine: i32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turn {
    cosine: i32,
    sine: i32,
}

impl Weights {
    #[inline]
    pub const fn heard(self, now: Turn) -> i32 {
        high(self.cosine, now.cosine).wrapping_add(high(self.sine, now.sine))
    }

    /// Amplitude of the hum, Q16, or 0.7 of it.
    #[inline]
    pub fn level(self) -> i32 {
        self.cosine.abs().max(self.sine.abs()) >> 3
    }
}

#[derive(Clone, Debug)]
pub struct Mains {
    now: Turn,
    step: i32,
    ticks: u8,
    is_60_hz: bool,
}

impl Default for Mains {
    fn default() -> Self {
        Self { now: Turn { cosine: AMPLITUDE, sine: 0 }, step: STEPS[0], ticks: 0, is_60_hz: false }
    }
}

const fn step(hz: f64) -> i32 {
    let x = 2.0 * core::f64::consts::PI * hz / FRAME_HZ as f64;
    ((x - x * x * x / 24.0) * 4_294_967_296.0) as i32
}

const fn within(hz: f64) -> [i32; 2] {
    [step(hz - OFF_HZ), step(hz + OFF_HZ)]
}

#[inline]
const fn high(a: i32, b: i32) -> i32 {
    ((a as i64 * b as i64) >> 32) as i32
}

impl Mains {
    #[inline]
    pub fn turn(&mut self) -> Turn {
        let cosine = self.now.cosine.wrapping_sub(high(self.step, self.now.sine));
        let sine = self.now.sine.wrapping_add(high(self.step, cosine));
        self.now = Turn { cosine, sine };
        self.now
    }

    /// Film that adapts in this tick. Call it once a tick.
    #[inline]
    pub fn asks(&mut self) -> Option<usize> {
        let ticks = usize::from(self.ticks);
        self.ticks = if ticks + 1 < EVERY * PVDF_COUNT { self.ticks + 1 } else { self.renew() };
        ticks.is_multiple_of(EVERY).then_some(ticks / EVERY)
    }

    /// Brings the oscillator back to its size, which a new frequency changes a little. Gives the first tick.
    fn renew(&mut self) -> u8 {
        let Turn { cosine, sine } = self.now;
        let missing = high(AMPLITUDE, AMPLITUDE) - high(cosine, cosine) - high(sine, sine);
        self.now = Turn { cosine: cosine + high(cosine, missing), sine: sine + high(sine, missing) };
        0
    }

    /// Begins anew at the nominal frequency if it is another one.
    pub const fn tune(&mut self, is_60_hz: bool) {
        if self.is_60_hz != is_60_hz {
            self.is_60_hz = is_60_hz;
            self.step = STEPS[is_60_hz as usize];
        }
    }

    #[inline]
    pub fn adapt(&mut self, film: &mut Weights, error: i32) {
        let [slowest, fastest] = WITHIN[usize::from(self.is_60_hz)];
        let most = film.level().max(ERROR_MAX);
        let error = error.clamp(-most, most);
        let (by_cosine, by_sine) = (high(error, self.now.cosine), high(error, self.now.sine));
        // Sign of the weights' turn: back, if the mains is ahead of the oscillator.
        let ahead = i64::from(film.sine) * i64::from(by_cosine) - i64::from(film.cosine) * i64::from(by_sine);
        self.step = (self.step + VOTE * ahead.signum() as i32).max(slowest).min(fastest);
        film.cosine = (film.cosine + RATE * by_cosine).clamp(-WEIGHT_MAX, WEIGHT_MAX);
        film.sine = (film.sine + RATE * by_sine).clamp(-WEIGHT_MAX, WEIGHT_MAX);
    }
}

#[cfg(test)]
mod tests;
