//! Base-2 logarithm of an integer, Q10.

/// 1024 is a doubling.
pub const LEVEL_Q: u32 = 10;
/// Envelopes below this count as it, uV: their logarithm would swing with the noise of a pin.
pub const FLOOR_UV: i32 = 8_000;
/// Four times log2(1 + m) - m half way between two octaves, Q15: a parabola within 0.01.
const BEND_Q15: u32 = 11_200;

/// `log2(uv)`, Q10; error at most 0.01.
#[inline]
pub const fn level_of(uv: i32) -> i32 {
    let uv = if uv < FLOOR_UV { FLOOR_UV as u32 } else { uv as u32 };
    let octave = 31 - uv.leading_zeros();
    let m = ((uv << (31 - octave)) >> 16) & 0x7fff;
    let bend = (((m * (0x8000 - m)) >> 15) * BEND_Q15) >> 15;
    ((octave << LEVEL_Q) + ((m + bend) >> (15 - LEVEL_Q))) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_logarithm_within_a_hundredth_and_never_falls_by_more_than_a_step() {
        let mut before = i32::MIN;
        for uv in (FLOOR_UV..3_300_000).step_by(7) {
            let level = level_of(uv);
            let error = f64::from(level) / 1024.0 - f64::from(uv).log2();
            assert!(error.abs() < 0.0105, "{uv} uV: {error}");
            assert!(level >= before, "{uv} uV");
            before = level;
        }
    }

    #[test]
    fn what_is_no_level_is_the_floor_or_the_top() {
        assert_eq!([i32::MIN, 0].map(level_of), [level_of(FLOOR_UV); 2]);
        assert_eq!(level_of(i32::MAX) >> LEVEL_Q, 30);
    }
}
