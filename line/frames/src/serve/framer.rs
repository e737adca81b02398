//! A stream of bytes, cut after each zero, what a receiver takes for one frame, or after each line. What is in it is not looked at.

use tenax_hal_shim::wire::FRAME_MAX;

#[derive(Debug, Default)]
pub struct Framer {
    bytes: Vec<u8>,
    /// What each ends with.
    end: u8,
}

impl Framer {
    /// Gathers what ends so.
    pub const fn ending(end: u8) -> Self {
        Self { bytes: Vec::new(), end }
    }

    /// Takes a byte; gives the frame that it ends. Of one that is too long to be any, as much as shows that.
    pub fn push(&mut self, byte: u8) -> Option<Vec<u8>> {
        if byte == self.end || self.bytes.len() <= FRAME_MAX {
            self.bytes.push(byte);
        }
        (byte == self.end).then(|| std::mem::take(&mut self.bytes))
    }

    /// Forgets what has no end yet.
    pub fn clear(&mut self) {
        self.bytes.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_end_with_their_zero_and_none_grows_for_ever() {
        let mut framer = Framer::default();
        let frames: Vec<_> = [1, 2, 0, 0, 3].iter().filter_map(|&byte| framer.push(byte)).collect();
        assert_eq!(frames, [vec![1, 2, 0], vec![0]]);
        framer.clear();
        (0..1 << 20).for_each(|_| assert_eq!(framer.push(7), None));
        assert_eq!(framer.push(0).unwrap().len(), FRAME_MAX + 2);
    }
}
