//! Pictures of a camera behind a clear skin: markers that the contact moves, an object, a background, with the faults of a cheap
//! camera: fisheye, blur, noise, rolling shutter, changing light (FingerVision 2017). The same seed gives the same pictures.

pub mod story;
mod texture;

use self::story::{State, Story};
use self::texture::Texture;
use crate::random::{Noise, Source};

pub const WIDTH: usize = 320;
pub const HEIGHT: usize = 240;
pub const PIXELS: usize = WIDTH * HEIGHT;
const NOISE: usize = 1 << 18;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    pub seed: u64,
    pub rate_hz: f64,
    pub fisheye: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stress {
    /// Brightness of the object over that of the wall, levels; darker where there is no room.
    pub apart: Option<f64>,
    pub colour: Option<f64>,
    /// Contrast of its pattern, levels.
    pub texture: Option<f64>,
    /// Factor of slides and turns.
    pub speed: f64,
    /// Part by which the mains' light goes up and down.
    pub flicker: f64,
    /// Part of the markers that is gone from the grasp on.
    pub markers_lost: f64,
}

impl Default for Stress {
    fn default() -> Self {
        Self { apart: None, colour: None, texture: None, speed: 1.0, flicker: 0.0, markers_lost: 0.0 }
    }
}

const FLICKER_HZ: f64 = 100.0;

#[derive(Clone, Debug)]
pub struct Session {
    options: Options,
    stress: Stress,
    story: Story,
    lens: Lens,
    background: Texture,
    surface: Texture,
    half: (f64, f64),
    markers: Vec<Marker>,
    contact_px: f64,
    sigma: f64,
    readout_s: f64,
    noise: Vec<f32>,
    flat: Vec<(f32, f32)>,
    frame: u32,
}

#[derive(Clone, Copy, Debug)]
struct Marker {
    at: (f64, f64),
    radius_px: f64,
    level: f32,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    pub t_s: f64,
    pub markers: Vec<((f64, f64), (f64, f64))>,
    pub state: State,
    pub in_view: bool,
    pub whole: bool,
    pub slides: bool,
    pub gripped: bool,
}

impl Session {
    pub fn new(options: Options) -> Self {
        Self::under(options, Stress::default())
    }

    pub fn under(options: Options, stress: Stress) -> Self {
        let mut noise = Noise::new(options.seed, Source::Picture);
        let middle = ((WIDTH as f64 - 1.0) / 2.0, (HEIGHT as f64 - 1.0) / 2.0);
        let focal_px = if options.fisheye { noise.between(190.0, 300.0) } else { f64::INFINITY };
        let lens = Lens { focal_px, middle };
        let wall = noise.between(110.0, 190.0);
        let base = [0.0; 3].map(|_: f64| wall * noise.between(0.85, 1.1));
        let background = Texture::drawn(&mut noise, base, 30.0, 60);
        // An object that differs from the wall in colour or in brightness, and may share parts of both.
        let mut own = [0.0; 3].map(|_: f64| noise.between(30.0, 220.0));
        if let Some(apart) = stress.apart {
            let sign = if wall + apart < 220.0 { 1.0 } else { -1.0 };
            own = base.map(|level| level + sign * apart);
        }
        if let Some(colour) = stress.colour {
            // Grey is half green, so the brightness stays.
            let [red, green, blue] = base;
            own = [red - colour, green + colour / 3.0, blue + colour / 3.0];
        }
        let contrast = noise.between(15.0, 45.0);
        let surface = Texture::drawn(&mut noise, own, stress.texture.unwrap_or(contrast), 500);
        let half = (noise.between(65.0, 95.0), noise.between(16.0, 30.0));
        let story = Story::drawn(&mut noise, stress.speed);
        let (pitch, radius_px) = (noise.between(38.0, 48.0), noise.between(3.6, 5.4));
        let level = noise.between(10.0, 32.0);
        let mut markers = Vec::new();
        for row in -4i32..=4 {
            for column in -5i32..=5 {
                let shaken = (noise.between(-2.0, 2.0), noise.between(-2.0, 2.0));
                let at = (
                    middle.0 + pitch * f64::from(column) + shaken.0,
                    middle.1 + pitch * f64::from(row) + shaken.1,
                );
                let radius_px = radius_px * noise.between(0.9, 1.1);
                let level = (level * noise.between(0.8, 1.2)) as f32;
                let seen = lens.seen(at);
                let inside = |place: f64, end: usize| place > 16.0 && place < end as f64 - 17.0;
                if inside(seen.0, WIDTH) && inside(seen.1, HEIGHT) {
                    markers.push(Marker { at, radius_px, level });
                }
            }
        }
        let contact_px = noise.between(50.0, 90.0);
        let (sigma, readout_s) = (noise.between(1.0, 3.0), noise.between(0.004, 0.016));
        let mut grain = Noise::new(options.seed, Source::PictureNoise);
        let noise = (0..NOISE).map(|_| grain.normal() as f32).collect();
        let flat = (0..PIXELS)
            .map(|at| lens.flat(((at % WIDTH) as f64, (at / WIDTH) as f64)))
            .map(|(x, y)| (x as f32, y as f32))
            .collect();
        Self {
            options,
            stress,
            story,
            lens,
            background,
            surface,
            half,
            markers,
            contact_px,
            sigma,
            readout_s,
            noise,
            flat,
            frame: 0,
        }
    }

