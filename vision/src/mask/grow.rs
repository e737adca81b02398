//! Growing and shrinking a set of pixels.
//!
//! A pixel and the next, joined with the pair that begins two further on, are four; so few steps join each pixel with many. A set
//! that is joined with what lies to the right and below has first been moved to the left and up, into a margin.

use super::{BITS, HEIGHT, Mask, WORDS, Word};

/// Pixels by which a set grows at once, so that a word holds the margin.
const TIMES_MAX: usize = BITS / 2;

type Wide = [Word; WORDS + 1];

impl Mask {
    pub fn dilate(&mut self, times: usize) {
        self.spread(times, 0);
    }

    pub fn erode(&mut self, times: usize) {
        self.spread(times, Word::MAX);
    }

    fn spread(&mut self, times: usize, flip: Word) {
        for done in (0..times).step_by(TIMES_MAX) {
            let times = (times - done).min(TIMES_MAX);
            let mut tall = [[0; WORDS + 1]; HEIGHT + 2 * TIMES_MAX];
            // Rows are as much lower as they grow.
            for (wide, row) in tall[times..].iter_mut().zip(&self.rows) {
                *wide = grown_row(row.map(|word| word ^ flip), times);
            }
            for step in steps(times) {
                for y in 0..HEIGHT + 2 * times - step {
                    let below = tall[y + step];
                    tall[y].iter_mut().zip(below).for_each(|(own, below)| *own |= below);
                }
            }
            for (row, wide) in self.rows.iter_mut().zip(&tall) {
                row.iter_mut().zip(wide).for_each(|(word, wide)| *word = wide ^ flip);
            }
        }
    }
}

fn grown_row(row: [Word; WORDS], times: usize) -> Wide {
    let mut wide: Wide = std::array::from_fn(|word| {
        let own = row.get(word).map_or(0, |own| own << times);
        let left = word.checked_sub(1).map_or(0, |left| row[left] >> (BITS - times));
        own | left
    });
    for step in steps(times) {
        for word in 0..=WORDS {
            let right = wide.get(word + 1).map_or(0, |right| right << (BITS - step));
            wide[word] |= wide[word] >> step | right;
        }
    }
    wide
}

fn steps(times: usize) -> impl Iterator<Item = usize> {
    let (all, mut joined) = (2 * times + 1, 1);
    std::iter::from_fn(move || {
        let step = joined.min(all - joined);
        joined += step;
        (step > 0).then_some(step)
    })
}
