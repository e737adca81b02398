//! How an object moves from one picture to the next: one move for all of its pixels, by least squares on the brightness
//! (Lucas and Kanade 1981), without looking for points.

use crate::frame::{HEIGHT, Plane, WIDTH};
use crate::mask::Mask;

/// A move, px a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flow {
    /// To the right.
    pub x: f32,
    /// Down.
    pub y: f32,
}

/// Slope below which a pixel is noise, grey levels over two pixels.
const SLOPE_MIN: i32 = 8;
/// Pixels with a slope that are needed.
const PIXELS_MIN: u32 = 60;

/// The move that best explains how the pixels of `object` changed. None if they are too plain for that. Right for moves of a
/// pixel or two; larger ones come out too small, with the right sign.
#[must_use]
pub fn flow(before: &Plane, now: &Plane, object: &Mask) -> Option<Flow> {
    let (mut xx, mut xy, mut yy, mut xt, mut yt) = (0i64, 0i64, 0i64, 0i64, 0i64);
    let mut count = 0;
    object.for_each(|at| {
        let (x, y) = (at % WIDTH, at / WIDTH);
        if x == 0 || y == 0 || x == WIDTH - 1 || y == HEIGHT - 1 {
            return;
        }
        let level = |plane: &Plane, at: usize| i32::from(plane[at]);
        // The slope of both pictures: of one alone it would be off by half the move.
        let slope = |after: usize, first: usize| {
            (level(now, after) - level(now, first) + level(before, after) - level(before, first)) / 2
        };
        let (gx, gy) = (slope(at + 1, at - 1), slope(at + WIDTH, at - WIDTH));
        if gx.abs() + gy.abs() < SLOPE_MIN {
            return;
        }
        let change = level(now, at) - level(before, at);
        count += 1;
        (xx, xy, yy) = (xx + i64::from(gx * gx), xy + i64::from(gx * gy), yy + i64::from(gy * gy));
        (xt, yt) = (xt - i64::from(gx * change), yt - i64::from(gy * change));
    });
    let (xx, xy, yy, xt, yt) = (xx as f32, xy as f32, yy as f32, xt as f32, yt as f32);
    let det = xx * yy - xy * xy;
    if count < PIXELS_MIN || det < 0.02 * xx * yy {
        return None;
    }
    // Slopes are over two pixels.
    Some(Flow { x: 2.0 * (xt * yy - yt * xy) / det, y: 2.0 * (yt * xx - xt * xy) / det })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::plane;

    fn draw(x: f32, y: f32, into: &mut Plane) {
        for (at, level) in into.iter_mut().enumerate() {
            let (px, py) = ((at % WIDTH) as f32 - x, (at / WIDTH) as f32 - y);
            *level = (128.0 + 50.0 * libm::sinf(px / 5.0) + 50.0 * libm::cosf(py / 6.0)) as u8;
        }
    }

    #[test]
    fn a_move_is_measured_and_a_plain_object_says_nothing() {
        let (mut before, mut now) = (plane(), plane());
        let mut object = Mask::EMPTY;
        (60..180).for_each(|y| (80..240).for_each(|x| object.insert(x, y)));
        draw(0.0, 0.0, &mut before);
        assert_eq!(flow(&plane(), &plane(), &object), None);
        for (x, y) in [(0.0, 0.0), (0.5, -0.3), (-1.0, 1.5), (0.0, 2.0)] {
            draw(x, y, &mut now);
            let found = flow(&before, &now, &object).unwrap();
            assert!((found.x - x).abs() < 0.1 && (found.y - y).abs() < 0.15, "{x} {y}: {found:?}");
        }
    }
}
