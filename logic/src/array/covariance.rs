//! Sliding covariance of the elements' differences (Bamshad 2023, equations 3 and 4).
//!
//! `X` has one row an element and one column for each of the last `N` slow frames; `X X^T` is symmetric, so its 55 entries
//! on and above the diagonal say everything. (The means are not taken off: equation 4 does not.) A new column adds its
//! outer product and the oldest takes its own away: exact, so nothing drifts.

use super::dual::{Pair, multiply_subtract};
use super::{COVARIANCES, ELEMENTS};

/// The covariance over the last `N` differences, 40 at most, samples^2.
#[derive(Clone, Debug)]
pub struct SlidingCovariance<const N: usize> {
    window: [[i16; ELEMENTS]; N],
    /// The oldest column of the window.
    oldest: usize,
    entries: [i32; COVARIANCES],
}

impl<const N: usize> Default for SlidingCovariance<N> {
    /// All differences are 0.
    fn default() -> Self {
        const { assert!(N >= 1 && N <= 40, "a window of 1 to 40 differences") }
        Self { window: [[0; ELEMENTS]; N], oldest: 0, entries: [0; COVARIANCES] }
    }
}

impl<const N: usize> SlidingCovariance<N> {
    /// d_max of equation 2, samples: a fixed full scale, the largest power of two of which `N` squares fit in an `i32`. For
    /// 10 it is 2^13, 1.65 V or 8 N of one element in 12.5 ms, which no hand does.
    ///
    /// A power of two makes a difference in samples a normalised one, in Q13, as it stands. A running maximum instead would
    /// make one impact deafen the detector for as long as it is remembered.
    pub const D_MAX: i32 = 1 << (i32::MAX as u32 / N as u32).isqrt().ilog2();

    /// Adds the newest differences, samples, and drops the oldest. Each is clamped to -[`D_MAX`](Self::D_MAX)..=`D_MAX - 1`.
    #[inline]
    pub fn push(&mut self, differences: &[i32; ELEMENTS]) {
        let new = differences.map(|d| d.clamp(-Self::D_MAX, Self::D_MAX - 1) as i16);
        let Some(column) = self.window.get_mut(self.oldest) else { return };
        let old = core::mem::replace(column, new);
        self.oldest = if self.oldest + 1 < N { self.oldest + 1 } else { 0 };
        let pairs: [Pair; ELEMENTS] = core::array::from_fn(|n| Pair::new(new[n], old[n]));
        let mut entries = self.entries.iter_mut();
        for row in 0..ELEMENTS {
            for other in row..ELEMENTS {
                let Some(entry) = entries.next() else { return };
                *entry = multiply_subtract(pairs[row], pairs[other], *entry);
            }
        }
    }

    /// Sets the differences of the elements `gone` to 0 in the whole window: their last readings are suspect. One pass, so
    /// that ten lost elements cost no more than one.
    pub fn forget(&mut self, gone: &[bool; ELEMENTS]) {
        for column in &mut self.window {
            for (difference, &gone) in column.iter_mut().zip(gone) {
                *difference = if gone { 0 } else { *difference };
            }
        }
        let mut entries = self.entries.iter_mut();
        for row in 0..ELEMENTS {
            for other in row..ELEMENTS {
                let Some(entry) = entries.next() else { return };
                *entry = if gone[row] || gone[other] { 0 } else { *entry };
            }
        }
    }

    /// The entries on and above the diagonal, row by row: (1,1), (1,2) .. (1,10), (2,2) .. (10,10).
    pub fn entries(&self) -> &[i32; COVARIANCES] {
        &self.entries
    }
}
