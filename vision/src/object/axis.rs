//! The direction of an object's long axis from its two long rims: the lines that most of the outermost pixels of slices across it lie on.
//! Unlike second moments they do not turn when a corner is missing or a spot of the background is taken for the object.

use crate::frame::{Point, WIDTH};
use crate::mask::{Mask, Moments};
use crate::rectify::Rectifier;

/// Below this eccentricity an object has no long rims.
const ECCENTRICITY_MIN: f32 = 0.1;
const SLICE_PX: f32 = 2.0;
const SLICES: usize = 256;
/// Slices without which there is no rim.
const SLICES_MIN: usize = 16;
/// A part of the slices at each end belongs to the short rims: one of so many.
const END: usize = 12;
const NEAR_PX: f32 = 2.5;
/// Share of the slices that must lie on a line for it to be a rim.
const SHARE_MIN: f32 = 0.25;
/// Largest angle between a rim and the moments' direction, radians.
const OFF_MAX: f32 = 1.0;
/// Share of the outline on the rims below which something may lean on the object and have turned the moments.
const SHARE_CLEAR: f32 = 0.75;
/// Directions in which rims are then looked for too, radians from that of the moments.
const ASIDE: [f32; 2] = [-0.5, 0.5];
/// Outermost pixels that are looked at.
const PLACES_MAX: usize = 2048;
/// Times that the slices are cut anew, across the axis that was found.
const ROUNDS: usize = 3;
const STEPS: usize = 6;

/// Points of a rim along and across the axis, px.
struct Rim(Vec<(f32, f32)>);

/// A line: its slope, how well that is known, and the share of the points that lie on it.
#[derive(Clone, Copy)]
struct Line {
    slope: f32,
    weight: f32,
    share: f32,
}

/// The direction of the long axis, radians from -pi/2 to pi/2, from x towards y (down): that of the long rims if there are such,
/// else that of `moments`. Behind a lens it is that of the flat world, as the moments are.
pub fn find(object: &Mask, moments: &Moments, lens: Option<&Rectifier>) -> Rims {
    let coarse = moments.angle_rad();
    let none = Rims { angle: coarse, share: 0.0 };
    if moments.eccentricity() < ECCENTRICITY_MIN {
        return none;
    }
    let outline = outline(object, moments.middle, lens);
    let mut best = Rims::of(&outline, coarse);
    if best.share < SHARE_CLEAR {
        for aside in ASIDE {
            let other = Rims::of(&outline, coarse + aside);
            if other.share > best.share {
                best = other;
            }
        }
    }
    if best.share == 0.0 || (best.angle - coarse).abs() > OFF_MAX {
        return none;
    }
    let half = std::f32::consts::FRAC_PI_2;
    let angle = match best.angle {
        angle if angle > half => angle - 2.0 * half,
        angle if angle < -half => angle + 2.0 * half,
        angle => angle,
    };
    Rims { angle, ..best }
}

/// The direction of both long rims, radians, and the share of the outline that lies on them.
#[derive(Clone, Copy)]
pub struct Rims {
    pub angle: f32,
    /// 0: there are none, and the direction is that of the moments.
    pub share: f32,
}

/// Outermost pixels from `middle`, px.
fn outline(object: &Mask, middle: Point, lens: Option<&Rectifier>) -> Vec<(f32, f32)> {
    let (mut inside, mut rim) = (object.clone(), object.clone());
    inside.erode(1);
    rim.subtract(&inside);
    let mut places = Vec::new();
    rim.for_each(|at| {
        let flat = || Point { x: (at % WIDTH) as f32, y: (at / WIDTH) as f32 };
        let place = lens.map_or_else(flat, |lens| lens.place(at));
        places.push((place.x - middle.x, place.y - middle.y));
    });
    places.truncate(PLACES_MAX);
    places
}

impl Rims {
    fn of(outline: &[(f32, f32)], from: f32) -> Self {
        let mut rims = Self { angle: from, share: 0.0 };
        for _ in 0..ROUNDS {
            let Some((slope, share)) = slope(outline, rims.angle) else { return Self { share: 0.0, ..rims } };
            rims = Self { angle: rims.angle + libm::atanf(slope), share };
        }
        rims
    }
}

/// Lean of both rims from the direction `angle`, and their share. None without rims.
fn slope(outline: &[(f32, f32)], angle: f32) -> Option<(f32, f32)> {
    let (sin, cos) = (libm::sinf(angle), libm::cosf(angle));
    let (mut low, mut high) = ([f32::INFINITY; SLICES], [f32::NEG_INFINITY; SLICES]);
    for (dx, dy) in outline {
        let (along, across) = (dx * cos + dy * sin, dy * cos - dx * sin);
        let slice = along / SLICE_PX + SLICES as f32 / 2.0;
        if (0.0..SLICES as f32).contains(&slice) {
            let slice = slice as usize;
            (low[slice], high[slice]) = (low[slice].min(across), high[slice].max(across));
        }
    }
    let (low, high) = (Rim::of(&low)?.line(), Rim::of(&high)?.line());
    let share = [low, high].iter().flatten().map(|line| line.share).sum::<f32>() / 2.0;
    let slope = match (low, high) {
        (Some(low), Some(high)) => {
            // The straighter rim says more.
            let (a, b) = (low.weight * low.weight, high.weight * high.weight);
            (low.slope * a + high.slope * b) / (a + b)
        }
        (low, high) => low.or(high)?.slope,
    };
    Some((slope, share))
}

