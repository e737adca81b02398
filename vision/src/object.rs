//! The object behind the skin, and whether it slips (FingerVision 2017, section III): it has the colours of what moved, less those that it
//! hides, and differs from the remembered scene.

mod axis;
mod colour;
mod ghost;
mod hand;
mod model;
mod scene;

use crate::frame::{Frame, PIXELS, Plane, Point, WIDTH, plane};
use crate::mask::{Mask, Moments};
use crate::rectify::Rectifier;

use self::colour::{BINS, Bins};
use self::model::{Histogram, ObjectModel};
use self::scene::{Running, Scene};

/// Pixels that differ from the scene are believed to be the scene in one frame of so many while an object is seen.
const DOUBT_FRAMES: u32 = 32;
const DOUBT_FRAMES_EMPTY: u32 = 4;
/// Every so many pixels of the scene stand for all of it: a prime, so that no column is taken again and again.
const SAMPLE: usize = 13;
/// Half the width of what is no part of a larger object, px.
const SPUR_PX: usize = 5;
/// Largest move of a held object from one frame to the next, px.
const LEAP_PX: usize = 3;
/// Pieces of an object that are smaller than this part of the largest are noise, per cent.
const PIECES_PERCENT: u32 = 25;
/// Largest distance between them, px: what is further away is a spot of the background.
const APART_PX: usize = 32;
/// Halvings of the least area for what the hand holds.
const HELD_HALVED: u32 = 3;
/// Hysteresis of "seen in part": below the first share of what was seen, until above the second, per cent.
const WHOLE_PERCENT: (u32, u32) = (60, 90);
/// Moving pixels below which an object is still.
const STILL_PX: u32 = 150;
/// Frames after which what looks like a ghost is one.
const GHOST_FRAMES: u32 = 3;
/// Frames in which what comes in front of the scene counts as moving.
const ARRIVED_FRAMES: u32 = 4;
/// Reach around moving pixels in which others belong to them, px: to learn colours, and to doubt the scene.
const INSIDE_PX: usize = 10;
const MOVES_PX: usize = 4;
/// Reach around an object in which pixels that differ from the scene may be more of it, px.
const CLOSE_PX: usize = 16;
/// Largest distance from the border of an object that may go on beyond it with colours that are not known yet, px.
const REACH_PX: usize = 24;
/// Back projection from which a pixel's colour is the object's, 1 to 255.
const COLOUR_MIN: u8 = 45;
/// The least part of the picture that is an object: what is smaller may be a person behind the skin, or a spot in another light.
const AREA_MIN: f32 = 0.04;
/// The least part of the picture that must move, and differ from the scene, for its colours to be learned.
const LEARN_MIN: f32 = 0.01;
/// The scene follows what is no object by this power of two of frames.
const SCENE_RATE: u32 = 5;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    pub moments: Moments,
    /// The direction of its long axis, radians from -pi/2 to pi/2, from x towards y (down): by its long rims if it has such.
    pub angle_rad: f32,
    /// The share of its outline that lies on the long rims. 0: it has none, and the angle is that of the second moments.
    pub rims: f32,
    pub area: f32,
    pub slip_px: u32,
    /// Part of it is beyond the border or has the colours of the wall; middle and angle are those of the rest.
    pub cut: bool,
}

#[derive(Clone, Debug, Default)]
pub struct Tracker {
    bins: Bins,
    scene: Scene,
    movement: Running,
    model: ObjectModel,
    object: Mask,
    near: Mask,
    moving: Mask,
    apart: Mask,
    lens: Option<Rectifier>,
    frames: u32,
    seen: bool,
    middle: Option<Point>,
    /// The most pixels of it that were seen since the hand has closed on it; 0: it has not.
    grasped: u32,
    is_part: bool,
    ghosts: u32,
}

impl Tracker {
    pub fn rectify(&mut self, lens: Rectifier) {
        self.lens = Some(lens);
    }

    /// Forgets scene and object, as if the next frame were the first.
    pub fn begin_anew(&mut self) {
        *self = Self { lens: self.lens.take(), ..Self::default() };
    }

    /// `octaves`: what moved counts as moving for 2^`octaves` frames.
    pub fn pace(&mut self, octaves: f32) {
        self.movement.rate = octaves.clamp(0.0, 5.0) as u32;
    }

