//! Where an object was, the scene may have changed meanwhile: what is seen there is not what is remembered, and it is no object.
//! An object has a rim in the picture, and a ghost has none.

use crate::frame::{HEIGHT, Plane, WIDTH};
use crate::mask::Mask;

/// A rim with less contrast than this is none, grey levels over six pixels.
const CONTRAST_MIN: u32 = 14;
/// Rim pixels that are needed to tell.
const RIM_MIN_PX: u32 = 60;
/// How far from the rim the levels are compared, px: it is found to a pixel or two only.
const REACH: usize = 3;

/// Whether `object` is a ghost.
pub fn is_one(object: &Mask, skin: &Mask, grey: &Plane) -> bool {
    let mut rim = object.clone();
    rim.erode(1);
    rim.invert();
    rim.intersect(object);
    rim.subtract(skin);
    let (mut contrast, mut count) = (0u32, 0u32);
    rim.for_each(|at| {
        let (x, y) = (at % WIDTH, at / WIDTH);
        if (REACH..WIDTH - REACH).contains(&x) && (REACH..HEIGHT - REACH).contains(&y) {
            let apart = |reach: usize| u32::from(grey[at - reach].abs_diff(grey[at + reach]));
            contrast += apart(REACH).max(apart(REACH * WIDTH));
            count += 1;
        }
    });
    count >= RIM_MIN_PX && contrast < CONTRAST_MIN * count
}
