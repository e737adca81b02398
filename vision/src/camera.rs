//! One camera of a fingertip: from a picture to what it says about skin and object. Nothing is allocated after `new`.

use alloc::boxed::Box;

use crate::force::Forces;
use crate::frame::{Frame, HEIGHT, PIXELS, Plane, WIDTH, plane};
use crate::markers::{Calibration, Marker, Markers};
use crate::mask::Mask;
use crate::motion::{self, Flow};
use crate::object::{Config, Running, Sighting, Tracker};
use crate::quality::{Blind, Watch};
use crate::rectify::Rectifier;

/// Markers without which there is no force.
const MARKERS_MIN: usize = 4;

/// What a camera says of one picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Number of the picture, from 0.
    pub frame: u32,
    /// Why nothing of the rest should be believed, if so.
    pub blind: Option<Blind>,
    /// Markers of the skin; 0 until they are calibrated.
    pub markers: usize,
    /// Those of them that were found in this picture.
    pub found: usize,
    /// What the markers say. None while too few are known.
    pub forces: Option<Forces>,
    /// The object, if there is one.
    pub object: Option<Sighting>,
    /// How it moves, if that can be seen.
    pub flow: Option<Flow>,
    /// How the skin in contact moves: what sticks to it moves as it does.
    pub skin_flow: Option<Flow>,
    /// How what lies behind the skin moves: the hand moves the other way.
    pub background_flow: Option<Flow>,
}

/// Follows one camera's pictures.
#[derive(Clone, Debug)]
pub struct Camera {
    grey: Box<Plane>,
    before: Box<Plane>,
    calibration: Calibration,
    markers: Option<Markers>,
    object: Tracker<Running>,
    watch: Watch,
    forces_before: Option<Forces>,
    frames: u32,
}

impl Camera {
    /// One that has seen nothing. Its first pictures calibrate the markers: the skin must be unloaded.
    #[must_use]
    pub fn new(config: Config) -> Self {
        Self {
            grey: plane(),
            before: plane(),
            calibration: Calibration::new(),
            markers: None,
            object: Tracker::new(config, Running::default()),
            watch: Watch::default(),
            forces_before: None,
            frames: 0,
        }
    }

    /// From here on the object's middle and angle are those behind this lens.
    pub fn rectify(&mut self, lens: Rectifier) {
        self.object.rectify(lens);
    }

    /// Its markers, none until they are calibrated.
    #[must_use]
    pub fn markers(&self) -> Option<&Markers> {
        self.markers.as_ref()
    }

    /// What follows the object, for whoever draws it.
    #[must_use]
    pub const fn object(&self) -> &Tracker<Running> {
        &self.object
    }

    /// Takes a picture that was taken at `taken_ms` and has come at `now_ms`. With `learn`, the object's colours are
    /// learned: until the hand closes.
    pub fn picture(&mut self, frame: &Frame, learn: bool, taken_ms: u32, now_ms: u32) -> Summary {
        core::mem::swap(&mut self.grey, &mut self.before);
        frame.grey(&mut self.grey);
        match &mut self.markers {
            Some(markers) => markers.follow(&self.grey),
            None => {
                if self.calibration.frame(&self.grey) {
                    self.markers = Some(Markers::new(&self.calibration));
                }
            }
        }
        let markers: &[_] = self.markers.as_deref().unwrap_or_default();
        let found = markers.iter().filter(|marker| marker.found.is_ok()).count();
        let blind = self.watch.picture(&self.grey, (found, markers.len()), taken_ms, now_ms);
        let forces = Forces::of(markers, MARKERS_MIN);
        let skin_flow = forces
            .zip(self.forces_before)
            .map(|(now, before)| Flow { x: now.x - before.x, y: now.y - before.y });
        self.forces_before = forces;
        let skin = skin_of(markers);
        let object = self.object.step(frame, &self.grey, &skin, learn);
        let (mut flow, mut background_flow) = (None, None);
        if self.frames > 0 {
            if object.is_some() {
                let mut seen = self.object.object().clone();
                seen.subtract(&skin);
                seen.thin(OBJECT_ROWS);
                flow = motion::flow(&self.before, &self.grey, &seen);
            }
            let mut background = self.object.near().clone();
            background.unite(&skin);
            background.invert();
            background.thin(BACKGROUND_ROWS);
            background_flow = motion::flow(&self.before, &self.grey, &background);
        }
        let number = self.frames;
        self.frames = self.frames.wrapping_add(1);
        Summary {
            frame: number,
            blind,
            markers: markers.len(),
            found,
            forces,
            object,
            flow,
            skin_flow,
            background_flow,
        }
    }

