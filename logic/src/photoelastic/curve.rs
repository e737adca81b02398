//! Force from the dc part: the intensity follows a sine squared (equation 9), so its phase is an arcsine of a
//! root; force over phase is a table.

pub const HALF_TURN: i32 = 8_192;
pub const PEAK: i32 = HALF_TURN / 2;
pub const KNOTS: usize = 8;
const KNOT_PHASE: i32 = HALF_TURN / KNOTS as i32;
pub const ONE: i32 = 1 << 20;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Curve {
    pub dark_q4: i32,
    pub bright_q4: i32,
    pub force_mn: [i32; KNOTS],
}

impl Curve {
    /// Part of the span, [`ONE`] at the peak; may be outside of 0 to 1.
    pub fn part(&self, level_q4: i32) -> i32 {
        let span = i64::from(self.bright_q4 - self.dark_q4).max(1);
        let part = (i64::from(level_q4) - i64::from(self.dark_q4)) * i64::from(ONE) / span;
        part.clamp(-i64::from(ONE), 2 * i64::from(ONE)) as i32
    }

    /// mN: between two knots the mean of the parabolas through them and either next one.
    pub fn force_mn(&self, phase: i32) -> i32 {
        let phase = phase.clamp(0, HALF_TURN);
        let knot = (phase / KNOT_PHASE).min(KNOTS as i32 - 1);
        let part = phase - knot * KNOT_PHASE;
        let at = |knot: i32| match knot {
            ..=0 => 0,
            knot => self.force_mn.get(knot as usize - 1).map_or(0, |mn| *mn),
        };
        let (below, above) = (at(knot), at(knot + 1));
        let bend = |knot: i32| at(knot - 1) - 2 * at(knot) + at(knot + 1);
        let bends = bend(knot.max(1)) + bend((knot + 1).min(KNOTS as i32 - 1));
        let line = (above - below) * part / KNOT_PHASE;
        below + line - bends / 4 * (part * (KNOT_PHASE - part) / KNOT_PHASE) / KNOT_PHASE
    }
}

/// Rising branch, 0 to [`PEAK`]: `asin(sqrt(part))`.
#[inline(never)]
pub fn phase_of(part: i32) -> i32 {
    let part = part.clamp(0, ONE);
    // Near 1 the arcsine is steep; there the other leg of the triangle is small.
    if part <= ONE / 2 { asin_of_root(part) } else { PEAK - asin_of_root(ONE - part) }
}

fn asin_of_root(part: i32) -> i32 {
    // The root of a Q20 as Q15.
    let s = i64::from((u64::from(part.unsigned_abs()) << 10).isqrt() as u32);
    let times = |a: i64, b: i64| (a * b) >> 15;
    let square = times(s, s);
    // asin(s) = s (1 + s^2/6 + 3 s^4/40 + ...), its last coefficient raised for what is cut off. Q15.
    const THIRD: i64 = 5_461;
    const FIFTH: i64 = 2_458;
    const SEVENTH: i64 = 2_560;
    let series = (1 << 15) + times(square, THIRD + times(square, FIFTH + times(square, SEVENTH)));
    let asin_q15 = times(s, series);
    // pi rad are half a turn: 8192 / (pi 2^15) in Q20.
    const PHASE_OF_Q15: i64 = 83_443;
    ((asin_q15 * PHASE_OF_Q15 + (1 << 19)) >> 20) as i32
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Dubey 2006, figure 14, as `F = 1.7 (2 phase / pi)^1.82`: F in N, phase in rad, the peak at pi / 2.
    pub const FIGURE_14: Curve = Curve {
        dark_q4: 32_000,
        bright_q4: 207_000,
        force_mn: [136, 481, 1_007, 1_700, 2_551, 3_554, 4_706, 6_000],
    };

    #[test]
    fn the_phase_is_f64s_within_3_units() {
        for part in 0..=ONE {
            let exact = (f64::from(part) / f64::from(ONE)).sqrt().asin() / PI * f64::from(HALF_TURN);
            assert!((f64::from(phase_of(part)) - exact).abs() < 3.0, "{part}: {} {exact}", phase_of(part));
        }
        assert_eq!((phase_of(i32::MIN), phase_of(i32::MAX)), (0, PEAK));
    }

    #[test]
    fn the_table_is_figure_14_within_a_tenth_percent_of_full_scale() {
        let exponent = (6.0_f64 / 1.7).log2();
        for phase in 0..=HALF_TURN {
            let exact = 1_700.0 * (f64::from(phase) / f64::from(PEAK)).powf(exponent);
            let error = (f64::from(FIGURE_14.force_mn(phase)) - exact).abs();
            assert!(error < 8.0, "{phase}: {error} mN");
        }
        assert_eq!(FIGURE_14.force_mn(PEAK), 1_700);
        assert_eq!((FIGURE_14.force_mn(i32::MAX), FIGURE_14.force_mn(-1)), (6_000, 0));
    }

    #[test]
    fn a_curve_without_a_span_gives_parts_all_the_same() {
        let flat = Curve { dark_q4: 5, bright_q4: 5, ..FIGURE_14 };
        assert_eq!((flat.part(5), flat.part(i32::MAX), flat.part(i32::MIN)), (0, 2 * ONE, -ONE));
    }
}
