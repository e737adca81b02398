//! Structure functions of the elements' forces: the mean square of a change over a lag (Kolmogorov 1941),
//! without the change that all elements share: `n sum(q^2) - (sum q)^2` of the `n` changes `q`.
//!
//! Sliding renews contacts over a fixed distance, so the lag at which the function stops rising tells the
//! speed. The shortest lag's oldest window holds the quiet level. (Ours; not in the paper.)

use core::ops::Range;

use super::ELEMENTS;
use super::logarithm::Knee;
use super::past::{Changes, Past};

/// Slow frames. The two longest are for slow sliding, whose contacts renew themselves in 0.2 to 0.4 s.
pub const LAGS: [usize; 6] = [1, 2, 4, 8, 16, 32];
const SHORT: usize = 4;
pub const WINDOWS: usize = 6;
const EDGES: [usize; WINDOWS + 1] = [0, 1, 2, 4, 8, 16, 32];
const FRAMES: usize = EDGES[WINDOWS];
pub const STRUCTURES: usize = LAGS.len() * WINDOWS;
/// The quiet level rises by 2^-8 of itself in each slow frame, and so doubles in 2.2 s.
const QUIET_SHIFT: u32 = 8;
/// Readings until all windows of the four shorter lags are full.
pub const READY_AFTER: usize = FRAMES + LAGS[SHORT - 1];
pub const FULL_AFTER: usize = FRAMES + LAGS[LAGS.len() - 1];
/// Samples: 1 N of one element within 0.1 s. Sixteen sums of ten squares of it, times ten, fit in a `u32`.
pub const CHANGE_MAX: i32 = 1 << 10;
const _: () = assert!(
    (ELEMENTS * ELEMENTS) as u64 * (CHANGE_MAX as u64 * CHANGE_MAX as u64) * (FRAMES / 2) as u64
        <= u32::MAX as u64
);

#[derive(Clone, Debug)]
pub struct Structure {
    energies: [[u32; FRAMES]; LAGS.len()],
    newest: usize,
    sums: [[u32; WINDOWS]; LAGS.len()],
    pushed: usize,
    quiet: u32,
}

impl Default for Structure {
    fn default() -> Self {
        Self {
            energies: [[0; FRAMES]; LAGS.len()],
            newest: 0,
            sums: [[0; WINDOWS]; LAGS.len()],
            pushed: 0,
            quiet: u32::MAX,
        }
    }
}

impl Structure {
    pub fn push(&mut self, past: &Past) {
        self.push_short(past);
        self.push_long(past);
    }

    pub fn push_short(&mut self, past: &Past) {
        self.newest = (self.newest + FRAMES - 1) % FRAMES;
        self.push_lags(past, 0..SHORT);
        if self.pushed <= FRAMES {
            self.pushed += 1;
        } else {
            let [[.., level], ..] = self.sums;
            self.quiet = level.min(self.quiet.saturating_add((self.quiet >> QUIET_SHIFT) + 1));
        }
    }

    pub fn push_long(&mut self, past: &Past) {
        self.push_lags(past, SHORT..LAGS.len());
    }

    fn push_lags(&mut self, past: &Past, which: Range<usize>) {
        let of = self.energies.iter_mut().zip(&mut self.sums).zip(LAGS);
        for ((energies, sums), lag) in of.skip(which.start).take(which.len()) {
            let changed = apart(&past.changes(lag));
            let mut entering = changed;
            // The value that leaves a window enters the one behind it.
            for (sum, edge) in sums.iter_mut().zip(&EDGES[1..]) {
                let leaving = energies.get((self.newest + edge) % FRAMES).copied().unwrap_or_default();
                *sum = *sum + entering - leaving;
                entering = leaving;
            }
            if let Some(oldest) = energies.get_mut(self.newest) {
                *oldest = changed;
            }
        }
    }

    /// Clears all but the quiet level: every sum contains the lost element's last, suspect readings.
    pub fn forget(&mut self) {
        self.pushed = 0;
        self.energies = [[0; FRAMES]; LAGS.len()];
        self.sums = [[0; WINDOWS]; LAGS.len()];
    }

    /// A row for each lag, the newest window first: `n` times the sum of the squared changes about their mean,
    /// samples^2, for `n` known elements.
    pub fn sums(&self) -> &[[u32; WINDOWS]; LAGS.len()] {
        &self.sums
    }

    pub const fn quiet(&self) -> u32 {
        self.quiet
    }

    pub fn compress(&self, knees: &[Knee; WINDOWS], features: &mut [i16]) {
        for (features, sums) in features.chunks_exact_mut(WINDOWS).zip(&self.sums) {
            for ((feature, knee), &sum) in features.iter_mut().zip(knees).zip(sums) {
                *feature = knee.of(sum as f32);
            }
        }
        if let (Some(feature), Some(knee)) = (features.get_mut(WINDOWS - 1), knees.last()) {
            *feature = knee.of(self.quiet as f32);
        }
    }
}

pub fn knees(of_frame: u32) -> [Knee; WINDOWS] {
    core::array::from_fn(|window| Knee::at(of_frame * (EDGES[window + 1] - EDGES[window]) as u32))
}

#[inline]
fn apart(changes: &Changes) -> u32 {
    let (mut sum, mut squares) = (0, 0);
    for change in changes.of {
        let change = change.clamp(-CHANGE_MAX, CHANGE_MAX);
        sum += change;
        squares += change * change;
    }
    // Never negative (Cauchy and Schwarz): unknown changes are 0 and not counted.
    (changes.known * squares - sum * sum) as u32
}
