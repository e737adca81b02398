//! Undoes an equidistant fisheye, r = f theta, place by place: only markers and the object's pixels need it.

use crate::force::MIDDLE;
use crate::frame::{PIXELS, Point, WIDTH};
use crate::mask::{Mask, Moments};

/// Beyond this angle nothing is seen, radians.
const ANGLE_MAX: f32 = 1.4;

#[derive(Clone, Debug)]
pub struct Rectifier {
    focal_px: f32,
    places: Box<[(f32, f32, f32)]>,
}

impl Rectifier {
    pub fn new(focal_px: f32) -> Self {
        let lens = Self { focal_px, places: Box::default() };
        let places: Vec<_> = (0..PIXELS)
            .map(|at| {
                let seen = Point { x: (at % WIDTH) as f32, y: (at / WIDTH) as f32 };
                let flat = lens.flat(seen);
                let r = seen.distance(MIDDLE);
                let theta = (r / focal_px).min(ANGLE_MAX);
                // Along the radius by the tangent's slope, across it by its ratio to the angle.
                let cos = libm::cosf(theta);
                let across = if theta > 1e-4 { libm::tanf(theta) / theta } else { 1.0 };
                (flat.x - MIDDLE.x, flat.y - MIDDLE.y, across / (cos * cos))
            })
            .collect();
        Self { focal_px, places: places.into_boxed_slice() }
    }

    pub fn flat(&self, seen: Point) -> Point {
        let r = seen.distance(MIDDLE);
        if r < 1e-6 {
            return seen;
        }
        let scale = self.focal_px * libm::tanf((r / self.focal_px).min(ANGLE_MAX)) / r;
        Point { x: MIDDLE.x + (seen.x - MIDDLE.x) * scale, y: MIDDLE.y + (seen.y - MIDDLE.y) * scale }
    }

    #[inline]
    pub fn place(&self, at: usize) -> Point {
        let (x, y, _) = self.places[at];
        Point { x: MIDDLE.x + x, y: MIDDLE.y + y }
    }

    /// Moments in the flat world. None of an empty set.
    pub fn moments(&self, mask: &Mask) -> Option<Moments> {
        let mut sums = [0.0f64; 6];
        mask.for_each(|at| {
            let (x, y, area) = self.places[at];
            let (x, y, area) = (f64::from(x), f64::from(y), f64::from(area));
            for (sum, term) in sums.iter_mut().zip([1.0, x, y, x * x, x * y, y * y]) {
                *sum += term * area;
            }
        });
        Moments::of(sums, MIDDLE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_bar_is_straight_again() {
        let lens = Rectifier::new(200.0);
        // Every pixel whose flat place is in a slanted bar off the middle.
        let (sin, cos) = (libm::sinf(0.6), libm::cosf(0.6));
        let mut mask = Mask::EMPTY;
        for at in 0..PIXELS {
            let flat = lens.flat(Point { x: (at % WIDTH) as f32, y: (at / WIDTH) as f32 });
            let (dx, dy) = (flat.x - 250.0, flat.y - 160.0);
            if (dx * cos + dy * sin).abs() < 90.0 && (dy * cos - dx * sin).abs() < 15.0 {
                mask.insert(at % WIDTH, at / WIDTH);
            }
        }
        let flat = lens.moments(&mask).unwrap();
        assert!((flat.angle_rad() - 0.6).abs() < 0.01, "{}", flat.angle_rad());
        assert!(
            flat.middle.distance(Point { x: 250.0, y: 160.0 }) < 0.5 && (flat.area as i32 - 5400).abs() < 100
        );
        assert!(
            (mask.moments().unwrap().angle_rad() - 0.6).abs() > 0.02,
            "the control: the picture's own is off"
        );
    }
}
