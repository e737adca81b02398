//! The connected pieces of a set of pixels, and which of them to keep.

use super::{BITS, Mask, WORDS, Word, flood};
use crate::frame::HEIGHT;

/// Pieces that [`Mask::keep_large`] tells apart.
pub const PIECES_MAX: usize = 48;

impl Mask {
    /// Keeps its connected pieces that are at least `percent` of the largest; of more than [`PIECES_MAX`] the first ones.
    pub fn keep_large(&mut self, percent: u32) {
        let mut rest = self.clone();
        let mut largest = 0;
        let mut starts = [(0, 0, 0); PIECES_MAX];
        let mut count = 0;
        while count < PIECES_MAX {
            let Some((start, piece)) = rest.take_piece() else { break };
            let area = piece.count();
            largest = largest.max(area);
            starts[count] = (start.0, start.1, area);
            count += 1;
        }
        if count < 2 {
            return;
        }
        let mut rest = std::mem::take(self);
        for &(_, _, area) in &starts[..count] {
            // Pieces come in the same order again.
            let Some((_, piece)) = rest.take_piece() else { break };
            if 100 * area >= percent * largest {
                self.unite(&piece);
            }
        }
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
        let (mut rest, mut kept, mut most) = (self.clone(), Self::EMPTY, 0);
        for _ in 0..PIECES_MAX {
            let Some((_, piece)) = rest.take_piece() else { break };
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
        let mut rest = std::mem::take(self);
        for _ in 0..PIECES_MAX {
            let Some((_, piece)) = rest.take_piece() else { break };
            if piece.comes_within(1) {
                self.unite(&piece);
            }
        }
    }

    pub fn comes_within(&self, px: usize) -> bool {
        let ends = self.rows[..px].iter().chain(&self.rows[HEIGHT - px..]).flatten().any(|&word| word != 0);
        let (left, right) = ((1 << px) - 1, Word::MAX << (BITS - px));
        ends || self.rows.iter().any(|row| row[0] & left != 0 || row[WORDS - 1] & right != 0)
    }

    fn take_piece(&mut self) -> Option<((usize, usize), Self)> {
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
        for (row, taken) in self.rows.iter_mut().zip(&piece.rows) {
            row.iter_mut().zip(taken).for_each(|(word, taken)| *word &= !taken);
        }
        Some(((y, word), piece))
    }

    /// Grows from a row into the next as far as `within` goes. Returns whether it did.
    pub(super) fn grow(&mut self, from: usize, to: usize, within: &Self) -> bool {
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
