//! Local blob detection: what is dark in a window of 30 x 30 pixels, a word of bits a row, and in how many pieces.

use crate::frame::{HEIGHT, Plane, Point, WIDTH};
use crate::mask::eight_bits;

/// Side of the window, px (FingerVision 2017, section IV).
pub const SIDE: usize = 30;
/// Blobs of a window that are told apart.
const BLOBS_MAX: usize = 12;

#[derive(Clone, Debug)]
pub struct Window {
    left: usize,
    top: usize,
    levels: [[u8; SIDE]; SIDE],
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blob {
    pub at: Point,
    pub area: u32,
    pub cut: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Levels {
    pub dark: u8,
    pub surround: u8,
}

impl Levels {
    pub const fn cut(self, eighths: u16) -> u8 {
        (self.dark as u16 + (self.surround.saturating_sub(self.dark) as u16 * eighths) / 8) as u8
    }
}

impl Window {
    pub fn around(grey: &Plane, at: Point) -> Self {
        let corner = |middle: f32, end: usize| (middle as usize).saturating_sub(SIDE / 2).min(end - SIDE);
        let (left, top) = (corner(at.x + 0.5, WIDTH), corner(at.y + 0.5, HEIGHT));
        let mut levels = [[0; SIDE]; SIDE];
        for (row, into) in levels.iter_mut().enumerate() {
            let start = (top + row) * WIDTH + left;
            into.copy_from_slice(&grey[start..start + SIDE]);
        }
        Self { left, top, levels }
    }

    pub fn levels(&self) -> Levels {
        // Steps of 4: finer than the noise, and four times fewer to add up.
        let mut counts = [0u16; 64];
        for &level in self.levels.iter().flatten() {
            counts[usize::from(level >> 2)] += 1;
        }
        let below = |wanted: u16| {
            let mut sum = 0;
            let step = counts.iter().position(|&count| {
                sum += count;
                sum > wanted
            });
            (step.unwrap_or(63) * 4 + 2) as u8
        };
        let pixels = (SIDE * SIDE) as u16;
        Levels { dark: below(pixels / 100), surround: below(pixels / 2) }
    }

    pub fn below(&self, threshold: u8) -> [u32; SIDE] {
        let mut rows = [0; SIDE];
        for (bits, levels) in rows.iter_mut().zip(&self.levels) {
            let mut below = [0u8; 32];
            below.iter_mut().zip(levels).for_each(|(below, &level)| *below = u8::from(level < threshold));
            for (place, eight) in below.as_chunks::<8>().0.iter().enumerate() {
                *bits |= u32::from(eight_bits(*eight)) << (8 * place);
            }
        }
        rows
    }

    /// The first [`BLOBS_MAX`] blobs of at least `area_min` pixels in `dark`.
    pub fn blobs(&self, dark: &[u32; SIDE], area_min: u32) -> Vec<Blob> {
        let mut rest = *dark;
        let mut found = Vec::new();
        for row in 0..SIDE {
            while rest[row] != 0 && found.len() < BLOBS_MAX {
                let piece = flood(&rest, row);
                let (mut area, mut sum_x, mut sum_y) = (0, 0, 0);
                let mut cut = (piece[0] | piece[SIDE - 1]) != 0;
                for (y, (&bits, rest)) in piece.iter().zip(&mut rest).enumerate() {
                    *rest &= !bits;
                    let count = bits.count_ones();
                    area += count;
                    sum_y += y as u32 * count;
                    let mut left = bits;
                    while left != 0 {
                        sum_x += left.trailing_zeros();
                        left &= left - 1;
                    }
                    cut |= bits & (1 | 1 << (SIDE - 1)) != 0;
                }
                if area >= area_min {
                    let middle = |sum: u32, corner: usize| sum as f32 / area as f32 + corner as f32;
                    let at = Point { x: middle(sum_x, self.left), y: middle(sum_y, self.top) };
                    found.push(Blob { at, area, cut });
                }
            }
        }
        found
    }
}

fn flood(dark: &[u32; SIDE], row: usize) -> [u32; SIDE] {
    let mut piece = [0u32; SIDE];
    piece[row] = dark[row] & dark[row].wrapping_neg();
    loop {
        let mut grown = false;
        // Down and up in turns: a convex blob is whole after one of each.
        for down in [true, false] {
            let mut carried = 0;
            for step in 0..SIDE {
                let at = if down { step } else { SIDE - 1 - step };
                let mut bits = piece[at] | carried;
                loop {
                    let wider = (bits | bits << 1 | bits >> 1) & dark[at];
                    if wider == bits & dark[at] {
                        bits = wider;
                        break;
                    }
                    bits = wider;
                }
                grown |= bits != piece[at];
                piece[at] = bits;
                carried = bits | bits << 1 | bits >> 1;
            }
        }
        if !grown {
            return piece;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::plane;

    #[test]
    fn two_discs_are_two_blobs() {
        let mut grey = plane();
        for (at, level) in grey.iter_mut().enumerate() {
            let (x, y) = ((at % WIDTH) as f32, (at / WIDTH) as f32);
            let discs = [(100.0, 100.0, 4.0), (109.0, 104.0, 3.0), (113.0, 90.0, 0.5)];
            let is_dark = discs.iter().any(|&(cx, cy, r)| libm::hypotf(x - cx, y - cy) <= r);
            *level = if is_dark { 20 } else { 200 };
        }
        let window = Window::around(&grey, Point { x: 103.0, y: 100.0 });
        assert_eq!(window.levels(), Levels { dark: 22, surround: 202 });
        let [first, second] = window.blobs(&window.below(110), 5)[..] else { panic!("two blobs") };
        assert_eq!(first, Blob { at: Point { x: 100.0, y: 100.0 }, area: 49, cut: false });
        assert_eq!(second, Blob { at: Point { x: 109.0, y: 104.0 }, area: 29, cut: false });
    }

    #[test]
    fn a_spiral_is_one_blob_and_a_full_window_ends() {
        let window = Window::around(&plane(), Point { x: 0.0, y: 239.0 });
        let full = (1 << SIDE) - 1;
        let spiral = std::array::from_fn(|row| [full, 1, full, 1 << (SIDE - 1)][row % 4]);
        for (rows, area) in [(spiral, 15 * 30 + 15), ([full; SIDE], 900)] {
            let [blob] = window.blobs(&rows, 1)[..] else { panic!("one blob") };
            assert!(blob.cut && blob.area == area, "{blob:?}");
        }
        assert!(window.blobs(&[0; SIDE], 1).is_empty());
    }
}
