//! Levels of an envelope: its logarithm above a floor.

use super::log2;

/// Offset of every envelope before the logarithm, uV, so that noise near zero does not fluctuate.
pub const FLOOR_UV: i32 = 30_000;
pub const FLOOR_LEVEL: i32 = level_of(0);
pub const TOP_LEVEL: i32 = level_of(3_300_000);

/// `log2(uv + FLOOR_UV)`, Q10; error at most 0.01. Below zero it is that of zero.
#[inline]
pub const fn level_of(uv: i32) -> i32 {
    log2::level_of(FLOOR_UV.saturating_add(if uv < 0 { 0 } else { uv }))
}

/// Highest envelope of this level, uV.
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