impl Rim {
    /// The points between the ends. None of an object that is too short.
    fn of(outermost: &[f32; SLICES]) -> Option<Self> {
        let is_there = |across: &f32| across.is_finite();
        let first = outermost.iter().position(is_there)?;
        let last = outermost.iter().rposition(is_there)?;
        let end = (last - first) / END;
        let inner = outermost.iter().enumerate().take(last.saturating_sub(end)).skip(first + end);
        let points = inner.filter(|(_, across)| is_there(across));
        let along = |slice: usize| (slice as f32 - SLICES as f32 / 2.0) * SLICE_PX;
        let points: Vec<_> = points.map(|(slice, &across)| (along(slice), across)).collect();
        (points.len() >= SLICES_MIN).then_some(Self(points))
    }

    /// The line that most of the points lie on, None if they lie on none.
    fn line(&self) -> Option<Line> {
        let (mut slope, mut offset) = self.coarse();
        let (mut weight, mut near) = (0.0, 0);
        for _ in 0..STEPS {
            let (mut w, mut wx, mut wy, mut wxx, mut wxy) = (0.0, 0.0, 0.0, 0.0, 0.0);
            near = 0;
            for &(x, y) in &self.0 {
                let off = (y - offset - slope * x) / NEAR_PX;
                if off.abs() < 1.0 {
                    // Tukey's weight: full on the line, none far from it.
                    let own = (1.0 - off * off) * (1.0 - off * off);
                    (w, wx, wy) = (w + own, wx + own * x, wy + own * y);
                    (wxx, wxy) = (wxx + own * x * x, wxy + own * x * y);
                    near += 1;
                }
            }
            let det = w * wxx - wx * wx;
            if det <= 1.0 {
                return None;
            }
            slope = (w * wxy - wx * wy) / det;
            offset = (wy - slope * wx) / w;
            weight = det / w;
        }
        let share = near as f32 / self.0.len() as f32;
        (share >= SHARE_MIN).then_some(Line { slope, weight, share })
    }

    fn coarse(&self) -> (f32, f32) {
        let (mut best, count) = ((0, 0.0, 0.0), self.0.len());
        for reach in [count / 3, count / 2, 2 * count / 3] {
            for a in (0..count - reach).step_by(2) {
                let (a, b) = (self.0[a], self.0[a + reach]);
                let slope = (b.1 - a.1) / (b.0 - a.0);
                let offset = a.1 - slope * a.0;
                let is_near = |point: &&(f32, f32)| (point.1 - offset - slope * point.0).abs() < NEAR_PX;
                let near = self.0.iter().filter(is_near).count();
                if near > best.0 {
                    best = (near, slope, offset);
                }
            }
        }
        (best.1, best.2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::PIXELS;

    fn bar(angle: f32, half: (f32, f32), more: impl Fn(f32, f32, bool) -> bool) -> Mask {
        let (sin, cos) = (libm::sinf(angle), libm::cosf(angle));
        let mut mask = Mask::EMPTY;
        for at in 0..PIXELS {
            let (dx, dy) = ((at % WIDTH) as f32 - 160.0, (at / WIDTH) as f32 - 120.0);
            let (along, across) = (dx * cos + dy * sin, dy * cos - dx * sin);
            if more(along, across, along.abs() < half.0 && across.abs() < half.1) {
                mask.insert(at % WIDTH, at / WIDTH);
            }
        }
        mask
    }

    fn off(angle: f32, mask: &Mask) -> (f32, f32) {
        let moments = mask.moments().unwrap();
        let wrapped = |off: f32| off - std::f32::consts::PI * libm::roundf(off / std::f32::consts::PI);
        (
            wrapped(find(mask, &moments, None).angle - angle).to_degrees().abs(),
            wrapped(moments.angle_rad() - angle).to_degrees().abs(),
        )
    }

    #[test]
    fn a_bar_lies_as_it_lies_at_every_angle() {
        for angle in [-1.57, -1.2, -0.4, 0.0, 0.3, 0.8, 1.5] {
            let (rims, _) = off(angle, &bar(angle, (80.0, 20.0), |_, _, inside| inside));
            // A rim along the columns may have one step of a pixel, in its middle.
            assert!(rims < 0.7, "{angle}: {rims}");
        }
    }

    #[test]
    fn missing_corners_and_a_spot_of_the_background_do_not_turn_it() {
        let spoilt = |along: f32, across: f32, inside: bool| {
            let corner = along > 45.0 && across > 0.0 || along < -60.0 && across < -8.0;
            let spot = (-50.0..-25.0).contains(&along) && (0.0..38.0).contains(&across);
            inside && !corner || spot
        };
        for angle in [-1.3, -0.5, 0.2, 1.0] {
            let (rims, moments) = off(angle, &bar(angle, (80.0, 20.0), spoilt));
            assert!(rims < 1.0, "{angle}: {rims}");
            assert!(moments > 4.0, "the control, {angle}: {moments}");
        }
    }

    #[test]
    fn a_cone_has_the_direction_between_its_rims_and_a_disc_that_of_its_moments() {
        let cone = bar(0.4, (80.0, 40.0), |along, across, _| {
            along.abs() < 80.0 && across.abs() < 20.0 + 0.12 * along
        });
        assert!(off(0.4, &cone).0 < 0.7, "{:?}", off(0.4, &cone));
        let disc = bar(0.0, (0.0, 0.0), |along, across, _| along * along + across * across < 2_500.0);
        let moments = disc.moments().unwrap();
        assert_eq!(find(&disc, &moments, None).angle, moments.angle_rad());
    }
}
