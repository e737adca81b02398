//! Two products at a time: the dual 16-bit multiply-accumulates of the Cortex-M4.
//!
//! Stable Rust has no name for these instructions, so this is the one place of the crate with `unsafe` in it: assembly that
//! touches nothing but its operands and the arrays that it is given. Each function has a twin in plain Rust, which every
//! other machine runs; both wrap alike, and the tests on the emulated board hold one against the other.
#![allow(unsafe_code, reason = "SMLAD and SMLSD have no name in stable Rust, and cost a third")]

/// Rows that are multiplied in one go: there are registers for as many.
pub const ROWS: usize = 4;

/// Aligns an array of 16-bit numbers to 8 bytes, so that it can be read as words of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(8))]
pub struct Aligned<T>(pub T);

/// `sums[r] + sum over n of rows[r][n] inputs[n]`, wrapping.
///
/// Quick where rows and inputs begin at whole words, and a row has a multiple of four numbers, at most 508.
#[must_use]
#[inline]
pub fn dot_rows<const I: usize>(
    rows: &[[i16; I]; ROWS],
    inputs: &[i16; I],
    sums: [i32; ROWS],
) -> [i32; ROWS] {
    #[cfg(target_arch = "arm")]
    if arm::suits(rows, inputs) {
        return arm::dot_rows(rows, inputs, sums);
    }
    portable::dot_rows(rows, inputs, sums)
}

/// `sum + a[0] b[0] - a[1] b[1]`, wrapping.
#[must_use]
#[inline]
pub fn multiply_subtract(a: Pair, b: Pair, sum: i32) -> i32 {
    #[cfg(target_arch = "arm")]
    return arm::multiply_subtract(a, b, sum);
    #[cfg(not(target_arch = "arm"))]
    portable::multiply_subtract(a, b, sum)
}

/// Two 16-bit numbers in one word, the first in its lower half.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pair(u32);

impl Pair {
    /// A pair of two numbers.
    #[inline]
    pub const fn new(first: i16, second: i16) -> Self {
        Self(first as u16 as u32 | (second as u16 as u32) << 16)
    }

    /// The two numbers, the lower half first.
    #[must_use]
    pub const fn get(self) -> [i16; 2] {
        [self.0 as i16, (self.0 >> 16) as i16]
    }
}

/// The twins in plain Rust.
pub mod portable {
    use super::{Pair, ROWS};

    /// The portable twin of [`dot_rows`](super::dot_rows): `sums[r] + sum over n of rows[r][n] inputs[n]`, wrapping. It
    /// takes any length and alignment.
    #[must_use]
    pub fn dot_rows<const I: usize>(
        rows: &[[i16; I]; ROWS],
        inputs: &[i16; I],
        mut sums: [i32; ROWS],
    ) -> [i32; ROWS] {
        for (sum, row) in sums.iter_mut().zip(rows) {
            *sum = dot(row, inputs, *sum);
        }
        sums
    }

    /// `sum + sum over n of row[n] inputs[n]`, wrapping.
    #[must_use]
    pub fn dot<const I: usize>(row: &[i16; I], inputs: &[i16; I], sum: i32) -> i32 {
        // The product of two halves fits in a word, the most negative ones' included.
        row.iter().zip(inputs).fold(sum, |sum, (&w, &x)| sum.wrapping_add(i32::from(w) * i32::from(x)))
    }

    /// The portable twin of [`multiply_subtract`](super::multiply_subtract): `sum + a[0] b[0] - a[1] b[1]`, wrapping.
    #[must_use]
    pub fn multiply_subtract(a: Pair, b: Pair, sum: i32) -> i32 {
        let ([a0, a1], [b0, b1]) = (a.get(), b.get());
        sum.wrapping_add(i32::from(a0) * i32::from(b0)).wrapping_sub(i32::from(a1) * i32::from(b1))
    }
}

#[cfg(target_arch = "arm")]
mod arm {
    use core::arch::asm;

    use super::{Pair, ROWS};

