//! Noise floor of the films' part of o1, with the present weights. It is measured each slow frame while the finger is unloaded and
//! nothing is loud. Without it, a film whose noise is above the threshold would report slip without end.

use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;

/// The mean follows over `2^FOLLOWS` cycles, 0.1 s.
const FOLLOWS: u32 = 3;
/// A quiet tick stays below so many times the quiet mean, which is that of what is above the films' medians.
const FLOOR: i64 = 6;

/// The mean noise of a slow frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Noise {
    /// Sum of this slow frame so far, units of an output; positive if the films' part is below 0.
    sum: i64,
    /// Averaged sum of quiet slow frames, units of an output; None before the first.
    nothing: Option<i64>,
    floor: i64,
}

impl Noise {
    /// Takes the films' part of o1 of a tick.
    #[inline]
    pub(super) const fn add(&mut self, by_films: i64) {
        self.sum -= by_films;
    }

    /// Ends a cycle. `is_nothing`: the finger is unloaded, and nothing is loud.
    #[inline(never)]
    pub(super) fn end_cycle(&mut self, is_nothing: bool) {
        let sum = core::mem::take(&mut self.sum).max(0);
        if is_nothing {
            let nothing = self.nothing.map_or(sum, |before| before + ((sum - before) >> FOLLOWS));
            self.nothing = Some(nothing);
            self.floor = FLOOR * nothing / i64::from(FRAMES_PER_SLOW_FRAME);
        }
    }

    /// The noise floor of a tick, units of an output: quiet ticks stay below. 0 while it is not known.
    pub(super) const fn floor(&self) -> i64 {
        self.floor
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_floor_follows_what_is_of_nothing_and_nothing_else() {
        let mut noise = Noise::default();
        let mut cycle = |of_a_tick: i64, is_nothing: bool| {
            for _ in 0..FRAMES_PER_SLOW_FRAME {
                noise.add(-of_a_tick);
            }
            noise.end_cycle(is_nothing);
            noise.floor()
        };
        assert_eq!(cycle(1_000, false), 0);
        assert_eq!(cycle(100, true), 600);
        assert_eq!(cycle(1_000_000, false), 600);
        let settled = (0..80).map(|_| cycle(200, true)).last().unwrap();
        assert!((1_190..=1_200).contains(&settled), "{settled}");
        // An untaught network hears nothing, and its floor is nothing.
        assert!((0..80).map(|_| cycle(0, true)).last().unwrap() < 20);
    }
}
