//! The markers: of all blobs that look like one, those that stay where they are, have a sharp edge all around and the size of the others.
//! The paper covers the skin with a white sheet instead.

use super::outline::{Outline, RAYS, irregularity};
use super::window::{Blob, SIDE, Window};
use super::{MARKERS_MAX, Marker, Shape};
use crate::frame::{HEIGHT, Plane, Point, WIDTH};

/// Frames that a calibration takes, the first included.
pub const FRAMES: u32 = 11;
/// Windows are this far apart, px: every marker is far from the border of one of them.
const STRIDE: usize = 10;
/// Smallest and largest marker, px of area.
const AREA: (u32, u32) = (10, 260);
/// Contrast that a ray must meet, grey levels.
const CONTRAST_MIN: f32 = 14.0;
/// Rays that must meet it.
const CLEAR_MIN: usize = 12;
/// The most that its middle may be of the level around it, per cent: the markers are black.
const MIDDLE_MAX_PERCENT: f32 = 58.0;
/// The most that its outline may differ from an ellipse, of its radius: what lies behind the skin is seldom round.
const IRREGULAR_MAX: f32 = 0.12;
const MOVED_MAX_PX: f32 = 0.8;
const GROWTH_MAX_PX: f32 = 0.5;

/// A calibration that goes on. Feed it [`FRAMES`] frames of an unloaded skin, then [`Calibration::markers`].
#[derive(Clone, Debug, Default)]
pub struct Calibration {
    candidates: Vec<Candidate>,
    frames: u32,
}

#[derive(Clone, Copy, Debug)]
struct Candidate {
    marker: Marker,
    quality: f32,
    x: f32,
    y: f32,
    growth: f32,
    found: u32,
    steady: bool,
}

impl Calibration {
    pub fn frame(&mut self, grey: &Plane) -> bool {
        if self.frames == 0 {
            self.search(grey);
        } else {
            for candidate in &mut self.candidates {
                candidate.step(grey);
            }
        }
        self.frames += 1;
        self.frames >= FRAMES
    }

    /// The markers, numbered by rows from the top left.
    pub fn markers(&self) -> Vec<Marker> {
        let steady = self.candidates.iter().filter(|candidate| {
            candidate.steady && 10 * candidate.found >= 8 * (self.frames.saturating_sub(1))
        });
        let mut markers: Vec<Marker> = steady.map(|candidate| Marker::new(candidate.mean_shape())).collect();
        markers.sort_unstable_by_key(|marker| marker.rest.area);
        // The fisheye makes those at the border smaller, but not four times in area.
        let usual = markers.get(markers.len() / 2).map_or(0, |marker| marker.rest.area);
        markers.retain(|marker| 4 * marker.rest.area >= usual && marker.rest.area <= 4 * usual);
        markers.sort_unstable_by_key(|marker| (marker.rest.at.y as u32, marker.rest.at.x as u32));
        markers
    }

    fn search(&mut self, grey: &Plane) {
        for top in (0..HEIGHT - SIDE / 2).step_by(STRIDE) {
            for left in (0..WIDTH - SIDE / 2).step_by(STRIDE) {
                let middle = Point { x: (left + SIDE / 2) as f32, y: (top + SIDE / 2) as f32 };
                let window = Window::around(grey, middle);
                for cut in 2..=6 {
                    let dark = window.below(window.levels().cut(cut));
                    let count: u32 = dark.iter().map(|row| row.count_ones()).sum();
                    let blobs = window.blobs(&dark, AREA.0);
                    for blob in blobs.into_iter().filter(|blob| !blob.cut && blob.area <= AREA.1) {
                        if let Some((shape, quality)) = shape_of(grey, &blob, count) {
                            self.add(shape, quality);
                        }
                    }
                }
            }
        }
    }

    /// Adds a candidate unless it is another view of one.
    fn add(&mut self, shape: Shape, quality: f32) {
        let near = |candidate: &Candidate| {
            candidate.marker.rest.at.distance(shape.at) < candidate.marker.rest.radius().max(shape.radius())
        };
        let candidate = Candidate {
            marker: Marker::new(shape),
            quality,
            x: 0.0,
            y: 0.0,
            growth: 0.0,
            found: 0,
            steady: true,
        };
        match self.candidates.iter().position(near) {
            Some(at) if self.candidates[at].quality >= quality => {}
            Some(at) => self.candidates[at] = candidate,
            None if self.candidates.len() < MARKERS_MAX => self.candidates.push(candidate),
            None => {}
        }
    }
}

impl Candidate {
    fn step(&mut self, grey: &Plane) {
        // From the first position each time: what drifts is no marker.
        let mut marker = Marker::new(self.marker.rest);
        marker.follow(grey);
        if marker.found.is_err() {
            return;
        }
        let (x, y) = marker.moved();
        let seen = Outline::look(grey, marker.at, &marker.rest.radii).edges.map(|edge| edge.radius);
        self.steady &= irregularity(&seen) <= IRREGULAR_MAX;
        self.steady &= libm::hypotf(x, y) <= MOVED_MAX_PX && marker.growth.abs() <= GROWTH_MAX_PX;
        (self.x, self.y, self.growth) = (self.x + x, self.y + y, self.growth + marker.growth);
        self.found += 1;
    }

    fn mean_shape(&self) -> Shape {
        let n = self.found.max(1) as f32;
        let rest = self.marker.rest;
        let at = Point { x: rest.at.x + self.x / n, y: rest.at.y + self.y / n };
        Shape { at, radii: rest.radii.map(|radius| radius + self.growth / n), ..rest }
    }
}

fn shape_of(grey: &Plane, blob: &Blob, dark_pixels: u32) -> Option<(Shape, f32)> {
    let radius = libm::sqrtf(blob.area as f32 / std::f32::consts::PI);
    let mut at = blob.at;
    let mut outline = Outline::look(grey, at, &[radius; RAYS]);
    for _ in 0..2 {
        let round = [radius; RAYS];
        let fit = outline.fit(&round)?;
        at = Point { x: at.x + fit.x, y: at.y + fit.y };
        outline = Outline::look(grey, at, &round);
    }
    let clear = outline.edges.iter().filter(|edge| edge.contrast >= CONTRAST_MIN).count();
    if clear < CLEAR_MIN {
        return None;
    }
    let rise = outline.edges.iter().map(|edge| edge.contrast).sum::<f32>() / RAYS as f32;
    let middle = f32::from(grey[at.y as usize * WIDTH + at.x as usize]);
    if 100.0 * middle > MIDDLE_MAX_PERCENT * (middle + rise) {
        return None;
    }
    let contrast = outline.edges.iter().map(|edge| edge.contrast.min(60.0)).sum::<f32>();
    let mean = outline.edges.iter().map(|edge| edge.radius).sum::<f32>() / RAYS as f32;
    let rays = outline.edges.map(|edge| if edge.contrast >= CONTRAST_MIN { edge.radius } else { mean });
    let irregular = irregularity(&rays);
    if irregular > IRREGULAR_MAX {
        return None;
    }
    let shape = Shape { at, radii: rays, area: blob.area, dark_pixels };
    Some((shape, contrast / (0.1 + irregular)))
}