    /// The largest offset of LDRD, bytes.
    const OFFSET_MAX: usize = 1_020;
    /// Steps of four inputs that are written out, at most: 52 bytes of code each.
    const UNROLLED_MAX: usize = 19;

    /// Whether [`dot_rows`] can take these rows and inputs: size and alignment.
    #[inline]
    pub fn suits<const I: usize>(rows: &[[i16; I]; ROWS], inputs: &[i16; I]) -> bool {
        let fits = const { I > 0 && I.is_multiple_of(4) && 2 * I <= OFFSET_MAX };
        let whole = |address: usize| address.is_multiple_of(4);
        fits && whole(rows.as_ptr().addr()) && whole(inputs.as_ptr().addr())
    }

    /// The most steps that can be written out so that `steps` are a multiple of them.
    const fn unrolled(steps: usize) -> usize {
        let mut most = UNROLLED_MAX;
        while !steps.is_multiple_of(most) {
            most -= 1;
        }
        most
    }

    /// The assembly of [`dot_rows`](super::dot_rows): `sums[r] + sum over n of rows[r][n] inputs[n]`, wrapping. Only
    /// for rows and inputs that [`suits`] accepts; with others it faults or sums too few numbers.
    #[inline]
    pub fn dot_rows<const I: usize>(
        rows: &[[i16; I]; ROWS],
        inputs: &[i16; I],
        sums: [i32; ROWS],
    ) -> [i32; ROWS] {
        let [mut s0, mut s1, mut s2, mut s3] = sums;
        let [row, _, row_2, _] = rows;
        // SAFETY: reads four rows of `I` halves each and `I` inputs, which is what the references stand for: each round
        // takes four of each, and there are I / 4. LDRD wants whole words, which `suits` has seen to.
        unsafe {
            asm!(
                "2:",
                ".rept {unrolled}",
                "ldrd {x0}, {x1}, [{x}], #8",
                "ldrd {w0}, {w1}, [{row}, #{stride}]",
                "smlad {s1}, {w0}, {x0}, {s1}",
                "smlad {s1}, {w1}, {x1}, {s1}",
                "ldrd {w0}, {w1}, [{row}], #8",
                "smlad {s0}, {w0}, {x0}, {s0}",
                "smlad {s0}, {w1}, {x1}, {s0}",
                "ldrd {w0}, {w1}, [{row_2}, #{stride}]",
                "smlad {s3}, {w0}, {x0}, {s3}",
                "smlad {s3}, {w1}, {x1}, {s3}",
                "ldrd {w0}, {w1}, [{row_2}], #8",
                "smlad {s2}, {w0}, {x0}, {s2}",
                "smlad {s2}, {w1}, {x1}, {s2}",
                ".endr",
                "subs {rounds}, #1",
                "bne 2b",
                unrolled = const unrolled(I / 4),
                stride = const 2 * I,
                x = inout(reg) inputs.as_ptr() => _,
                row = inout(reg) row.as_ptr() => _,
                row_2 = inout(reg) row_2.as_ptr() => _,
                rounds = inout(reg) I / 4 / unrolled(I / 4) => _,
                s0 = inout(reg) s0,
                s1 = inout(reg) s1,
                s2 = inout(reg) s2,
                s3 = inout(reg) s3,
                x0 = out(reg) _,
                x1 = out(reg) _,
                w0 = out(reg) _,
                w1 = out(reg) _,
                options(pure, readonly, nostack),
            );
        }
        [s0, s1, s2, s3]
    }

    #[inline]
    pub fn multiply_subtract(a: Pair, b: Pair, sum: i32) -> i32 {
        let result;
        // SAFETY: touches nothing but its operands.
        unsafe {
            asm!(
                "smlsd {result}, {a}, {b}, {sum}",
                result = lateout(reg) result,
                a = in(reg) a.0,
                b = in(reg) b.0,
                sum = in(reg) sum,
                options(pure, nomem, nostack, preserves_flags),
            );
        }
        result
    }
}
