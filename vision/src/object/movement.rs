//! What moves: pixels that are not as they were a moment ago. Two ways, to be compared.

use alloc::boxed::Box;
use alloc::vec;

use super::scene::levels;
use crate::frame::{Frame, PIXELS};

/// Marks moving pixels.
pub trait Movement {
    /// Takes a frame; marks with 1 what moves.
    fn step(&mut self, frame: &Frame, grey: &[u8; PIXELS], into: &mut [u8; PIXELS]);
}

/// The cheap way: one running mean of the grey level.
#[derive(Clone, Debug)]
pub struct Running {
    mean: Box<[i16; PIXELS]>,
    started: bool,
    apart: i16,
    rate: u32,
}

impl Running {
    /// A pixel moves if it is more than `apart` grey levels from the mean of the last 2^`rate` frames or so.
    pub fn new(apart: u8, rate: u32) -> Self {
        Self { mean: levels(), started: false, apart: i16::from(apart), rate }
    }
}

impl Default for Running {
    /// Twice the noise of a cheap camera, and a mean that has forgotten a move after some six frames.
    fn default() -> Self {
        Self::new(14, 2)
    }
}

impl Movement for Running {
    fn step(&mut self, _: &Frame, grey: &[u8; PIXELS], into: &mut [u8; PIXELS]) {
        let (rate, limit) = (if self.started { self.rate } else { 0 }, self.apart << 7);
        let mean = &mut *self.mean;
        for at in 0..PIXELS {
            let off = (i16::from(grey[at]) << 7) - mean[at];
            into[at] = u8::from(off.abs() > limit);
            mean[at] += off >> rate;
        }
        if !self.started {
            (self.started, _) = (true, into.fill(0));
        }
    }
}

/// Components of a mixture.
const COMPONENTS: usize = 3;
/// Weight above which the heaviest components together are the background.
const BACKGROUND: f32 = 0.9;
/// Squared distance, in variances, within which a colour belongs to a component.
const MEMBER: f32 = 16.0;
/// A new component's variance, and the bounds of all.
const VARIANCE: (f32, f32, f32) = (15.0, 4.0, 75.0);
/// Weight that each component loses in a frame besides, of the rate: what is not seen again goes away.
const PRUNE: f32 = 0.05;

#[derive(Clone, Copy, Debug, Default)]
struct Component {
    weight: f32,
    colour: [f32; 3],
    variance: f32,
}

/// A mixture of coloured Gaussians for each pixel, adapted as by Zivkovic (2004), which is what OpenCV's MOG2 does.
#[derive(Clone, Debug)]
pub struct Mixture {
    pixels: Box<[[Component; COMPONENTS]]>,
    frames: u32,
    history: u32,
}

impl Mixture {
    /// One that remembers some `history` frames.
    pub fn new(history: u32) -> Self {
        Self {
            pixels: vec![[Component::default(); COMPONENTS]; PIXELS].into_boxed_slice(),
            frames: 0,
            history,
        }
    }
}

impl Default for Mixture {
    /// As long as OpenCV's.
    fn default() -> Self {
        Self::new(500)
    }
}

impl Movement for Mixture {
    fn step(&mut self, frame: &Frame, _: &[u8; PIXELS], into: &mut [u8; PIXELS]) {
        self.frames = (self.frames + 1).min(self.history);
        let rate = 1.0 / (2 * self.frames).min(self.history) as f32;
        let colours = frame.red.iter().zip(frame.green).zip(frame.blue);
        for ((components, moves), ((&red, &green), &blue)) in self.pixels.iter_mut().zip(into).zip(colours) {
            *moves = u8::from(!is_background(components, [red.into(), green.into(), blue.into()], rate));
        }
    }
}

/// Whether a colour is the background's; the components, heaviest first, learn it.
fn is_background(components: &mut [Component; COMPONENTS], colour: [f32; 3], rate: f32) -> bool {
    let (mut background, mut fits, mut sum) = (false, false, 0.0);
    let mut at = 0;
    while at < COMPONENTS && components[at].weight > 0.0 {
        let component = &mut components[at];
        let heavier = sum;
        component.weight = (1.0 - rate) * component.weight - rate * PRUNE;
        if !fits {
            let off = [0, 1, 2].map(|plane| colour[plane] - component.colour[plane]);
            let distance = off[0] * off[0] + off[1] * off[1] + off[2] * off[2];
            if distance < MEMBER * component.variance {
                fits = true;
                background = heavier < BACKGROUND;
                component.weight += rate;
                let step = rate / component.weight;
                for (mean, off) in component.colour.iter_mut().zip(off) {
                    *mean += step * off;
                }
                let variance = component.variance + step * (distance - component.variance);
                component.variance = variance.clamp(VARIANCE.1, VARIANCE.2);
            }
        }
        component.weight = component.weight.max(0.0);
        sum += component.weight;
        let mut place = at;
        while place > 0 && components[place].weight > components[place - 1].weight {
            components.swap(place, place - 1);
            place -= 1;
        }
        at += 1;
    }
    if !fits {
        let slot = at.min(COMPONENTS - 1);
        components[slot] =
            Component { weight: if sum == 0.0 { 1.0 } else { rate }, colour, variance: VARIANCE.0 };
        sum = components.iter().map(|component| component.weight).sum();
        let mut place = slot;
        while place > 0 && components[place].weight > components[place - 1].weight {
            components.swap(place, place - 1);
            place -= 1;
        }
    }
    if sum > 0.0 {
        for component in components.iter_mut() {
            component.weight /= sum;
        }
    }
    background
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Plane;

    fn plane(level: u8) -> Box<Plane> {
        vec![level; PIXELS].into_boxed_slice().try_into().unwrap()
    }

    /// A scene that flickers between two levels at one pixel and in which another changes for good.
    fn marks(movement: &mut impl Movement) -> [usize; 3] {
        let (mut grey, mut into) = (plane(100), plane(0));
        let mut marked = [0; 3];
        for number in 0..200 {
            grey[5] = if number % 2 == 0 { 80 } else { 160 };
            grey[6] = if number < 150 { 100 } else { 140 };
            movement.step(&Frame { red: &grey, green: &grey, blue: &grey }, &grey, &mut into);
            if number >= 150 {
                marked = [
                    marked[0] + usize::from(into[5]),
                    marked[1] + usize::from(into[6]),
                    marked[2] + usize::from(into[7]),
                ];
            }
        }
        marked
    }

    #[test]
    fn a_mixture_learns_what_flickers_and_a_mean_does_not() {
        let mixture = marks(&mut Mixture::new(100));
        assert_eq!((mixture[0], mixture[2]), (0, 0));
        assert!(mixture[1] > 3, "{mixture:?}");
        let running = marks(&mut Running::new(14, 3));
        assert_eq!((running[0], running[2]), (50, 0));
        assert!((5..20).contains(&running[1]), "{running:?}");
    }

    #[test]
    fn the_first_frame_moves_nowhere() {
        let (grey, mut into) = (plane(100), plane(1));
        Running::new(14, 3).step(&Frame { red: &grey, green: &grey, blue: &grey }, &grey, &mut into);
        assert_eq!(into.iter().map(|&moves| usize::from(moves)).sum::<usize>(), 0);
    }
}
