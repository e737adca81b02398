//! Noise floor of the films' part of o1, measured while the finger is unloaded and nothing is loud.

use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;

const FOLLOWS: u32 = 3;
const FLOOR: i64 = 6;

#[derive(Clone, Debug, Default)]
pub(super) struct Noise {
    /// Sum of this slow frame, units of an output; positive if the films' part is below 0.
    sum: i64,
    nothing: Option<i64>,
    /// Units of an output; 0 while it is not known.
    pub floor: i64,
}

impl Noise {
    #[inline]
    pub(super) const fn add(&mut self, by_films: i64) {
        self.sum -= by_films;
    }

    #[inline(never)]
    pub(super) fn end_cycle(&mut self, is_nothing: bool) {
        let sum = core::mem::take(&mut self.sum).max(0);
        if is_nothing {
            let nothing = self.nothing.map_or(sum, |before| before + ((sum - before) >> FOLLOWS));
            self.nothing = Some(nothing);
            self.floor = FLOOR * nothing / i64::from(FRAMES_PER_SLOW_FRAME);
        }
    }
}
