//! Structure functions of the elements' forces, without the changes that all elements share.
//!
//! Where a surface slides over an element its contacts are renewed, and with them the element's share of the load; how
//! far it has to slide for that does not depend on how fast it slides. So the mean square of a force's change over a time,
//! its structure function (Kolmogorov 1941), rises with that time until the contacts are new ones, and **where it stops
//! rising tells the speed**, whatever gain, load and noise are: noise alone gives the same at every lag. The covariance of
//! changes over one frame (equations 1 to 4) sees how large they are and not how fast they come, and its window remembers a
//! slip for as long as it is long; here each lag has six windows, one behind the other, so that the end of a slip is seen too.
//!
//! Where contacts are new ones within a frame, a fast slip is as white as noise, and only the level tells them apart. So the
//! feature of the shortest lag's oldest window is its **quiet level**: its minimum, slowly forgotten. More noise
//! than a detector was trained with, from a bad supply or a motor's cable, is then no slip.
//!
//! What all elements do together, an impact or the motor, is taken off: `n sum(q^2) - (sum q)^2` of the `n` changes `q` is `n`
//! times their squares about their mean, and an integer. (Ours; the paper has no such thing.)

use core::ops::Range;

use super::ELEMENTS;
use super::logarithm::Knee;
use super::past::{Changes, Past};

/// Lags of the changes, slow frames. The two longest are for slow sliding, whose contacts renew themselves in 0.2 to 0.4 s.
pub const LAGS: [usize; 6] = [1, 2, 4, 8, 16, 32];
/// Number of short lags.
const SHORT: usize = 4;
/// Number of windows of each lag. They are 1, 1, 2, 4, 8 and 16 slow frames long, the newest first.
pub const WINDOWS: usize = 6;
/// Edges of the windows, slow frames ago: the newest change, the one before, then octaves.
const EDGES: [usize; WINDOWS + 1] = [0, 1, 2, 4, 8, 16, 32];
const FRAMES: usize = EDGES[WINDOWS];
/// Number of structure functions.
pub const STRUCTURES: usize = LAGS.len() * WINDOWS;
/// The quiet level rises by 2^-8 of itself in each slow frame, and so doubles in 2.2 s.
const QUIET_SHIFT: u32 = 8;
/// Readings until all windows of the four shorter lags are full. Half a second of silence is enough to ask of a hand that has
/// just been switched on: the longer lags' windows hold what there is, and 0 before.
pub const READY_AFTER: usize = FRAMES + LAGS[SHORT - 1];
/// Readings until all windows are full.
pub const FULL_AFTER: usize = FRAMES + LAGS[LAGS.len() - 1];

/// A change is limited to this, samples: 1 N of one element within 0.1 s. Sixteen sums of ten squares of it, times
/// ten, fit in a `u32`.
pub const CHANGE_MAX: i32 = 1 << 10;
const _: () = assert!(
    (ELEMENTS * ELEMENTS) as u64 * (CHANGE_MAX as u64 * CHANGE_MAX as u64) * (FRAMES / 2) as u64
        <= u32::MAX as u64
);

/// The structure functions of the last 32 slow frames.
#[derive(Clone, Debug)]
pub struct Structure {
    energies: [[u32; FRAMES]; LAGS.len()],
    /// Index of the newest energy of each lag.
    newest: usize,
    sums: [[u32; WINDOWS]; LAGS.len()],
    /// Number of slow frames since the start or the last `forget`, saturating.
    pushed: usize,
    quiet: u32,
}

impl Default for Structure {
    /// All changes are 0.
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
    /// Takes the newest changes.
    pub fn push(&mut self, past: &Past) {
        self.push_short(past);
        self.push_long(past);
    }

    /// Takes the changes over the four short lags: the first half of [`push`](Self::push).
    pub fn push_short(&mut self, past: &Past) {
        self.newest = (self.newest + FRAMES - 1) % FRAMES;
        self.push_lags(past, 0..SHORT);
        // The first change is to a reading that there was not.
        if self.pushed <= FRAMES {
            self.pushed += 1;
        } else {
            let [[.., level], ..] = self.sums;
            self.quiet = level.min(self.quiet.saturating_add((self.quiet >> QUIET_SHIFT) + 1));
        }
    }

    /// Takes the changes over the long lags: the second half of [`push`](Self::push).
    pub fn push_long(&mut self, past: &Past) {
        self.push_lags(past, SHORT..LAGS.len());
    }

    fn push_lags(&mut self, past: &Past, which: Range<usize>) {
        let of = self.energies.iter_mut().zip(&mut self.sums).zip(LAGS);
        for ((energies, sums), lag) in of.skip(which.start).take(which.len()) {
            let changed = apart(&past.changes(lag));
            let mut entering = changed;
            // What leaves a window enters the one behind it.
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

    /// Clears all but the quiet level: an element was lost, and every sum contains its last, suspect readings.
    pub fn forget(&mut self) {
        self.pushed = 0;
        self.energies = [[0; FRAMES]; LAGS.len()];
        self.sums = [[0; WINDOWS]; LAGS.len()];
    }

    /// Returns the sums, a row for each lag, the newest window first. Each is `n` times the sum over the window of the
    /// squared changes about their mean, samples^2; `n` is the number of elements whose change is known.
    pub fn sums(&self) -> &[[u32; WINDOWS]; LAGS.len()] {
        &self.sums
    }

    /// Returns the quiet level, in the unit of [`sums`](Self::sums): the minimum of the sum over the shortest lag's
    /// oldest window. The minimum rises by 2^-8 of itself each slow frame. It is `u32::MAX` until that window has been
    /// full.
    pub const fn quiet(&self) -> u32 {
        self.quiet
    }

    /// The sums as features, lag by lag, the quiet level in place of the window that it is of.
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

/// A knee for each window from that of a single frame.
#[must_use]
pub fn knees(of_frame: u32) -> [Knee; WINDOWS] {
    core::array::from_fn(|window| Knee::at(of_frame * (EDGES[window + 1] - EDGES[window]) as u32))
}

/// Difference between the elements: `n` times the sum of squares of their changes about the mean.
#[inline]
fn apart(changes: &Changes) -> u32 {
    let (mut sum, mut squares) = (0, 0);
    for change in changes.of {
        let change = change.clamp(-CHANGE_MAX, CHANGE_MAX);
        sum += change;
        squares += change * change;
    }
    // Never negative (Cauchy and Schwarz): what is not known is 0 and not counted.
    (changes.known * squares - sum * sum) as u32
}
