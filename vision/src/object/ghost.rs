//! A ghost: a place that an object has left and where the scene has changed meanwhile. Unlike an object it has no rim in the picture, where
//! the remembered scene may have one. Colours are compared: an object may be as bright as the wall behind it.

use super::scene::Scene;
use crate::frame::{Frame, HEIGHT, WIDTH};
use crate::mask::Mask;

/// Contrast of an object's rim over that of what is remembered there, at least.
const STANDS_OUT: u32 = 3;
/// A rim with more contrast than this is an object's, levels of a colour over six pixels.
const CONTRAST_MIN: u32 = 24;
const RIM_MIN_PX: u32 = 60;
const REACH: usize = 3;

pub fn is_one(object: &Mask, skin: &Mask, frame: &Frame, scene: &Scene) -> bool {
    let mut rim = object.clone();
    rim.erode(1);
    rim.invert();
    rim.intersect(object);
    rim.subtract(skin);
    let (mut seen, mut remembered, mut count) = (0u32, 0u32, 0u32);
    rim.for_each(|at| {
        let (x, y) = (at % WIDTH, at / WIDTH);
        if (REACH..WIDTH - REACH).contains(&x) && (REACH..HEIGHT - REACH).contains(&y) {
            let across = |colour: &dyn Fn(usize) -> [u8; 3]| {
                let apart = |reach: usize| far(colour(at - reach), colour(at + reach));
                apart(REACH).max(apart(REACH * WIDTH))
            };
            seen += across(&|at| frame.colour(at));
            remembered += across(&|at| scene.colour(at));
            count += 1;
        }
    });
    count >= RIM_MIN_PX && seen < CONTRAST_MIN * count && seen < STANDS_OUT * remembered
}

fn far(a: [u8; 3], b: [u8; 3]) -> u32 {
    (0..3).map(|n| u32::from(a[n].abs_diff(b[n]))).fold(0, u32::max)
}