    pub const fn lens(&self) -> Lens {
        self.lens
    }

    pub const fn markers(&self) -> usize {
        self.markers.len()
    }

    /// Draws the next picture, planes in the order green, blue, red. None after the story's end.
    pub fn picture(&mut self, gbrp: &mut [u8]) -> Option<Truth> {
        let t_s = f64::from(self.frame) / self.options.rate_hz;
        if t_s >= story::END_S || gbrp.len() != 3 * PIXELS {
            return None;
        }
        // Any place will do, and the same seed gives the same ones.
        let start = (self.frame as usize).wrapping_mul(104_729) % NOISE;
        self.frame += 1;
        let (green, rest) = gbrp.split_at_mut(PIXELS);
        let (blue, red) = rest.split_at_mut(PIXELS);
        for y in 0..HEIGHT {
            let row_s = self.row_time_s(t_s, y as f64);
            let state = self.story.at(row_s);
            let mains = libm::sin(std::f64::consts::TAU * FLICKER_HZ * row_s);
            let light = (state.exposure * (1.0 + self.stress.flicker * mains)) as f32;
            let near = self.near(&state, (row_s, y as f64));
            for x in 0..WIDTH {
                let at = y * WIDTH + x;
                let colour = self.colour(&state, &near, at);
                let grain = |plane: usize| self.noise[(start + 3 * at + plane) % NOISE] * self.sigma as f32;
                let level = |plane: usize| (colour[plane] * light + grain(plane)).round().clamp(0.0, 255.0);
                (red[at], green[at], blue[at]) = (level(0) as u8, level(1) as u8, level(2) as u8);
            }
        }
        Some(self.truth(t_s))
    }

    fn row_time_s(&self, t_s: f64, y: f64) -> f64 {
        t_s + self.readout_s * y / HEIGHT as f64
    }

    fn near(&self, state: &State, (row_s, y): (f64, f64)) -> Vec<((f64, f64), f64, f32)> {
        let lost = if row_s < story::GRASPED_S { 0.0 } else { self.stress.markers_lost };
        // Lost ones lie everywhere: each step of the golden ratio is far from those before.
        let is_there = |number: usize| (number as f64 * 0.618_034).fract() >= lost;
        let there = self.markers.iter().enumerate().filter(|(number, _)| is_there(*number));
        let moved = there.map(|(_, marker)| (self.moved(state, marker.at), marker.radius_px, marker.level));
        moved.filter(|(at, radius, _)| (self.lens.seen(*at).1 - y).abs() < radius + 3.0).collect()
    }

    fn moved(&self, state: &State, (x, y): (f64, f64)) -> (f64, f64) {
        let (dx, dy) = (x - self.lens.middle.0, y - self.lens.middle.1);
        let r = libm::hypot(dx, dy) / self.contact_px;
        let sheared = 0.3 + 0.7 * libm::exp(-r * r / 2.0);
        // Incompressible skin is pushed outwards, most at the contact's rim.
        let pushed = state.press_px * libm::exp((1.0 - r * r) / 2.0) / self.contact_px;
        (x + state.shear_px.0 * sheared + dx * pushed, y + state.shear_px.1 * sheared + dy * pushed)
    }

