//! What the films' part of o1 is of nothing: their noise, weighed as they are. It is learned while the finger is unloaded and
//! nothing is loud, cycle by cycle; a film whose own noise is above the threshold would otherwise say slip for ever.

use tenax_hal_shim::channel::FRAMES_PER_SLOW_FRAME;

/// The mean follows over `2^FOLLOWS` cycles, 0.1 s.
const FOLLOWS: u32 = 3;
/// A tick of nothing stays below so many times its mean, which is that of what is above the films' medians.
const FLOOR: i64 = 6;

/// The mean of a cycle.
#[derive(Clone, Debug, Default)]
pub(super) struct Noise {
    /// Of this cycle so far; units of an output, the farther below 0 the larger.
    sum: i64,
    /// Of a cycle of nothing, once there was one.
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

    /// What no tick of nothing reaches; 0 while that is not known.
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
