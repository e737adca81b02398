//! A marker's outline, ray by ray, to a part of a pixel. Each ray is compared with its own background and with its edge at calibration, since
//! a threshold moves the middle of a blob when the background behind one of its sides changes.

use crate::frame::{HEIGHT, Plane, Point, WIDTH};

pub const RAYS: usize = 16;
const REACH: f32 = 2.5;
/// Steps along a ray, px.
const STEP: f32 = 0.5;
/// Samples along a ray: one more at each end, for the slope.
const SAMPLES: usize = (2.0 * REACH / STEP) as usize + 3;
const LANES: usize = SAMPLES.next_multiple_of(8);
/// The rise from the marker to its surround that counts as an edge, grey levels.
const CONTRAST_MIN: f32 = 10.0;
/// Above this contrast an edge is no better known.
const CONTRAST_FULL: f32 = 40.0;
/// Rays that must agree.
const RAYS_MIN: usize = 8;
/// The farthest that an edge may be from where the others put it, px.
const STRAY: f32 = 0.6;
/// A grey level of [`sample`].
const ONE_LEVEL: i32 = 256 * 256;

/// Directions of the rays: cosine and sine of k/16 turns.
#[rustfmt::skip]
const DIRECTIONS: [(f32, f32); RAYS] = [
    (1.0, 0.0), (0.923_879_5, 0.382_683_43), (0.707_106_77, 0.707_106_77), (0.382_683_43, 0.923_879_5),
    (0.0, 1.0), (-0.382_683_43, 0.923_879_5), (-0.707_106_77, 0.707_106_77), (-0.923_879_5, 0.382_683_43),
    (-1.0, 0.0), (-0.923_879_5, -0.382_683_43), (-0.707_106_77, -0.707_106_77), (-0.382_683_43, -0.923_879_5),
    (0.0, -1.0), (0.382_683_43, -0.923_879_5), (0.707_106_77, -0.707_106_77), (0.923_879_5, -0.382_683_43),
];

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Edge {
    pub radius: f32,
    pub contrast: f32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    pub middle: Point,
    pub edges: [Edge; RAYS],
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fit {
    pub x: f32,
    pub y: f32,
    pub growth: f32,
    pub rays: usize,
    pub stray: f32,
}

impl Outline {
    pub fn look(grey: &Plane, middle: Point, radii: &[f32; RAYS]) -> Self {
        let mut edges = [Edge::default(); RAYS];
        for ((edge, &radius), direction) in edges.iter_mut().zip(radii).zip(DIRECTIONS) {
            *edge = along(grey, middle, radius, direction);
        }
        Self { middle, edges }
    }

    /// Moves and grows `radii` until they lie on the edges, those left out that no move explains. None if too few agree.
    pub fn fit(&self, radii: &[f32; RAYS]) -> Option<Fit> {
        let mut used = self.edges.map(|edge| edge.contrast >= CONTRAST_MIN);
        let mut fit = None;
        for round in 0..3 {
            let now = least_squares(&self.edges, radii, &used)?;
            fit = Some(now);
            // The first round is pulled by the strays, so it may only drop the worst of them.
            let limit =
                if round == 0 { (2.0 * now.stray).max(STRAY) } else { (2.5 * now.stray).clamp(0.2, STRAY) };
            let mut dropped = false;
            for ray in 0..RAYS {
                if used[ray] && residual(&now, ray, self.edges[ray], radii[ray]) > limit {
                    (used[ray], dropped) = (false, true);
                }
            }
            if !dropped {
                break;
            }
        }
        fit.filter(|fit| fit.rays >= RAYS_MIN && fit.stray < STRAY)
    }
}

/// The rms distance of radii from the ellipse that fits them best, as a share of their mean.
pub fn irregularity(radii: &[f32; RAYS]) -> f32 {
    let n = RAYS as f32;
    let mean = radii.iter().sum::<f32>() / n;
    // An ellipse, and a middle that is a little off, are the first two harmonics.
    let (mut first, mut second) = ((0.0, 0.0), (0.0, 0.0));
    for (&radius, (cos, sin)) in radii.iter().zip(DIRECTIONS) {
        first = (first.0 + radius * cos, first.1 + radius * sin);
        second = (second.0 + radius * (cos * cos - sin * sin), second.1 + radius * 2.0 * sin * cos);
    }
    let mut sum = 0.0;
    for (&radius, (cos, sin)) in radii.iter().zip(DIRECTIONS) {
        let ellipse =
            first.0 * cos + first.1 * sin + second.0 * (cos * cos - sin * sin) + second.1 * 2.0 * sin * cos;
        let off = radius - mean - 2.0 * ellipse / n;
        sum += off * off;
    }
    libm::sqrtf(sum / n) / mean
}

fn residual(fit: &Fit, ray: usize, edge: Edge, radius: f32) -> f32 {
    let (cos, sin) = DIRECTIONS[ray];
    (edge.radius - radius - fit.growth - fit.x * cos - fit.y * sin).abs()
}

/// Move and growth by weighted least squares. Growth is drawn towards 0: half an outline does not tell growth from a move.
fn least_squares(edges: &[Edge; RAYS], radii: &[f32; RAYS], used: &[bool; RAYS]) -> Option<Fit> {
    let (mut n, mut x, mut y, mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    let (mut v, mut xv, mut yv, mut rays) = (0.0, 0.0, 0.0, 0);
    for ray in (0..RAYS).filter(|&ray| used[ray]) {
        let weight = edges[ray].contrast.min(CONTRAST_FULL) / CONTRAST_FULL;
        let ((cos, sin), off) = (DIRECTIONS[ray], edges[ray].radius - radii[ray]);
        (n, x, y) = (n + weight, x + weight * cos, y + weight * sin);
        (xx, xy, yy) = (xx + weight * cos * cos, xy + weight * cos * sin, yy + weight * sin * sin);
        (v, xv, yv) = (v + weight * off, xv + weight * off * cos, yv + weight * off * sin);
        rays += 1;
    }
    let det_min = 0.02 * (n + 1.0) * n * n;
    let n = n + 1.0;
    let det = n * (xx * yy - xy * xy) - x * (x * yy - xy * y) + y * (x * xy - xx * y);
    if rays < RAYS_MIN || det < det_min {
        return None;
    }
    let growth = v * (xx * yy - xy * xy) - x * (xv * yy - xy * yv) + y * (xv * xy - xx * yv);
    let along_x = n * (xv * yy - xy * yv) - v * (x * yy - xy * y) + y * (x * yv - xv * y);
    let along_y = n * (xx * yv - xv * xy) - x * (x * yv - xv * y) + v * (x * xy - xx * y);
    let mut fit = Fit { x: along_x / det, y: along_y / det, growth: growth / det, rays, stray: 0.0 };
    let squares = (0..RAYS).filter(|&ray| used[ray]).map(|ray| {
        let off = residual(&fit, ray, edges[ray], radii[ray]);
        off * off
    });
    fit.stray = libm::sqrtf(squares.sum::<f32>() / rays as f32);
    Some(fit)
}

fn along(grey: &Plane, middle: Point, radius: f32, (cos, sin): (f32, f32)) -> Edge {
    let first = radius - REACH - STEP;
    let place = |k: usize| {
        let r = first + k as f32 * STEP;
        (middle.x + r * cos, middle.y + r * sin)
    };
    // Between two places of the picture are none outside.
    if ![place(0), place(SAMPLES - 1)].into_iter().all(is_inside) {
        return Edge::default();
    }
    // All places first, for the compiler's vectors.
    let (mut xs, mut ys) = ([0; LANES], [0; LANES]);
    for k in 0..LANES {
        let (x, y) = place(k);
        (xs[k], ys[k]) = ((x * 256.0) as i32, (y * 256.0) as i32);
    }
    let levels: [i32; SAMPLES] = std::array::from_fn(|k| sample(grey, (xs[k], ys[k])));
    let (mut rise, mut sum, mut weighted) = (0, 0.0, 0.0);
    for k in 1..SAMPLES - 1 {
        // Inside of the middle the ray would see the far edge, which falls; a fall is no edge anyway.
        let slope = (levels[k + 1] - levels[k - 1]).max(0);
        // A slope this small is noise or shading.
        let slope = if slope < 2 * ONE_LEVEL { 0 } else { slope };
        rise += slope;
        // Squared, for shading behind the skin rises too, only less steeply.
        let square = slope as f32 * slope as f32;
        (sum, weighted) = (sum + square, weighted + square * k as f32);
    }
    if rise == 0 {
        return Edge::default();
    }
    Edge { radius: first + STEP * weighted / sum, contrast: rise as f32 / (2 * ONE_LEVEL) as f32 }
}

fn is_inside((x, y): (f32, f32)) -> bool {
    x >= 0.0 && y >= 0.0 && x < (WIDTH - 1) as f32 && y < (HEIGHT - 1) as f32
}

/// The level between four pixels, [`ONE_LEVEL`] a grey level, at a place in 1/256 px.
#[inline]
fn sample(grey: &Plane, (x, y): (i32, i32)) -> i32 {
    let (right, down) = (x & 255, y & 255);
    let at = ((y >> 8) * WIDTH as i32 + (x >> 8)) as usize;
    let Some(near) = grey.get(at..).and_then(|rest| rest.first_chunk::<{ WIDTH + 2 }>()) else { return 0 };
    let between = |at: usize| i32::from(near[at]) * (256 - right) + i32::from(near[at + 1]) * right;
    between(0) * (256 - down) + between(WIDTH) * down
}