    pub const fn object(&self) -> &Mask {
        &self.object
    }

    /// The middle of the object's pixels. None while there is no object.
    pub const fn middle(&self) -> Option<Point> {
        self.middle
    }

    pub const fn near(&self) -> &Mask {
        &self.near
    }

    pub const fn moving(&self) -> &Mask {
        &self.moving
    }

    /// Takes a frame and its grey plane. With `learn`, the object's colours are learned from what moves: until the hand
    /// closes. What moves in `skin`, where the markers are, is no slip. None while there is no object.
    pub fn step(&mut self, frame: &Frame, grey: &Plane, skin: &Mask, learn: bool) -> Option<Sighting> {
        self.frames = self.frames.saturating_add(1);
        let mut bytes = plane();
        self.movement.step(grey, &mut bytes);
        self.moving.pack(&bytes);
        if self.frames == 1 {
            self.scene.follow(frame, &Mask::EMPTY, 0);
        }
        self.scene.follow_light(grey, &self.near);
        self.scene.differs(frame, &mut bytes);
        let mut differs = Mask::EMPTY;
        differs.pack(&bytes);
        if learn {
            self.learn(frame, &differs);
        }
        if self.frames.is_multiple_of(ARRIVED_FRAMES) {
            self.apart.clone_from(&differs);
        }
        let apart = differs.clone();
        let is_its = |red, green, blue| self.model.value(self.bins.of([red, green, blue])) >= COLOUR_MIN;
        differs.keep(frame, is_its);
        // Specks and lines of a pixel go, then noise (erosion 2), and what the markers cut out is closed (dilation 7, and back).
        differs.majority();
        differs.erode(2);
        differs.dilate(7);
        differs.fill_holes();
        differs.erode(5);
        differs.cut_spurs(SPUR_PX);
        if !learn && self.seen {
            // A held object does not leap: new pixels beside it are the background's.
            self.object.dilate(LEAP_PX);
            differs.intersect(&self.object);
        }
        differs.keep_large(PIECES_PERCENT);
        // While the hand is open the object moves, and what does not may be a ghost.
        let mut moves = self.moving.clone();
        moves.intersect(&differs);
        let by = if learn && moves.count() >= STILL_PX { moves } else { differs.clone() };
        differs.keep_together(&by, APART_PX);
        self.object = differs;
        self.near.clone_from(&self.object);
        // A hand that has closed took the object from somebody's.
        if learn {
            let least = (AREA_MIN * PIXELS as f32) as u32;
            hand::leave_out(&mut self.object, frame, self.scene.mean_colour(), least);
        }

        let part = |pixels: u32| pixels as f32 / PIXELS as f32;
        // A seen object needs half the area to be seen again, a grasped one an eighth: it may be of the wall's colour.
        if learn || !(self.seen || self.grasped > 0) {
            self.grasped = 0;
        } else {
            self.grasped = self.grasped.max(self.object.count());
        }
        let halved = if self.grasped > 0 { HELD_HALVED } else { u32::from(self.seen) };
        let area_min = AREA_MIN / (1 << halved) as f32;
        let moments = self.object.moments().filter(|moments| part(moments.area) >= area_min);
        (self.seen, self.middle) = (moments.is_some(), moments.map(|moments| moments.middle));
        if !self.seen {
            self.object = Mask::EMPTY;
            self.near = Mask::EMPTY;
        }
        self.remember(frame, &apart);
        let mut slip = self.object.clone();
        slip.intersect(&self.moving);
        slip.subtract(skin);
        let slip_px = moments.map_or(0, |moments| spread_count(&slip, &moments));
        let ghost =
            learn && self.seen && slip_px < STILL_PX && ghost::is_one(&self.object, skin, frame, &self.scene);
        self.ghosts = if ghost { self.ghosts + 1 } else { 0 };
        if self.ghosts >= GHOST_FRAMES {
            self.lay_ghost(frame);
            return None;
        }
        let area = part(moments?.area);
        let lens = self.lens.as_ref();
        let moments = lens.and_then(|lens| lens.moments(&self.object)).or(moments)?;
        let rims = axis::find(&self.object, &moments, lens);
        // A marker hides what is behind it.
        let mut unknown = apart;
        unknown.unite(skin);
        unknown.unite(&self.object);
        let whole_percent = if self.is_part { WHOLE_PERCENT.1 } else { WHOLE_PERCENT.0 };
        self.is_part = 100 * self.object.count() < whole_percent * self.grasped;
        let cut = self.is_part || is_cut(&self.object, learn.then_some(&unknown));
        Some(Sighting { moments, angle_rad: rims.angle, rims: rims.share, area, slip_px, cut })
    }

