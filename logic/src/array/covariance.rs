//! Sliding covariance of the elements' differences (Bamshad 2023, equations 3 and 4, without the means). A new
//! column adds its outer product and the oldest takes its own away, in integers: nothing drifts.

use super::{COVARIANCE_WINDOW, COVARIANCES, ELEMENTS};

/// Covariance over the last [`COVARIANCE_WINDOW`] differences, samples^2.
#[derive(Clone, Debug)]
pub struct SlidingCovariance {
    window: [[i16; ELEMENTS]; COVARIANCE_WINDOW],
    oldest: usize,
    entries: [i32; COVARIANCES],
}

impl Default for SlidingCovariance {
    fn default() -> Self {
        Self { window: [[0; ELEMENTS]; COVARIANCE_WINDOW], oldest: 0, entries: [0; COVARIANCES] }
    }
}

impl SlidingCovariance {
    /// d_max of equation 2: the largest power of two of which ten squares fit in an `i32`, 8 N of one element in
    /// 12.5 ms. A running maximum would make one impact deafen the detector.
    pub const D_MAX: i32 = 1 << (i32::MAX as u32 / COVARIANCE_WINDOW as u32).isqrt().ilog2();

    /// Each difference is clamped to -[`D_MAX`](Self::D_MAX)..=`D_MAX - 1` samples.
    #[inline]
    pub fn push(&mut self, differences: &[i32; ELEMENTS]) {
        let new = differences.map(|d| d.clamp(-Self::D_MAX, Self::D_MAX - 1) as i16);
        let Some(column) = self.window.get_mut(self.oldest) else { return };
        let old = core::mem::replace(column, new);
        self.oldest = if self.oldest + 1 < COVARIANCE_WINDOW { self.oldest + 1 } else { 0 };
        let product = |column: &[i16; ELEMENTS], row: usize, other: usize| {
            i32::from(column[row]) * i32::from(column[other])
        };
        // The oldest goes first: with the newest besides, the sum could leave an `i32`.
        self.each_entry(|entry, row, other| entry - product(&old, row, other) + product(&new, row, other));
    }

    /// One pass for all of `gone`, so that ten lost elements cost no more than one.
    pub fn forget(&mut self, gone: &[bool; ELEMENTS]) {
        for column in &mut self.window {
            for (difference, &gone) in column.iter_mut().zip(gone) {
                *difference = if gone { 0 } else { *difference };
            }
        }
        self.each_entry(|entry, row, other| if gone[row] || gone[other] { 0 } else { entry });
    }

    #[inline]
    fn each_entry(&mut self, change: impl Fn(i32, usize, usize) -> i32) {
        let mut entries = self.entries.iter_mut();
        for row in 0..ELEMENTS {
            for other in row..ELEMENTS {
                let Some(entry) = entries.next() else { return };
                *entry = change(*entry, row, other);
            }
        }
    }

    /// On and above the diagonal, row by row: (1,1), (1,2) .. (1,10), (2,2) .. (10,10).
    pub fn entries(&self) -> &[i32; COVARIANCES] {
        &self.entries
    }
}
