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