    fn lay_ghost(&mut self, frame: &Frame) {
        self.near.invert();
        self.scene.follow(frame, &self.near, 0);
        self.model.forget();
        (self.object, self.near) = (Mask::EMPTY, Mask::EMPTY);
        (self.ghosts, self.seen, self.middle) = (0, false, None);
    }

    fn learn(&mut self, frame: &Frame, differs: &Mask) {
        // Pixels that newly differ from the scene count as moving, even of equal brightness.
        let mut new = self.apart.clone();
        new.invert();
        new.unite(&self.moving);
        new.intersect(differs);
        new.erode(1);
        if (new.count() as f32) < LEARN_MIN * PIXELS as f32 {
            return;
        }
        // The inside of a plain object looks the same while it moves.
        new.dilate(INSIDE_PX);
        new.intersect(differs);
        let (mut moving, mut hidden): (Histogram, Histogram) = ([0; BINS], [0; BINS]);
        new.for_each(|at| {
            let count = |count: &mut u16| *count = count.saturating_add(1);
            count(&mut moving[self.bins.of(frame.colour(at))]);
            count(&mut hidden[self.bins.of(self.scene.colour(at))]);
        });
        // A moving background hides colours of its own: half of their usual share is taken away too.
        let mut scene: Histogram = [0; BINS];
        (0..PIXELS).step_by(SAMPLE).for_each(|at| scene[self.bins.of(self.scene.colour(at))] += 1);
        let count = new.count();
        for (hidden, scene) in hidden.iter_mut().zip(scene) {
            *hidden = (*hidden).max((u32::from(scene) * count / (2 * PIXELS / SAMPLE) as u32) as u16);
        }
        self.model.learn(&moving, &hidden);
    }

    /// Lets the scene follow what is not hidden by the object and a margin around it. What differs may be an object that is
    /// not recognised yet, or a part of one, and is followed in one frame of several only.
    fn remember(&mut self, frame: &Frame, differs: &Mask) {
        let mut hidden = self.near.clone();
        let doubt = if self.seen { DOUBT_FRAMES } else { DOUBT_FRAMES_EMPTY };
        if !self.frames.is_multiple_of(doubt) {
            // A change that stands still far from an object belongs to the scene.
            let mut doubtful = self.moving.clone();
            doubtful.dilate(MOVES_PX);
            let mut close = self.near.clone();
            close.dilate(CLOSE_PX);
            doubtful.unite(&close);
            doubtful.intersect(differs);
            hidden.unite(&doubtful);
        }
        hidden.dilate(3);
        self.scene.follow(frame, &hidden, SCENE_RATE);
    }
}

/// Whether an object goes on beyond the picture's border: it reaches the border, or what differs from the scene leads on to it.
fn is_cut(object: &Mask, unknown: Option<&Mask>) -> bool {
    let mut grown = object.clone();
    if let Some(unknown) = unknown.filter(|_| object.comes_within(REACH_PX)) {
        for _ in 0..REACH_PX {
            grown.dilate(1);
            grown.intersect(unknown);
        }
        grown.unite(object);
    }
    grown.comes_within(1)
}

/// Moving pixels at both ends of an object: four times those of the quieter end, at most all.
fn spread_count(slip: &Mask, object: &Moments) -> u32 {
    let (sin, cos) = (libm::sinf(object.angle_rad()), libm::cosf(object.angle_rad()));
    let (mut here, mut there) = (0u32, 0u32);
    slip.for_each(|at| {
        let (dx, dy) = ((at % WIDTH) as f32 - object.middle.x, (at / WIDTH) as f32 - object.middle.y);
        let ahead = dx * cos + dy * sin > 0.0;
        (here, there) = (here + u32::from(ahead), there + u32::from(!ahead));
    });
    (here + there).min(4 * here.min(there))
}
