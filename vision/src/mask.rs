//! A set of pixels, one bit each: growing and shrinking it are shifts of whole words.

mod pieces;

use std::ops::Range;

use crate::frame::{Frame, HEIGHT, PIXELS, Point, WIDTH};

type Word = u64;
const BITS: usize = Word::BITS as usize;
const WORDS: usize = WIDTH / BITS;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    rows: [[Word; WORDS]; HEIGHT],
}

impl Default for Mask {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Mask {
    pub const EMPTY: Self = Self { rows: [[0; WORDS]; HEIGHT] };

    fn words_mut(&mut self) -> impl Iterator<Item = &mut Word> {
        self.rows.iter_mut().flatten()
    }

    pub fn pack(&mut self, bytes: &[u8; PIXELS]) {
        self.words_mut().zip(bytes.as_chunks().0).for_each(|(word, bytes)| *word = packed(bytes));
    }

    pub fn unpack(&self, bytes: &mut [u8; PIXELS]) {
        for (word, bytes) in self.rows.iter().flatten().zip(bytes.chunks_exact_mut(BITS)) {
            for (eight, bits) in bytes.chunks_exact_mut(8).zip(word.to_le_bytes()) {
                // Byte n keeps bit n of eight copies, and becomes 1 if it is set.
                let bits = u64::from(bits).wrapping_mul(0x0101_0101_0101_0101) & 0x8040_2010_0804_0201;
                let ones = (bits + 0x7f7f_7f7f_7f7f_7f7f) >> 7 & 0x0101_0101_0101_0101;
                eight.copy_from_slice(&ones.to_le_bytes());
            }
        }
    }

    pub fn insert(&mut self, x: usize, y: usize) {
        self.rows[y][x / BITS] |= 1 << (x % BITS);
    }

    pub fn insert_block(&mut self, columns: Range<usize>, rows: Range<usize>) {
        let row: [Word; WORDS] = std::array::from_fn(|word| {
            // Those of its pixels that are in no column from here on.
            let below = |end: usize| match end.saturating_sub(BITS * word) {
                all if all >= BITS => Word::MAX,
                part => (1 << part) - 1,
            };
            below(columns.end) & !below(columns.start)
        });
        let rows = self.rows.get_mut(rows).into_iter().flatten();
        rows.for_each(|into| into.iter_mut().zip(row).for_each(|(into, word)| *into |= word));
    }

    pub const fn contains(&self, x: usize, y: usize) -> bool {
        self.rows[y][x / BITS] >> (x % BITS) & 1 != 0
    }

    pub fn count(&self) -> u32 {
        self.rows.iter().flatten().map(|word| word.count_ones()).sum()
    }

    #[inline]
    fn combine(&mut self, other: &Self, with: impl Fn(Word, Word) -> Word) {
        self.words_mut().zip(other.rows.iter().flatten()).for_each(|(own, other)| *own = with(*own, *other));
    }

    pub fn intersect(&mut self, other: &Self) {
        self.combine(other, |own, other| own & other);
    }

    pub fn subtract(&mut self, other: &Self) {
        self.combine(other, |own, other| own & !other);
    }

    pub fn unite(&mut self, other: &Self) {
        self.combine(other, |own, other| own | other);
    }

    /// Keeps and adds the pixels of which at least five of the nine around them, their own included, are in it: single pixels
    /// go, and so do gaps of one. Outside of the picture counts as outside.
    pub fn majority(&mut self) {
        let mut above = ([0; WORDS], [0; WORDS]);
        let mut here = three(&self.rows[0]);
        for y in 0..HEIGHT {
            let below = self.rows.get(y + 1).map_or(([0; WORDS], [0; WORDS]), three);
            for word in 0..WORDS {
                // Each row's count is 0 to 3: a bit of one and a bit of two.
                let (ones, carry) = full_adder(above.0[word], here.0[word], below.0[word]);
                let (twos, fours) = full_adder(above.1[word], here.1[word], below.1[word]);
                let (twos, more) = (twos ^ carry, twos & carry);
                // 4 and something, 8 or 9.
                let (fours, eights) = (fours ^ more, fours & more);
                self.rows[y][word] = eights | fours & (ones | twos);
            }
            (above, here) = (here, below);
        }
    }

    /// Adds all pixels within `times` px, along rows and columns.
    pub fn dilate(&mut self, times: usize) {
        for _ in 0..times {
            let wide = self.rows.each_ref().map(widened);
            for (y, row) in self.rows.iter_mut().enumerate() {
                let near = &wide[y.saturating_sub(1)..(y + 2).min(HEIGHT)];
                *row = std::array::from_fn(|word| near.iter().fold(0, |all, row| all | row[word]));
            }
        }
    }

    /// Keeps the pixels that have none outside of it within `times` px; beyond the picture's border nothing is outside.
    pub fn erode(&mut self, times: usize) {
        self.invert();
        self.dilate(times);
        self.invert();
    }

    pub fn thin(&mut self, keep: usize) {
        let gone = self.rows.iter_mut().enumerate().filter(|(y, _)| y % keep != 0);
        gone.for_each(|(_, row)| *row = [0; WORDS]);
    }

    pub fn invert(&mut self) {
        for word in self.words_mut() {
            *word = !*word;
        }
    }

    /// Adds what does not reach the border from outside of it.
    pub fn fill_holes(&mut self) {
        self.invert();
        self.keep_at_border();
        self.invert();
    }