    fn colour(&self, state: &State, near: &[((f64, f64), f64, f32)], at: usize) -> [f32; 3] {
        let (x, y) = (f64::from(self.flat[at].0), f64::from(self.flat[at].1));
        let (sin, cos) = (libm::sin(state.angle_rad), libm::cos(state.angle_rad));
        let (dx, dy) = (x - state.object.0, y - state.object.1);
        let (along, across) = (dx * cos + dy * sin, dy * cos - dx * sin);
        // Distance inside the object, px: its rim is blurred over one.
        let inside = (self.half.0 - along.abs()).min(self.half.1 - across.abs());
        let part = (inside + 0.5).clamp(0.0, 1.0) as f32;
        let mut colour = if part < 1.0 {
            self.background.at(x + state.background.0, y + state.background.1)
        } else {
            [0.0; 3]
        };
        if part > 0.0 {
            let own = self.surface.at(along + 256.0, across + 256.0);
            (0..3).for_each(|plane| colour[plane] += (own[plane].clamp(5.0, 250.0) - colour[plane]) * part);
        }
        for ((mx, my), radius, level) in near {
            let covered = ((radius - libm::hypot(x - mx, y - my)) / 1.4 + 0.5).clamp(0.0, 1.0) as f32;
            (0..3).for_each(|plane| colour[plane] += (level - colour[plane]) * covered);
        }
        colour
    }

    fn truth(&self, t_s: f64) -> Truth {
        let seen = |place: (f64, f64)| self.lens.seen(place);
        let imaged = |marker: &Marker| {
            let rest = seen(marker.at);
            let state = self.story.at(self.row_time_s(t_s, rest.1));
            (seen(self.moved(&state, marker.at)), rest)
        };
        let state = self.story.at(self.row_time_s(t_s, HEIGHT as f64 / 2.0));
        let (sin, cos) = (libm::sin(state.angle_rad), libm::cos(state.angle_rad));
        let place = |along: f64, across: f64| {
            let (x, y) = seen((
                state.object.0 + along * cos - across * sin,
                state.object.1 + along * sin + across * cos,
            ));
            x > 0.0 && y > 0.0 && x < WIDTH as f64 - 1.0 && y < HEIGHT as f64 - 1.0
        };
        let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
        let whole = corners.iter().all(|(a, b)| place(a * self.half.0, b * self.half.1));
        let in_view = (-4..=4).any(|step| place(f64::from(step) / 4.0 * self.half.0, 0.0));
        let middle_s = self.row_time_s(t_s, HEIGHT as f64 / 2.0);
        Truth {
            t_s,
            markers: self.markers.iter().map(imaged).collect(),
            state,
            in_view,
            whole,
            slides: Story::slides(middle_s),
            gripped: Story::gripped(middle_s),
        }
    }
}

/// A fisheye lens: equidistant, r = f theta.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    pub focal_px: f64,
    pub middle: (f64, f64),
}

impl Lens {
    pub fn seen(&self, (x, y): (f64, f64)) -> (f64, f64) {
        self.scaled((x, y), |r| self.focal_px * libm::atan(r / self.focal_px))
    }

    pub fn flat(&self, (x, y): (f64, f64)) -> (f64, f64) {
        // Nothing is seen beyond 80 degrees.
        self.scaled((x, y), |r| self.focal_px * libm::tan((r / self.focal_px).min(1.4)))
    }

    fn scaled(&self, (x, y): (f64, f64), radius: impl Fn(f64) -> f64) -> (f64, f64) {
        let (dx, dy) = (x - self.middle.0, y - self.middle.1);
        let r = libm::hypot(dx, dy);
        if r < 1e-9 || !self.focal_px.is_finite() {
            return (x, y);
        }
        let scale = radius(r) / r;
        (self.middle.0 + dx * scale, self.middle.1 + dy * scale)
    }
}