    /// What is to be thought of the camera while no picture comes.
    #[must_use]
    pub fn silence(&self, now_ms: u32) -> Option<Blind> {
        self.watch.silence(now_ms)
    }
}

/// Rows of the object that are looked at for its move.
const OBJECT_ROWS: usize = 2;
/// Rows of the background that are looked at: one of so many is enough for one move.
const BACKGROUND_ROWS: usize = 4;
/// How far around a marker its rim reaches, px.
const RIM_PX: f32 = 3.0;

/// Where the markers are, their rims included.
fn skin_of(markers: &[Marker]) -> Mask {
    let mut skin = Mask::EMPTY;
    for marker in markers {
        let reach = marker.rest.radius() + RIM_PX;
        let range = |middle: f32, end: usize| {
            ((middle - reach).max(0.0) as usize)..((middle + reach) as usize + 1).min(end)
        };
        for y in range(marker.at.y, HEIGHT) {
            range(marker.at.x, WIDTH).for_each(|x| skin.insert(x, y));
        }
    }
    skin
}

/// Moving pixels, of the picture, from which an object slips.
pub const SLIP_MIN: f32 = 0.001;
/// How fast the skin must move to carry an object along, px a frame.
pub const SKIN_FLOW_MIN_PX: f32 = 0.05;
/// The most that the object's move may differ from the skin's for it to stick, of the larger: the mean over all markers is
/// less than the move under the object.
pub const STICKS_MAX: f32 = 0.7;
/// How fast the background must move for the hand to move, px a frame.
pub const HAND_FLOW_MIN_PX: f32 = 0.1;

impl Summary {
    /// Whether the object slips: enough of it moves, and not as the skin does that it sticks to.
    #[must_use]
    pub fn slips(&self) -> bool {
        let enough = |object: Sighting| object.slip_px as f32 >= SLIP_MIN * PIXELS as f32;
        self.blind.is_none() && self.object.is_some_and(enough) && !self.sticks()
    }

    /// Whether the object's move is the skin's.
    fn sticks(&self) -> bool {
        let (Some(object), Some(skin)) = (self.flow, self.skin_flow) else { return false };
        let size = |flow: Flow| libm::hypotf(flow.x, flow.y);
        let apart = size(Flow { x: object.x - skin.x, y: object.y - skin.y });
        size(skin) >= SKIN_FLOW_MIN_PX && apart < STICKS_MAX * size(object).max(size(skin))
    }

    /// The teacher's words (Tada 2006, equations 1 and 2). v1: -1 if the object moves against the hand, 1 if both move as
    /// one, 0 if nothing moves. v2: 1 if the hand moves up (the background down), -1 if down, 0 if not. None of a camera
    /// that is not to be believed, and while there is no object.
    #[must_use]
    pub fn codes(&self) -> Option<(i8, i8)> {
        self.object.filter(|_| self.blind.is_none())?;
        let y = self.background_flow.map_or(0.0, |flow| flow.y);
        let hand = if y.abs() < HAND_FLOW_MIN_PX { 0 } else { y.signum() as i8 };
        Some((if self.slips() { -1 } else { hand.abs() }, hand))
    }
}
