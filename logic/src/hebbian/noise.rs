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
            noise.floor
        };
        assert_eq!(cycle(1_000, false), 0);
        assert_eq!(cycle(100, true), 600);
        assert_eq!(cycle(1_000_000, false), 600);
        let settled = (0..80).map(|_| cycle(200, true)).last().unwrap();
        assert!((1_190..=1_200).contains(&settled), "{settled}");
        assert!((0..80).map(|_| cycle(0, true)).last().unwrap() < 20);
    }
}
