//! Force of a quadrant from its voltage: the inverse of `front_end::fsr_mv` as a table of [`KNOTS`]; error
//! below 2 % or 6 mN.

use tenax_hal_shim::channel::{REFERENCE_MV, SAMPLE_MAX};
use tenax_hal_shim::front_end::FSR_REST_MV;

/// Voltage above rest, uV, and force, mN: `1000 (mv / 180)^(1 / 0.9)`.
pub const KNOTS: [(i32, i32); 14] = [
    (0, 0),
    (10_000, 40),
    (20_000, 87),
    (40_000, 188),
    (70_000, 350),
    (120_000, 637),
    (200_000, 1_124),
    (320_000, 1_895),
    (500_000, 3_112),
    (800_000, 5_246),
    (1_200_000, 8_231),
    (1_800_000, 12_915),
    (2_400_000, 17_780),
    (3_100_000, 23_628),
];

/// Rounds down; negative below rest.
pub fn uv_above_rest(sample: u16) -> i32 {
    const UV_MAX: u64 = REFERENCE_MV as u64 * 1_000;
    let uv = u64::from(sample) * UV_MAX / SAMPLE_MAX as u64;
    uv as i32 - FSR_REST_MV as i32 * 1_000
}

/// Force on a quadrant, mN, from its voltage above rest, uV; 0 below rest, the last knot's force above it.
pub fn force_mn(uv: i32) -> i32 {
    let mut below = KNOTS[0];
    for knot in KNOTS {
        if uv < knot.0 {
            let (span_uv, span_mn) = (i64::from(knot.0 - below.0), i64::from(knot.1 - below.1));
            if span_uv == 0 {
                return 0;
            }
            return below.1 + (i64::from(uv - below.0) * span_mn / span_uv) as i32;
        }
        below = knot;
    }
    below.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenax_hal_shim::front_end::{FSR_EXPONENT, FSR_MV_AT_1N};

    fn exact_mn(uv: f64) -> f64 {
        1e3 * (uv / 1e3 / FSR_MV_AT_1N).powf(1.0 / FSR_EXPONENT)
    }

    #[test]
    fn the_table_is_the_inverse_of_the_front_end_and_saturates() {
        for (uv, mn) in KNOTS {
            assert_eq!(mn, exact_mn(f64::from(uv)).round() as i32, "at {uv} uV");
        }
        for uv in (0..3_000_000).step_by(997) {
            let error = (f64::from(force_mn(uv)) - exact_mn(f64::from(uv))).abs();
            assert!(error < 6.0_f64.max(0.02 * exact_mn(f64::from(uv))), "{error} mN at {uv} uV");
        }
        assert_eq!((force_mn(i32::MIN), force_mn(-1), force_mn(i32::MAX)), (0, 0, 23_628));
        assert_eq!((uv_above_rest(0), uv_above_rest(SAMPLE_MAX)), (-200_000, 3_100_000));
    }
}
