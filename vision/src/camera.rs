//! One camera of a fingertip: from a picture to what it says about skin and object.

use std::f32::consts::PI;

use crate::force::{Forces, MIDDLE};
use crate::frame::{Frame, HEIGHT, PIXELS, Plane, WIDTH, plane};
use crate::markers::{Calibration, FRAMES, Marker, Markers};
use crate::mask::Mask;
use crate::motion::{self, ARM_PX, Flow};
use crate::object::{Sighting, Tracker};
use crate::quality::{Blind, Watch};
use crate::rectify::Rectifier;
use crate::skin::Skin;

const MARKERS_MIN: usize = 4;
/// Pictures within which a calibration that finds more markers, by a quarter, shows that the first pictures were bad.
const BEGINNING: u32 = 8 * FRAMES;
/// Time over which the speed of a slip is taken, ms.
const SPEED_MS: u32 = 33;
/// Time in which what has moved still counts as moving, ms.
const MOVING_MS: f32 = 133.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    pub frame: u32,
    /// Reason not to believe the rest.
    pub blind: Option<Blind>,
    pub markers: usize,
    /// None while too few markers are known.
    pub forces: Option<Forces>,
    pub object: Option<Sighting>,
    pub flow: Option<Flow>,
    /// Move of the skin under the object.
    pub skin_flow: Option<Flow>,
    pub background_flow: Option<Flow>,
    /// Speed of the object against the skin under it. None where that cannot be seen.
    pub slip_px_s: Option<f32>,
    /// Time since the picture before, s.
    pub elapsed_s: f32,
}

#[derive(Clone, Debug)]
pub struct Camera {
    grey: Box<Plane>,
    before: Box<Plane>,
    calibration: Calibration,
    markers: Option<Markers>,
    object: Tracker,
    watch: Watch,
    skin: Skin,
    heading: Heading,
    slip_px_s: Option<f32>,
    last_ms: u32,
    frames: u32,
}

/// The angle of a held object: turned by what its brightness says from picture to picture, and slowly drawn to where its rims lie.
/// Rims shake when a part of the object has the colours of the wall.
#[derive(Clone, Copy, Debug, Default)]
struct Heading {
    rad: f32,
    pictures: f32,
}

impl Heading {
    /// Takes what is seen and the turn since the picture before. None before it has seen rims.
    fn follow(&mut self, seen: &Sighting, turned_rad: Option<f32>) -> Option<f32> {
        match turned_rad {
            Some(turned) => self.rad += turned,
            None => self.pictures = 0.0,
        }
        if !seen.cut {
            let weight = (seen.rims * seen.rims).max(MOMENTS_WEIGHT);
            self.pictures = (self.pictures + weight).min(HEADING_PICTURES);
            self.rad += half_turn(seen.angle_rad - self.rad) * weight / self.pictures;
        }
        self.rad = half_turn(self.rad);
        (self.pictures > 0.0).then_some(self.rad)
    }
}

fn half_turn(rad: f32) -> f32 {
    rad - PI * libm::roundf(rad / PI)
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            grey: plane(),
            before: plane(),
            calibration: Calibration::default(),
            markers: None,
            object: Tracker::default(),
            watch: Watch::default(),
            skin: Skin::default(),
            heading: Heading::default(),
            slip_px_s: None,
            last_ms: 0,
            frames: 0,
        }
    }
}

impl Camera {
    pub fn rectify(&mut self, lens: Rectifier) {
        self.object.rectify(lens);
    }

    pub fn markers(&self) -> Option<&Markers> {
        self.markers.as_ref()
    }

    pub const fn object(&self) -> &Tracker {
        &self.object
    }

