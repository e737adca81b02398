//! Newtons from the markers' moves, with weights that were calibrated under known loads.
//!
//! Shear is linear in how every marker moved and grew. Normal force is what the skin is spread by beside its shear: the rms of
//! the moves about their mean, its square (skin stiffens), the divergence and the mean move.

use crate::force::MIDDLE;
use crate::markers::{MARKERS_MAX, Marker};
use crate::plane_fit::PlaneFit;

/// Numbers that shear is linear in: three a marker.
pub const SHEAR_FEATURES: usize = 3 * MARKERS_MAX;
/// Numbers that normal force is linear in.
pub const NORMAL_FEATURES: usize = 4;
/// A marker's growth counts this much more than its move: it is smaller.
const GROWTH_GAIN: f32 = 5.0;
/// The least markers that say something of the skin.
const MARKERS_MIN: usize = 6;

/// Below this the markers lie on a line, and no plane goes through their moves.
const DETERMINANT_MIN: f32 = 1e-3;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Newtons {
    pub x: f32,
    pub y: f32,
    pub normal: f32,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Features {
    pub shear: [f32; SHEAR_FEATURES],
    pub normal: [f32; NORMAL_FEATURES],
}

impl Features {
    /// Features of a skin's markers; a lost one moves as the plane through the others. None if too few were found.
    pub fn of(markers: &[Marker]) -> Option<Self> {
        let known = || markers.iter().filter(|marker| marker.found.is_ok() && marker.known());
        if known().count() < MARKERS_MIN {
            return None;
        }
        let place =
            |marker: &Marker| ((marker.rest.at.x - MIDDLE.x) / 100.0, (marker.rest.at.y - MIDDLE.y) / 100.0);
        let values: [fn(&Marker) -> f32; 3] =
            [|marker| marker.moved().0, |marker| marker.moved().1, |marker| marker.growth];
        let mut planes = [[0.0; 3]; 3];
        for (plane, value) in planes.iter_mut().zip(values) {
            let mut fit = PlaneFit::default();
            known().for_each(|marker| fit.add(1.0, place(marker), value(marker)));
            *plane = fit.solve(0.0, DETERMINANT_MIN)?;
        }
        let at = |plane: &[f32; 3], (x, y): (f32, f32)| plane[0] + plane[1] * x + plane[2] * y;
        let mut shear = [0.0; SHEAR_FEATURES];
        let (mut x, mut y) = (0.0, 0.0);
        for (marker, into) in markers.iter().zip(shear.chunks_exact_mut(3)) {
            let found = marker.found.is_ok() && marker.known();
            for ((slot, plane), value) in into.iter_mut().zip(&planes).zip(values) {
                *slot = if found { value(marker) } else { at(plane, place(marker)) };
            }
            (x, y) = (x + into[0], y + into[1]);
        }
        let n = markers.len() as f32;
        let (x, y) = (x / n, y / n);
        let about = |own: &[f32]| (own[0] - x) * (own[0] - x) + (own[1] - y) * (own[1] - y);
        let spread = shear.chunks_exact(3).take(markers.len()).map(about).sum::<f32>() / n;
        shear.iter_mut().skip(2).step_by(3).for_each(|growth| *growth *= GROWTH_GAIN);
        let divergence = planes[0][1] + planes[1][2];
        Some(Self { shear, normal: [libm::sqrtf(spread), spread, divergence, libm::hypotf(x, y)] })
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Loads {
    pub shear: [[f32; 2]; SHEAR_FEATURES],
    pub normal: [f32; NORMAL_FEATURES],
}

impl Loads {
    pub fn newtons(&self, features: &Features) -> Newtons {
        let mut force = Newtons::default();
        for (weight, feature) in self.shear.iter().zip(features.shear) {
            force.x += weight[0] * feature;
            force.y += weight[1] * feature;
        }
        force.normal =
            self.normal.iter().zip(features.normal).map(|(weight, feature)| weight * feature).sum();
        force
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Point;
    use crate::markers::{RAYS, Shape};

    fn markers() -> Vec<Marker> {
        let at = |at: u16| Point { x: 60.0 + 50.0 * f32::from(at % 5), y: 40.0 + 40.0 * f32::from(at / 5) };
        let shape = |number| Shape { at: at(number), radii: [4.0; RAYS], area: 50, dark_pixels: 50 };
        (0..25).map(|number| Marker::new(shape(number))).collect()
    }

    #[test]
    fn a_marker_that_is_lost_moves_as_the_plane_through_the_others() {
        let mut markers = markers();
        for marker in &mut markers {
            let (x, y) = (marker.rest.at.x, marker.rest.at.y);
            marker.at = Point { x: x + 0.01 * x + 1.0, y: y - 0.02 * y };
        }
        let whole = Features::of(&markers).unwrap();
        assert!((whole.normal[2] - (1.0 - 2.0)).abs() < 1e-3, "{:?}", whole.normal);
        markers[7].found = Err(crate::markers::Failure::Blobs);
        markers[7].at = markers[7].rest.at;
        let without = Features::of(&markers).unwrap();
        for (a, b) in whole.shear.iter().zip(without.shear) {
            assert!((a - b).abs() < 1e-3, "{a} {b}");
        }
        markers[5..].iter_mut().for_each(|marker| marker.found = Err(crate::markers::Failure::Blobs));
        assert_eq!(Features::of(&markers), None);
    }
}
