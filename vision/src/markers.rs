//! Markers on the skin: found once, then followed each in its own window (FingerVision 2017, section IV).

mod calibration;
mod outline;
mod window;

use crate::frame::{Plane, Point};

pub use self::calibration::{Calibration, FRAMES};
pub use self::outline::RAYS;
use self::outline::{Fit, Outline};
use self::window::{SIDE, Window};

pub const MARKERS_MAX: usize = 64;

const STEP_MAX_PX: f32 = 2.5;
const GROWTH_MAX_PX: f32 = 1.0;
/// Failures in a row after which it is looked for where it was calibrated.
const FAILURES_MAX: u8 = 3;
const MOVE_MAX_PX: f32 = 14.0;
const APART_MAX_PX: f32 = 2.5;
/// Markers around one whose moves are compared with its own.
const NEIGHBOURS: usize = 6;
/// A share of failed frames, of 256, above which a marker is no good for forces, though it is still followed: behind the
/// skin there are things that look like markers until they move.
const FAILED_SHARE_MAX: u16 = 77;
/// Frames over which that share is taken, as a power of two.
const FAILED_SHARE_FRAMES: u32 = 6;
/// Readings in a row, each near the one before, that a marker must give after that before it counts again.
const PROBATION: u8 = 3;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    DarkPixels,
    Blobs,
    Moved,
    Resized,
    Outline,
    Apart,
    Probation,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    pub at: Point,
    pub radii: [f32; RAYS],
    pub area: u32,
    pub dark_pixels: u32,
}

