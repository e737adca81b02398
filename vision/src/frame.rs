//! A picture as planes of bytes: every loop over one is a loop over a whole slice, which the compiler vectorises.

pub const WIDTH: usize = 320;
pub const HEIGHT: usize = 240;
pub const PIXELS: usize = WIDTH * HEIGHT;
/// Bytes of a picture of three planes.
pub const FRAME_BYTES: usize = 3 * PIXELS;

pub type Plane = [u8; PIXELS];

/// A value for each pixel, 0.
pub fn plane<T: Clone + Default>() -> Box<[T; PIXELS]> {
    match vec![T::default(); PIXELS].into_boxed_slice().try_into() {
        Ok(plane) => plane,
        Err(_) => unreachable!("its length is that of a plane"),
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Red, 0 to 255.
    pub red: &'a Plane,
    pub green: &'a Plane,
    pub blue: &'a Plane,
}

impl<'a> Frame<'a> {
    /// The picture in `bytes`, planes in the order green, blue, red: ffmpeg's raw `gbrp`. None if the length is another.
    pub fn from_gbrp(bytes: &'a [u8]) -> Option<Self> {
        let (green, rest) = bytes.split_first_chunk::<PIXELS>()?;
        let (blue, rest) = rest.split_first_chunk::<PIXELS>()?;
        let red = rest.try_into().ok()?;
        Some(Self { red, green, blue })
    }

    pub const fn colour(&self, at: usize) -> [u8; 3] {
        [self.red[at], self.green[at], self.blue[at]]
    }

    pub fn grey(&self, into: &mut Plane) {
        let colours = self.red.iter().zip(self.green).zip(self.blue);
        for (grey, ((&red, &green), &blue)) in into.iter_mut().zip(colours) {
            let sum = u16::from(red) + 2 * u16::from(green) + u16::from(blue) + 2;
            *grey = (sum >> 2) as u8;
        }
    }
}

/// A place in a picture, pixels; the middle of the top left pixel is (0, 0), x goes right and y down.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    pub x: f32,
    pub y: f32,
}

impl Point {
    pub fn distance(self, other: Self) -> f32 {
        libm::hypotf(self.x - other.x, self.y - other.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_s_planes_are_green_blue_and_red_and_one_of_another_size_is_none() {
        let planes: Vec<u8> = (0..FRAME_BYTES).map(|at| (at / PIXELS) as u8).collect();
        let frame = Frame::from_gbrp(&planes).unwrap();
        assert_eq!((frame.green[9], frame.blue[9], frame.red[9]), (0, 1, 2));
        assert!(Frame::from_gbrp(&planes[1..]).is_none());
    }
}
