//! Force and torque from the markers' moves, px (FingerVision 2017, section IV A).

use crate::frame::{HEIGHT, Point, WIDTH};
use crate::markers::Marker;

/// The middle of the picture, about which torque is taken.
pub const MIDDLE: Point = Point { x: (WIDTH - 1) as f32 / 2.0, y: (HEIGHT - 1) as f32 / 2.0 };

/// Means over the known markers, px; `x` and `y` are shear, `normal` is the size of the move (the paper's normal force).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Forces {
    pub x: f32,
    pub y: f32,
    pub normal: f32,
    /// Torque about the skin's normal, px^2.
    pub twist: f32,
}

impl Forces {
    /// The means over the markers that are known. None if there are fewer than `least`.
    pub fn of(markers: &[Marker], least: usize) -> Option<Self> {
        let (mut sum, mut count) = (Self::default(), 0);
        for marker in markers.iter().filter(|marker| marker.known()) {
            let (x, y) = marker.moved();
            let (rx, ry) = (marker.rest.at.x - MIDDLE.x, marker.rest.at.y - MIDDLE.y);
            sum.x += x;
            sum.y += y;
            sum.normal += libm::hypotf(x, y);
            sum.twist += rx * y - ry * x;
            count += 1;
        }
        let n = count as f32;
        (count >= least.max(1)).then(|| Self {
            x: sum.x / n,
            y: sum.y / n,
            normal: sum.normal / n,
            twist: sum.twist / n,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::markers::{RAYS, Shape};

    fn markers(moved: impl Fn(f32, f32) -> (f32, f32)) -> Vec<Marker> {
        (0..25)
            .map(|at| {
                let (x, y) = (MIDDLE.x + 40.0 * (at % 5 - 2) as f32, MIDDLE.y + 40.0 * (at / 5 - 2) as f32);
                let rest = Shape { at: Point { x, y }, radii: [4.0; RAYS], area: 50, dark_pixels: 50 };
                let mut marker = Marker::new(rest);
                let (dx, dy) = moved(x - MIDDLE.x, y - MIDDLE.y);
                marker.at = Point { x: x + dx, y: y + dy };
                marker
            })
            .collect()
    }

    #[test]
    fn shear_is_a_common_move_and_a_press_is_none() {
        let sheared = Forces::of(&markers(|_, _| (3.0, -4.0)), 5).unwrap();
        assert!(
            (sheared.x - 3.0).abs() < 1e-4
                && (sheared.y + 4.0).abs() < 1e-4
                && (sheared.normal - 5.0).abs() < 1e-4
        );
        assert!(sheared.twist.abs() < 0.01);
        let pressed = Forces::of(&markers(|x, y| (0.05 * x, 0.05 * y)), 5).unwrap();
        assert!(pressed.x.abs() < 1e-4 && pressed.normal > 2.0);
        let turned = Forces::of(&markers(|x, y| (-0.05 * y, 0.05 * x)), 5).unwrap();
        assert!(turned.twist > 100.0);
        assert_eq!(Forces::of(&[], 1), None);
    }
}
