//! The connected pieces of a set of pixels, and which of them to keep.

use super::{BITS, Mask, WORDS, Word, flood};
use crate::frame::HEIGHT;

/// Pieces that are compared; of more, the first ones.
const PIECES_MAX: usize = 48;

impl Mask {
    /// Keeps its connected pieces that are at least `percent` of the largest.
    pub fn keep_large(&mut self, percent: u32) {
        let pieces: Vec<(Self, u32)> =
            self.pieces().take(PIECES_MAX).map(|piece| (piece.clone(), piece.count())).collect();
        let largest = pieces.iter().map(|(_, area)| *area).max().unwrap_or(0);
        *self = Self::EMPTY;
        let large = pieces.iter().filter(|(_, area)| 100 * area >= percent * largest);
        large.for_each(|(piece, _)| self.unite(piece));
    }

    /// Takes out what is at most twice `half_px` wide, unless that is most of it: a thin object is no spur.
    pub fn cut_spurs(&mut self, half_px: usize) {
        let mut broad = self.clone();
        broad.erode(half_px);
        broad.dilate(half_px + 1);
        broad.intersect(self);
        if 2 * broad.count() > self.count() {
            *self = broad;
        }
    }

    /// Keeps the piece that has the most pixels in `by`, and what is at most `apart_px` from it, or from what is kept.
    pub fn keep_together(&mut self, by: &Self, apart_px: usize) {
        let (mut kept, mut most) = (Self::EMPTY, 0);
        for piece in self.pieces().take(PIECES_MAX) {
            let mut shared = piece.clone();
            shared.intersect(by);
            if shared.count() > most {
                (kept, most) = (piece, shared.count());
            }
        }
        let mut count = 0;
        while kept != *self && kept.count() > count {
            count = kept.count();
            kept.dilate(apart_px);
            kept.intersect(self);
        }
        *self = kept;
    }

    pub fn keep_at_border(&mut self) {
        let pieces = self.pieces();
        *self = Self::EMPTY;
        pieces.filter(|piece| piece.comes_within(1)).for_each(|piece| self.unite(&piece));
    }

    pub fn comes_within(&self, px: usize) -> bool {
        let ends = self.rows[..px].iter().chain(&self.rows[HEIGHT - px..]).flatten().any(|&word| word != 0);
        let (left, right) = ((1 << px) - 1, Word::MAX << (BITS - px));
        ends || self.rows.iter().any(|row| row[0] & left != 0 || row[WORDS - 1] & right != 0)
    }

    fn pieces(&self) -> impl Iterator<Item = Self> + use<> {
        let mut rest = self.clone();
        std::iter::from_fn(move || rest.take_piece())
    }

    fn take_piece(&mut self) -> Option<Self> {
        let (y, word) = (0..HEIGHT)
            .find_map(|y| self.rows[y].iter().position(|&word| word != 0).map(|word| (y, word)))?;
        let mut piece = Self::EMPTY;
        let mut seed = [0; WORDS];
        seed[word] = self.rows[y][word] & self.rows[y][word].wrapping_neg();
        piece.rows[y] = flood(&seed, &self.rows[y]);
        // Rows between which it may still grow.
        let (mut top, mut bottom) = (y, y);
        let mut grown = true;
        while grown {
            grown = false;
            while bottom + 1 < HEIGHT && piece.grow(bottom, bottom + 1, self) {
                (bottom, grown) = (bottom + 1, true);
            }
            for from in top..bottom {
                grown |= piece.grow(from, from + 1, self);
            }
            for from in (top + 1..=bottom).rev() {
                grown |= piece.grow(from, from - 1, self);
            }
            while top > 0 && piece.grow(top, top - 1, self) {
                (top, grown) = (top - 1, true);
            }
        }
        self.subtract(&piece);
        Some(piece)
    }

    /// Grows from a row into the next as far as `within` goes. Returns whether it did.
    fn grow(&mut self, from: usize, to: usize, within: &Self) -> bool {
        let (mut seed, mut new) = (self.rows[to], 0);
        for (word, seed) in seed.iter_mut().enumerate() {
            let reached = self.rows[from][word] & within.rows[to][word];
            new |= reached & !*seed;
            *seed |= reached;
        }
        if new != 0 {
            self.rows[to] = flood(&seed, &within.rows[to]);
        }
        new != 0
    }
}
