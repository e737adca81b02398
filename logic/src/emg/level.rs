//! Levels of an envelope: its logarithm, above a floor. A contraction's share and direction are differences of levels.

use super::log2;

/// Offset that is added to every envelope before the logarithm, uV. Much smaller envelopes are no muscle's, and their logarithm
/// would fluctuate.
pub const FLOOR_UV: i32 = 30_000;
/// The level of an envelope of zero, Q10 octaves.
pub const FLOOR_LEVEL: i32 = level_of(0);
/// The level of 3.3 V, the highest possible, Q10 octaves.
pub const TOP_LEVEL: i32 = level_of(3_300_000);

/// `log2(uv + FLOOR_UV)`, Q10, at most 0.01 from the true one. Anything below zero is taken as it.
#[must_use]
#[inline]
pub const fn level_of(uv: i32) -> i32 {
    log2::level_of(FLOOR_UV.saturating_add(if uv < 0 { 0 } else { uv }))
}

/// The highest envelope of this level, uV.
#[must_use]
pub const fn uv_of(level: i32) -> i32 {
    let (mut uv, mut bit) = (0, 1 << 21);
    while bit > 0 {
        if level_of(uv + bit) <= level {
            uv += bit;
        }
        bit >>= 1;
    }
    uv
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_envelope_comes_back_from_its_level() {
        for uv in (0..3_300_000).step_by(97) {
            let level = level_of(uv);
            assert!((f64::from(level) / 1_024.0 - f64::from(uv + FLOOR_UV).log2()).abs() < 0.0105, "{uv}");
            assert!(uv_of(level) >= uv && level_of(uv_of(level)) == level, "{uv} uV");
        }
        assert_eq!([level_of(i32::MIN), level_of(3_300_000)], [FLOOR_LEVEL, TOP_LEVEL]);
        assert_eq!(level_of(i32::MAX), log2::level_of(i32::MAX));
    }
}