    #[inline]
    pub fn keep(&mut self, frame: &Frame, kept: impl Fn(u8, u8, u8) -> bool) {
        let colours = [frame.red, frame.green, frame.blue].map(|plane| plane.as_chunks::<BITS>().0);
        for (number, word) in self.words_mut().enumerate().filter(|(_, word)| **word != 0) {
            let [red, green, blue] = colours.map(|plane| &plane[number]);
            let bytes: [u8; BITS] =
                std::array::from_fn(|bit| u8::from(kept(red[bit], green[bit], blue[bit])));
            *word &= packed(&bytes);
        }
    }

    #[inline]
    pub fn for_each(&self, mut each: impl FnMut(usize)) {
        for (number, &word) in self.rows.iter().flatten().enumerate() {
            let mut left = word;
            while left != 0 {
                each(BITS * number + left.trailing_zeros() as usize);
                left &= left - 1;
            }
        }
    }

    pub fn moments(&self) -> Option<Moments> {
        let mut sums = [0u64; 6];
        self.for_each(|at| {
            let (x, y) = ((at % WIDTH) as u64, (at / WIDTH) as u64);
            sums.iter_mut().zip([1, x, y, x * x, x * y, y * y]).for_each(|(sum, term)| *sum += term);
        });
        Moments::of(sums.map(|sum| sum as f64), Point::default())
    }
}

#[inline]
fn packed(bytes: &[u8; BITS]) -> Word {
    let eights = bytes.as_chunks::<8>().0.iter().enumerate();
    eights.map(|(place, eight)| Word::from(eight_bits(*eight)) << (8 * place)).sum()
}

#[inline]
pub(crate) fn eight_bits(bytes: [u8; 8]) -> u8 {
    // They slide into the top byte.
    (u64::from_le_bytes(bytes).wrapping_mul(0x0102_0408_1020_4080) >> 56) as u8
}

/// Each pixel's left and right neighbours.
fn beside(row: &[Word; WORDS]) -> [[Word; WORDS]; 2] {
    let left = |word: usize| row[word] << 1 | if word > 0 { row[word - 1] >> (BITS - 1) } else { 0 };
    let right = |word: usize| row[word] >> 1 | if word + 1 < WORDS { row[word + 1] << (BITS - 1) } else { 0 };
    [std::array::from_fn(left), std::array::from_fn(right)]
}

fn widened(row: &[Word; WORDS]) -> [Word; WORDS] {
    let [left, right] = beside(row);
    std::array::from_fn(|word| left[word] | row[word] | right[word])
}

fn three(row: &[Word; WORDS]) -> ([Word; WORDS], [Word; WORDS]) {
    let [left, right] = beside(row);
    let (mut ones, mut twos) = ([0; WORDS], [0; WORDS]);
    for word in 0..WORDS {
        (ones[word], twos[word]) = full_adder(left[word], row[word], right[word]);
    }
    (ones, twos)
}

const fn full_adder(a: Word, b: Word, c: Word) -> (Word, Word) {
    (a ^ b ^ c, a & b | c & (a ^ b))
}

/// The runs of `free` that hold a pixel of `seed`. An addition carries from the seed to the end of its run.
fn flood(seed: &[Word; WORDS], free: &[Word; WORDS]) -> [Word; WORDS] {
    let up = |seed: &[Word; WORDS], free: &[Word; WORDS]| {
        let (mut filled, mut carried) = ([0; WORDS], 0);
        for word in 0..WORDS {
            let start = (seed[word] | carried) & free[word];
            let (sum, over) = free[word].overflowing_add(start);
            filled[word] = free[word] & (free[word] ^ sum) | start;
            carried = Word::from(over);
        }
        filled
    };
    let mirrored = |row: &[Word; WORDS]| {
        let mut mirror = row.map(Word::reverse_bits);
        mirror.reverse();
        mirror
    };
    let right = up(seed, free);
    let left = mirrored(&up(&mirrored(seed), &mirrored(free)));
    std::array::from_fn(|word| right[word] | left[word])
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    pub area: u32,
    pub middle: Point,
    pub xx: f32,
    pub xy: f32,
    pub yy: f32,
}

impl Moments {
    /// From the sums of 1, x, y, x^2, xy and y^2 of places about `origin`. None if the first is 0.
    pub(crate) fn of([n, sx, sy, sxx, sxy, syy]: [f64; 6], origin: Point) -> Option<Self> {
        if n == 0.0 {
            return None;
        }
        let (x, y) = (sx / n, sy / n);
        Some(Self {
            area: n as u32,
            middle: Point { x: origin.x + x as f32, y: origin.y + y as f32 },
            xx: (sxx / n - x * x) as f32,
            xy: (sxy / n - x * y) as f32,
            yy: (syy / n - y * y) as f32,
        })
    }

    /// The direction of its long axis, radians from -pi/2 to pi/2, from x towards y (down).
    pub fn angle_rad(&self) -> f32 {
        0.5 * libm::atan2f(2.0 * self.xy, self.xx - self.yy)
    }

    pub fn eccentricity(&self) -> f32 {
        let both = self.xx + self.yy;
        let apart = libm::hypotf(self.xx - self.yy, 2.0 * self.xy);
        if both > 0.0 { apart / both } else { 0.0 }
    }
}

#[cfg(test)]
mod tests;
