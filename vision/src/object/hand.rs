//! Leaves out the hand that brings an object. Skin is redder than the scene's mean colour, and not as red as paint; so are wood and
//! cardboard, so a hand is left out only where most of what is seen is something else.

use crate::frame::Frame;
use crate::mask::Mask;

/// Red of skin over green, white balance corrected, 1/64.
const REDDER: (u32, u32) = (70, 110);
/// Red over blue, 1/64.
const WARMER: u32 = 74;

/// Takes a hand out of `object`, if what is left is large enough to be one, `least` pixels.
pub fn leave_out(object: &mut Mask, frame: &Frame, white: [u8; 3], least: u32) {
    let all = object.count();
    if all == 0 {
        return;
    }
    let white = white.map(|level| u32::from(level.max(1)));
    // Each as bright as green, were it grey; 1/256.
    let [red_gain, blue_gain] = [white[0], white[2]].map(|own| (white[1] << 8) / own);
    let mut skin = object.clone();
    skin.keep(frame, |red, green, blue| {
        let red = (u32::from(red) * red_gain) >> 8;
        let blue = (u32::from(blue) * blue_gain) >> 8;
        let green = u32::from(green);
        // No short cuts: they would be jumps.
        (64 * red > REDDER.0 * green) & (64 * red < REDDER.1 * green) & (64 * red > WARMER * blue)
    });
    // Specks are noise; gaps between them are skin in another light.
    skin.erode(1);
    skin.dilate(6);
    skin.erode(4);
    // A hand comes from outside: what does not reach the border is the object's own colour.
    skin.keep_at_border();
    if skin.count() == 0 {
        return;
    }
    let mut rest = skin;
    rest.invert();
    rest.intersect(object);
    // Its rim remains and is not the object.
    rest.erode(4);
    rest.dilate(4);
    rest.intersect(object);
    // A hand comes from outside: what is surrounded by the object is printed on it.
    rest.fill_holes();
    if 2 * rest.count() >= all {
        rest.keep_large(25);
        if rest.count() >= least {
            *object = rest;
        }
    }
}
