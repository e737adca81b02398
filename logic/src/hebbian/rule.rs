use core::ops::RangeInclusive;

/// Rates of equations 5 and 6 for one update.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    pub alpha_ppb: u32,
    pub beta_ppb: u32,
    /// Constant share of each connection, parts per million of a weight of 1. Never 0.
    pub delta_ppm: u32,
}

impl Config {
    /// Middle of the useful region of the map in `host-tests/tests/hebbian/map.txt`.
    pub const DEFAULT: Self = Self { alpha_ppb: 50_000, beta_ppb: 10_000, delta_ppm: 300_000 };
    /// Below 1/16, so that a step fits its format.
    pub const ALPHA_PPB: RangeInclusive<u32> = 0..=60_000_000;
    pub const BETA_PPB: RangeInclusive<u32> = 0..=60_000_000;
    /// From 8000 times the resolution of r to the largest weight.
    pub const DELTA_PPM: RangeInclusive<u32> = 1_000..=8_000_000;
}

impl Default for Config {
    fn default() -> Self {
        Self::DEFAULT
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rule {
    /// Q35, below 2^31, rounded down.
    pub(super) alpha: u32,
    /// Q32, above -2^28, rounded to nearest.
    pub(super) minus_beta: i32,
    /// Q23, in 2^13..=2^26, rounded to nearest.
    pub(super) delta: u32,
}

impl Rule {
    /// The rates are within their ranges.
    pub const fn of(config: &Config) -> Self {
        // 60e6 < 2^26, so nothing below leaves 64 bits, and the ranges above keep each result in its type.
        let beta = (((config.beta_ppb as u64) << 32) + 500_000_000) / 1_000_000_000;
        let delta = (((config.delta_ppm as u64) << 23) + 500_000) / 1_000_000;
        Self {
            alpha: (((config.alpha_ppb as u64) << 35) / 1_000_000_000) as u32,
            minus_beta: -(beta as i32),
            delta: delta as u32,
        }
    }
}
