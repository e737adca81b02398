//! Levels of an envelope: its base-2 logarithm above a floor, Q10 octaves.

/// 1024 is a doubling.
pub const LEVEL_Q: u32 = 10;
/// Offset of every envelope before the logarithm, uV, so that noise near zero does not fluctuate.
pub const FLOOR_UV: i32 = 30_000;
pub const FLOOR_LEVEL: i32 = level_of(0);
pub const TOP_LEVEL: i32 = level_of(3_300_000);
/// Four times log2(1 + m) - m half way between two octaves, Q15: a parabola within 0.01.
const BEND_Q15: u32 = 11_200;

/// `log2(uv + FLOOR_UV)`, Q10; error at most 0.01. Below zero it is that of zero.
#[inline]
pub const fn level_of(uv: i32) -> i32 {
    log2(FLOOR_UV.saturating_add(if uv < 0 { 0 } else { uv }) as u32)
}

/// Q10; error at most 0.01. `number` is at least 1.
#[inline]
pub const fn log2(number: u32) -> i32 {
    let octave = 31 - number.leading_zeros();
    let m = ((number << (31 - octave)) >> 16) & 0x7fff;
    let bend = (((m * (0x8000 - m)) >> 15) * BEND_Q15) >> 15;
    ((octave << LEVEL_Q) + ((m + bend) >> (15 - LEVEL_Q))) as i32
}

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
    fn a_level_is_the_logarithm_within_a_hundredth_and_an_envelope_comes_back_from_it() {
        let mut before = i32::MIN;
        for uv in (0..3_300_000).step_by(7) {
            let level = level_of(uv);
            assert!((f64::from(level) / 1_024.0 - f64::from(uv + FLOOR_UV).log2()).abs() < 0.0105, "{uv}");
            assert!(level >= before, "{uv} uV");
            before = level;
            if uv % 97 == 0 {
                assert!(uv_of(level) >= uv && level_of(uv_of(level)) == level, "{uv} uV");
            }
        }
        assert_eq!([level_of(i32::MIN), level_of(3_300_000)], [FLOOR_LEVEL, TOP_LEVEL]);
        assert_eq!(level_of(i32::MAX) >> LEVEL_Q, 30);
    }
}