    /// Takes a picture that was taken at `taken_ms` and has come at `now_ms`. With `learn`, the object's colours are
    /// learned: until the hand closes.
    pub fn picture(&mut self, frame: &Frame, learn: bool, taken_ms: u32, now_ms: u32) -> Summary {
        std::mem::swap(&mut self.grey, &mut self.before);
        frame.grey(&mut self.grey);
        if let Some(markers) = &mut self.markers {
            markers.follow(&self.grey);
        }
        self.calibrate(learn);
        let elapsed_ms = if self.frames == 0 { SPEED_MS } else { taken_ms.wrapping_sub(self.last_ms).max(1) };
        self.last_ms = taken_ms;
        self.object.pace(libm::roundf(libm::log2f(MOVING_MS / elapsed_ms as f32)));
        let markers: &[_] = self.markers.as_deref().unwrap_or_default();
        let found = markers.iter().filter(|marker| marker.found.is_ok()).count();
        let blind = self.watch.picture(&self.grey, (found, markers.len()), taken_ms, now_ms);
        let forces = Forces::of(markers, MARKERS_MIN);
        let skin = skin_of(markers);
        let mut object = self.object.step(frame, &self.grey, &skin, learn);
        let (mut flow, mut skin_flow, mut background_flow) = (None, None, None);
        if self.frames > 0 {
            if let Some(middle) = self.object.middle() {
                let mut seen = self.object.object().clone();
                seen.subtract(&skin);
                seen.thin(OBJECT_ROWS);
                flow = motion::flow(&self.before, &self.grey, &seen, middle);
                skin_flow = self.skin.flow(markers, middle);
            }
            let mut background = self.object.near().clone();
            background.unite(&skin);
            background.invert();
            background.thin(BACKGROUND_ROWS);
            background_flow = motion::flow(&self.before, &self.grey, &background, MIDDLE);
        }
        if learn {
            self.heading = Heading::default();
        } else if let Some(object) = &mut object {
            let turned = flow.map(|flow: Flow| flow.turn / ARM_PX);
            object.angle_rad = self.heading.follow(object, turned).unwrap_or(object.angle_rad);
        }
        self.slip_px_s = flow.map(|flow| {
            let now = 1e3 * flow.slip_on(skin_flow.unwrap_or_default()) / elapsed_ms as f32;
            let part = elapsed_ms.min(SPEED_MS) as f32 / SPEED_MS as f32;
            self.slip_px_s.map_or(now, |before| before + part * (now - before))
        });
        self.skin.remember(markers);
        let number = self.frames;
        self.frames = self.frames.wrapping_add(1);
        Summary {
            frame: number,
            blind,
            markers: markers.len(),
            forces,
            object,
            flow,
            skin_flow,
            background_flow,
            slip_px_s: self.slip_px_s,
            elapsed_s: elapsed_ms as f32 / 1e3,
        }
    }

    /// Looks for the markers, and once more while the hand is open: then everything begins anew if it finds more.
    fn calibrate(&mut self, learn: bool) {
        let again = learn && self.frames < BEGINNING;
        if !(self.markers.is_none() || again) || !self.calibration.frame(&self.grey) {
            return;
        }
        let found = Markers::new(&std::mem::take(&mut self.calibration));
        let Some(own) = &self.markers else {
            self.markers = Some(found);
            return;
        };
        if 4 * found.len() > 5 * own.len() {
            self.markers = Some(found);
            self.object.begin_anew();
            self.skin = Skin::default();
        }
    }
}

/// Pictures from which the angle of a held object is made.
const HEADING_PICTURES: f32 = 40.0;
const MOMENTS_WEIGHT: f32 = 0.01;
/// One of so many rows is looked at for a move.
const OBJECT_ROWS: usize = 2;
const BACKGROUND_ROWS: usize = 4;
const RIM_PX: f32 = 3.0;

fn skin_of(markers: &[Marker]) -> Mask {
    let mut skin = Mask::EMPTY;
    for marker in markers {
        let reach = marker.rest.radius() + RIM_PX;
        let range = |middle: f32, end: usize| {
            ((middle - reach).max(0.0) as usize)..((middle + reach) as usize + 1).min(end)
        };
        skin.insert_block(range(marker.at.x, WIDTH), range(marker.at.y, HEIGHT));
    }
    skin
}

/// Moving pixels, of the picture, from which an object slips whose own move cannot be seen: it is too plain.
pub const SLIP_MIN: f32 = 0.001;
/// Speed of an object against the skin under it from which it slips, px/s, and of the background from which the hand moves.
pub const SLIP_MIN_PX_S: f32 = 7.5;
pub const HAND_MIN_PX_S: f32 = 3.0;

impl Summary {
    pub fn slips(&self) -> bool {
        let Some(object) = self.object.filter(|_| self.blind.is_none()) else { return false };
        match self.slip_px_s {
            Some(speed) => speed >= SLIP_MIN_PX_S,
            None => object.slip_px as f32 >= SLIP_MIN * PIXELS as f32,
        }
    }

    /// The teacher's words (Tada 2006, equations 1 and 2). v1: -1 if the object moves against the hand, 1 if both move as
    /// one, 0 if nothing moves. v2: 1 if the hand moves up (the background down), -1 if down, 0 if not. None of a camera
    /// that is not to be believed, and while there is no object.
    pub fn codes(&self) -> Option<(i8, i8)> {
        self.object.filter(|_| self.blind.is_none())?;
        let y = self.background_flow.map_or(0.0, |flow| flow.y);
        let hand = if y.abs() < HAND_MIN_PX_S * self.elapsed_s { 0 } else { y.signum() as i8 };
        Some((if self.slips() { -1 } else { hand.abs() }, hand))
    }
}
