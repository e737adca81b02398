//! SMLAD, two 16-bit products and a sum in one instruction of the Cortex-M4, which stable Rust has no name for. Other machines sum the
//! same integers one by one. A crate of its own, for `tenax-logic` forbids `unsafe`: without it the array's network makes ticks late.
#![no_std]

/// Rows that are multiplied at once: there are registers for as many.
pub const ROWS: usize = 4;

/// Aligned to words of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(8))]
pub struct Aligned<T>(pub T);

/// `sums[r] + sum over n of rows[r][n] inputs[n]`, wrapping. Quick where rows begin at whole words and have a multiple of four numbers,
/// at most 508.
#[must_use]
#[inline]
pub fn dot_rows<const I: usize>(
    rows: &[[i16; I]; ROWS],
    inputs: &Aligned<[i16; I]>,
    sums: [i32; ROWS],
) -> [i32; ROWS] {
    #[cfg(target_arch = "arm")]
    if arm::suits(rows) {
        return arm::dot_rows(rows, inputs, sums);
    }
    let mut sums = sums;
    for (sum, row) in sums.iter_mut().zip(rows) {
        *sum = dot(row, &inputs.0, *sum);
    }
    sums
}

/// `sum + sum over n of row[n] inputs[n]`, wrapping, one product after the other.
#[must_use]
#[inline]
pub fn dot<const I: usize>(row: &[i16; I], inputs: &[i16; I], sum: i32) -> i32 {
    row.iter().zip(inputs).fold(sum, |sum, (&w, &x)| sum.wrapping_add(i32::from(w) * i32::from(x)))
}

#[cfg(target_arch = "arm")]
mod arm {
    use core::arch::asm;

    use super::{Aligned, ROWS};

    /// The largest offset of LDRD, bytes.
    const OFFSET_MAX: usize = 1_020;
    /// Steps of four inputs that are written out, at most: 52 bytes of code each.
    const UNROLLED_MAX: usize = 19;

    #[inline]
    pub fn suits<const I: usize>(rows: &[[i16; I]; ROWS]) -> bool {
        let fits = const { I > 0 && I.is_multiple_of(4) && 2 * I <= OFFSET_MAX };
        fits && rows.as_ptr().addr().is_multiple_of(4)
    }

    /// The most steps that can be written out so that `steps` are a multiple of them.
    const fn unrolled(steps: usize) -> usize {
        let mut most = UNROLLED_MAX;
        while !steps.is_multiple_of(most) {
            most -= 1;
        }
        most
    }

    /// Only for rows that [`suits`] accepts: with others it faults or sums too few numbers.
    #[inline]
    pub fn dot_rows<const I: usize>(
        rows: &[[i16; I]; ROWS],
        inputs: &Aligned<[i16; I]>,
        sums: [i32; ROWS],
    ) -> [i32; ROWS] {
        let [mut s0, mut s1, mut s2, mut s3] = sums;
        let [row, _, row_2, _] = rows;
        // SAFETY: reads four rows of `I` halves each and `I` inputs, which is what the references stand for: each round takes four of
        // each, and there are I / 4. LDRD wants whole words, which `suits` and `Aligned` see to.
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
                x = inout(reg) inputs.0.as_ptr() => _,
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
}