impl Shape {
    pub fn radius(&self) -> f32 {
        self.radii.iter().sum::<f32>() / RAYS as f32
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marker {
    pub rest: Shape,
    pub at: Point,
    pub growth: f32,
    pub found: Result<(), Failure>,
    failures: u8,
    probation: u8,
    failed_share: u16,
}

impl Marker {
    pub fn new(rest: Shape) -> Self {
        Self { rest, at: rest.at, growth: 0.0, found: Ok(()), failures: 0, probation: 0, failed_share: 0 }
    }

    pub fn moved(&self) -> (f32, f32) {
        (self.at.x - self.rest.at.x, self.at.y - self.rest.at.y)
    }

    pub fn known(&self) -> bool {
        self.failures <= FAILURES_MAX && self.probation == 0 && self.failed_share >> 8 <= FAILED_SHARE_MAX
    }

    pub fn follow(&mut self, grey: &Plane) {
        let lost = self.failures > FAILURES_MAX;
        let from = if lost && self.probation == 0 { (self.rest.at, 0.0) } else { (self.at, self.growth) };
        match find(grey, &self.rest, from.0, from.1) {
            Ok((at, growth)) => {
                (self.at, self.growth) = (at, growth);
                if lost {
                    (self.failures, self.probation) = (0, PROBATION);
                } else {
                    self.failures = 0;
                    self.probation = self.probation.saturating_sub(1);
                }
                self.found = if self.probation == 0 { Ok(()) } else { Err(Failure::Probation) };
            }
            Err(failure) => {
                self.failures =
                    if self.probation > 0 { FAILURES_MAX + 1 } else { self.failures.saturating_add(1) };
                self.probation = 0;
                self.found = Err(failure);
            }
        }
        let failed = if self.found.is_ok() { 0 } else { u16::MAX >> FAILED_SHARE_FRAMES };
        self.failed_share = self.failed_share - (self.failed_share >> FAILED_SHARE_FRAMES) + failed;
    }

    fn disown(&mut self, failure: Failure) {
        (self.found, self.failures, self.probation) = (Err(failure), FAILURES_MAX + 1, 0);
        (self.at, self.growth) = (self.rest.at, 0.0);
    }
}

#[derive(Clone, Debug)]
pub struct Markers {
    markers: Vec<Marker>,
    neighbours: Vec<Vec<u8>>,
}

impl Markers {
    pub fn new(calibration: &Calibration) -> Self {
        let markers = calibration.markers();
        let nearest = |at: usize| {
            let apart = |other: u8| match usize::from(other) {
                other if other == at => f32::MAX,
                other => markers[other].rest.at.distance(markers[at].rest.at),
            };
            let mut order: Vec<u8> = (0..markers.len() as u8).collect();
            order.sort_unstable_by(|&a, &b| apart(a).total_cmp(&apart(b)));
            order.truncate(NEIGHBOURS);
            order
        };
        Self { neighbours: (0..markers.len()).map(nearest).collect(), markers }
    }

    pub fn follow(&mut self, grey: &Plane) {
        self.markers.iter_mut().for_each(|marker| marker.follow(grey));
        for at in 0..self.markers.len() {
            if self.markers[at].found.is_ok() && self.apart(at) > APART_MAX_PX {
                self.markers[at].disown(Failure::Apart);
            }
        }
    }

    fn apart(&self, at: usize) -> f32 {
        let (x, y) = self.markers[at].moved();
        self.neighbours_moved(at).map_or(0.0, |near| libm::hypotf(x - near.0, y - near.1))
    }

    /// The median move of a marker's neighbours, px; None if too few of them are known.
    fn neighbours_moved(&self, at: usize) -> Option<(f32, f32)> {
        let near = self.neighbours[at].iter().map(|&near| &self.markers[usize::from(near)]);
        let known = near.filter(|near| near.found.is_ok() && near.known());
        let (mut xs, mut ys): (Vec<f32>, Vec<f32>) = known.map(Marker::moved).unzip();
        if xs.len() < 3 {
            return None;
        }
        let median = |values: &mut [f32]| {
            values.sort_unstable_by(f32::total_cmp);
            (values[values.len() / 2] + values[(values.len() - 1) / 2]) / 2.0
        };
        Some((median(&mut xs), median(&mut ys)))
    }
}

impl std::ops::Deref for Markers {
    type Target = [Marker];

    fn deref(&self) -> &[Marker] {
        &self.markers
    }
}

fn find(grey: &Plane, shape: &Shape, last: Point, grown: f32) -> Result<(Point, f32), Failure> {
    // The outline may stand out where the blob is not alone: it is looked for where it was last.
    let (near, excuse) = match blob(grey, shape, last) {
        Ok(at) => (at, Failure::Outline),
        Err(failure) => (last, failure),
    };
    let (mut at, mut fit) = (near, Fit::default());
    for _ in 0..2 {
        let grown_radii = shape.radii.map(|radius| radius + grown);
        let radii = &grown_radii;
        fit = Outline::look(grey, at, radii).fit(radii).ok_or(excuse)?;
        at = Point { x: at.x + fit.x, y: at.y + fit.y };
        if at.distance(last) > STEP_MAX_PX || at.distance(shape.at) > MOVE_MAX_PX {
            return Err(Failure::Moved);
        }
        if fit.x.abs() + fit.y.abs() < 0.3 {
            break;
        }
    }
    if fit.growth.abs() > GROWTH_MAX_PX {
        return Err(Failure::Resized);
    }
    Ok((at, grown + fit.growth))
}

/// A window whose usual level is not this much above its darkest holds nothing, grey levels.
const CONTRAST_MIN: u8 = 16;
/// Parts of the way from the darkest to the usual level at which a window is cut in two, in eighths: the first at which
/// the marker stands alone is good enough, for the outline is looked for afterwards.
const CUTS: [u16; 3] = [4, 3, 2];

fn blob(grey: &Plane, shape: &Shape, last: Point) -> Result<Point, Failure> {
    let window = Window::around(grey, last);
    let levels = window.levels();
    let mut failure = Failure::DarkPixels;
    if levels.surround < levels.dark.saturating_add(CONTRAST_MIN) {
        return Err(failure);
    }
    for cut in CUTS {
        let dark = window.below(levels.cut(cut));
        let count: u32 = dark.iter().map(|row| row.count_ones()).sum();
        // Below half of its own pixels it is not there; far above what was dark at rest it is lost in something.
        if 2 * count < shape.area || count > 2 * shape.dark_pixels + shape.area {
            continue;
        }
        let blobs = window.blobs(&dark, shape.area / 2);
        let mut alike = blobs.iter().filter(|blob| {
            !blob.cut && blob.area <= 2 * shape.area && blob.at.distance(last) < SIDE as f32 / 2.0
        });
        match (alike.next(), alike.next()) {
            (Some(only), None) => return Ok(only.at),
            _ => failure = Failure::Blobs,
        }
    }
    Err(failure)
}
