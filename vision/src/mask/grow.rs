//! Growing and shrinking a set of pixels.
//!
//! All pixels that are less than L to the right of each, joined with those from there on, are all that are less than 2 L to the right: few
//! steps are needed. A set grows to both sides if it is first moved to the left, into a margin.

use core::ops::Range;

use super::{BITS, Mask, WORDS, Word};
use crate::frame::HEIGHT;

/// Pixels by which a set grows at once: a margin of a word holds them.
const TIMES_MAX: usize = BITS / 2;
/// Rows that are joined with others at once.
const LANES: usize = 8;
/// Rows, a margin below them, and what the last of the lanes reach.
const TALL: usize = HEIGHT + 2 * TIMES_MAX + 2 * LANES;

type Row = [Word; WORDS];

impl Mask {
    /// Grows it by a pixel in all eight directions, `times` over.
    pub fn dilate(&mut self, times: usize) {
        for times in at_once(times) {
            let used = self.extent();
            self.spread(used.clone(), beyond(&used, times), times, 0);
        }
    }

    /// Shrinks it by a pixel in all eight directions, `times` over; outside of the picture counts as inside.
    pub fn erode(&mut self, times: usize) {
        // What is not in it grows.
        for times in at_once(times) {
            let used = self.extent();
            self.spread(beyond(&used, times), used, times, Word::MAX);
        }
    }

    /// The rows that are not empty, and those between them.
    fn extent(&self) -> Range<usize> {
        let is_used = |row: &Row| row.iter().fold(0, |all, word| all | word) != 0;
        let first = self.rows.iter().position(is_used).unwrap_or(HEIGHT);
        first..self.rows.iter().rposition(is_used).map_or(first, |last| last + 1)
    }

    /// Lets what is in the rows `from` grow into the rows `into`; with `flip`, what is not in them.
    fn spread(&mut self, from: Range<usize>, into: Range<usize>, times: usize, flip: Word) {
        if from.is_empty() {
            return;
        }
        let mut tall = Tall([[0; TALL]; WORDS + 1]);
        // As much lower as it grows.
        let moved = from.start + times..from.end + times;
        for (y, row) in moved.clone().zip(&self.rows[from]) {
            (0..WORDS).for_each(|word| tall.0[word][y] = row[word] ^ flip);
        }
        tall.move_left(moved.clone(), times);
        steps(times).for_each(|step| tall.join_right(moved.clone(), step));
        steps(times).for_each(|step| tall.join_below(into.start..into.end + 2 * times - step, step));
        for (y, row) in into.clone().zip(&mut self.rows[into]) {
            (0..WORDS).for_each(|word| row[word] = tall.0[word][y] ^ flip);
        }
    }
}

/// Columns of words with margins, in the order in which the compiler makes vectors of them.
struct Tall([[Word; TALL]; WORDS + 1]);

impl Tall {
    fn move_left(&mut self, rows: Range<usize>, by: usize) {
        for word in (0..=WORDS).rev() {
            let (left, own) = self.0.split_at_mut(word);
            let own = &mut own[0][rows.clone()];
            own.iter_mut().for_each(|own| *own <<= by);
            if let Some(left) = left.last() {
                own.iter_mut().zip(&left[rows.clone()]).for_each(|(own, left)| *own |= left >> (BITS - by));
            }
        }
    }

    fn join_right(&mut self, rows: Range<usize>, by: usize) {
        for word in 0..=WORDS {
            let (own, right) = self.0.split_at_mut(word + 1);
            let own = &mut own[word][rows.clone()];
            own.iter_mut().for_each(|own| *own |= *own >> by);
            if let Some(right) = right.first() {
                own.iter_mut()
                    .zip(&right[rows.clone()])
                    .for_each(|(own, right)| *own |= right << (BITS - by));
            }
        }
    }

    fn join_below(&mut self, rows: Range<usize>, by: usize) {
        for column in &mut self.0[..WORDS] {
            for y in rows.clone().step_by(LANES) {
                let Some(&below) = column[y + by..].first_chunk::<LANES>() else { continue };
                let Some(own) = column[y..].first_chunk_mut::<LANES>() else { continue };
                own.iter_mut().zip(below).for_each(|(own, below)| *own |= below);
            }
        }
    }
}

/// The same in parts that can be done at once.
fn at_once(times: usize) -> impl Iterator<Item = usize> {
    (0..times).step_by(TIMES_MAX).map(move |done| (times - done).min(TIMES_MAX))
}

/// Those rows and as many as `times` around them.
fn beyond(rows: &Range<usize>, times: usize) -> Range<usize> {
    rows.start.saturating_sub(times)..(rows.end + times).min(HEIGHT)
}

/// Steps after which each pixel is joined with the next 2 `times`.
fn steps(times: usize) -> impl Iterator<Item = usize> {
    let (all, mut joined) = (2 * times + 1, 1);
    core::iter::from_fn(move || {
        let step = joined.min(all - joined);
        joined += step;
        (step > 0).then_some(step)
    })
}
