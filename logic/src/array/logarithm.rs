//! Logarithmic scale of the features: the bits of an IEEE 754 number, read as an integer, are its base-2
//! logarithm, at most 0.086 too small (Mitchell 1962). Below `knee` the scale is linear.

/// Fraction bits of a feature: 2^9 is one doubling of a power, 2^10 one of an amplitude.
pub const FEATURE_Q: u32 = 9;
const SINGLE_Q: u32 = 23;

/// Value, samples^2, below which the scale is about linear and above which it is logarithmic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knee {
    value: f32,
    bits: i32,
}

impl Knee {
    pub const fn at(value: u32) -> Self {
        let value = if value == 0 { 1.0 } else { value as f32 };
        Self { value, bits: value.to_bits() as i32 }
    }

    /// `log2(1 + magnitude / knee)`, Q9, rounded down, below 2^15. `magnitude` is 0 to 2^62 times the knee.
    #[inline]
    pub fn of(self, magnitude: f32) -> i16 {
        (((magnitude + self.value).to_bits() as i32 - self.bits) >> (SINGLE_Q - FEATURE_Q)) as i16
    }

    #[inline]
    pub fn signed(self, value: i32) -> i16 {
        let size = self.of(value.unsigned_abs() as f32);
        if value < 0 { -size } else { size }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values() -> impl Iterator<Item = u32> {
        (0..31)
            .flat_map(|bit| [1u32 << bit, (1 << bit) + 1, (1 << bit) | (1 << bit >> 1)])
            .chain([0, u32::MAX])
    }

    #[test]
    fn it_is_the_logarithm_within_mitchells_error() {
        for knee in [1, 3, 128, 4_096, 1 << 20] {
            for value in values() {
                let found = f64::from(Knee::at(knee).of(value as f32)) / 512.0;
                let exact = (1.0 + f64::from(value) / f64::from(knee)).log2();
                // Mitchell's 0.0861 at either end, a step of Q9 and the rounding of a single.
                assert!(
                    (found - exact).abs() < 0.0861 + 1.0 / 512.0 + 1e-5,
                    "{value} {knee}: {found} {exact}"
                );
            }
        }
        assert_eq!(Knee::at(0), Knee::at(1));
        assert!(Knee::at(1).signed(i32::MIN) < -15_000 && Knee::at(1).signed(i32::MAX) > 15_000);
    }
}
