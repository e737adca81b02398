//! The integer arithmetic that the network and its activations share.

/// Upper half of a 64-bit product: one UMULL.
pub const fn high_product(a: u32, b: u32) -> u32 {
    ((a as u64 * b as u64) >> 32) as u32
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reciprocal {
    /// Leading zeros of the number: shifted left by them it is `m` in `0.5..1` (Q32).
    pub shift: u32,
    /// `1 / m`, in `1..=2`, Q30. Never above the true value, and less than 2^-27 below it.
    pub mantissa: u32,
}

impl Reciprocal {
    /// 0 counts as 1. One hardware division gives 16 bits, one Newton step the rest.
    pub const fn of(number: u32) -> Self {
        let number = if number == 0 { 1 } else { number };
        let shift = number.leading_zeros();
        let m = number << shift;
        // In 2^15..2^16. The `|` repeats its highest bit for the compiler, which then knows that it is not 0.
        let coarse = m >> 16 | 1 << 15;
        // In 2^16..2^17, and in Q30 below 2^31.
        let rough = (u32::MAX / coarse) << 14;
        // m * rough is within 2^-14 of 1, so 2 minus it is in 0..2, Q30. The product is rounded down, hence one unit more.
        let correction = (1 << 31) - 1 - high_product(m, rough);
        Self { shift, mantissa: ((rough as u64 * correction as u64) >> 30) as u32 }
    }

    /// `part / number` for a part that is not larger, Q30. Never above the true value.
    pub const fn ratio(self, part: u32) -> u32 {
        high_product(part << self.shift, self.mantissa)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reciprocal_is_never_above_and_hardly_below() {
        let numbers = (0..32).flat_map(|bit| [1u32 << bit, (1 << bit) + 1, (1 << bit) | (1 << bit >> 1)]);
        let spread = (1..200_000u32).map(|n| n.wrapping_mul(0x9E37_79B9)).filter(|&n| n > 0);
        for number in numbers.chain(spread).chain([u32::MAX, u32::MAX - 1, 0xFFFF, 0x1_FFFF]) {
            let found = Reciprocal::of(number);
            let exact = 2f64.powi(32 - found.shift as i32) / f64::from(number);
            let error = exact - f64::from(found.mantissa) / 2f64.powi(30);
            assert!((0.0..2f64.powi(-27)).contains(&error), "{number}: {error:e}");
        }
        assert_eq!(Reciprocal::of(0), Reciprocal::of(1));
    }
}
