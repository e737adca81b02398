//! Calibration of a wearer: levels of rest and of two chosen contractions. The electrode that is relatively
//! stronger in a contraction is its site.

pub use tenax_hal_shim::words::CalibrationRefusal as Refusal;

use super::level::{FLOOR_LEVEL, TOP_LEVEL, level_of};

pub const MODEL_WORDS: usize = 11;
const VERSION: i32 = 2;

pub(super) const fn octaves(permille: i32) -> i32 {
    permille * 1_024 / 1_000
}

/// Least rise of a contraction's site above rest: a factor of 2.3.
const LEAST_RISE: i32 = octaves(1_200);
const LEAST_TURN: i32 = octaves(1_200);
/// Least distance of two of the three states, in thousandths of their common standard deviation.
pub const LEAST_SEPARATION_PERMILLE: i32 = 2_200;
/// Largest standard deviation of rest: 41 %.
const NOISIEST_REST: i32 = octaves(500);
/// Largest standard deviation of the difference of both levels in a contraction: it cannot be more than their range.
const LARGEST_SPREAD: i32 = TOP_LEVEL - FLOOR_LEVEL;
/// Levels of both electrodes, [`level_of`] of uV, flexor first.
pub type Point = [i32; 2];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EmgModel {
    rest: Point,
    close: Point,
    open: Point,
    spread: Point,
    separation_permille: i32,
    /// Standard deviation of the difference of both levels while the hand closes, Q10 octaves; 0: not known.
    close_spread: i32,
}

impl EmgModel {
    pub const fn new(
        rest: Point,
        close: Point,
        open: Point,
        spread: Point,
        separation_permille: i32,
    ) -> Result<Self, Refusal> {
        Self { rest, close, open, spread, separation_permille, close_spread: 0 }.checked()
    }

    pub const fn with_close_spread(self, close_spread: i32) -> Result<Self, Refusal> {
        Self { close_spread, ..self }.checked()
    }

    const fn checked(self) -> Result<Self, Refusal> {
        match self.check() {
            Some(refusal) => Err(refusal),
            None => Ok(self),
        }
    }

    /// Envelopes of the states, uV, flexor first: for scenes and tests.
    pub const fn of_uv(rest: [i32; 2], close: [i32; 2], open: [i32; 2]) -> Result<Self, Refusal> {
        const fn point(uv: [i32; 2]) -> Point {
            [level_of(uv[0]), level_of(uv[1])]
        }
        const SPREAD: i32 = octaves(150);
        Self::new(point(rest), point(close), point(open), [SPREAD; 2], LEAST_SEPARATION_PERMILLE)
    }

    const fn check(&self) -> Option<Refusal> {
        let mut n = 0;
        while n < 2 {
            let levels = [self.rest[n], self.close[n], self.open[n]];
            let mut k = 0;
            while k < 3 {
                if levels[k] < FLOOR_LEVEL || levels[k] > TOP_LEVEL {
                    return Some(Refusal::Damaged);
                }
                k += 1;
            }
            if self.spread[n] < 0 || self.separation_permille < 0 || self.separation_permille > 1_000_000 {
                return Some(Refusal::Damaged);
            }
            if self.spread[n] > NOISIEST_REST {
                return Some(Refusal::RestNotQuiet);
            }
            n += 1;
        }
        if self.close_spread < 0 || self.close_spread > LARGEST_SPREAD {
            return Some(Refusal::Damaged);
        }
        let (closes, opens) = (self.closing_site(), self.opening_site());
        if self.close[closes] - self.rest[closes] < LEAST_RISE {
            return Some(Refusal::NoClosing);
        }
        if self.open[opens] - self.rest[opens] < LEAST_RISE {
            return Some(Refusal::NoOpening);
        }
        if self.turn() < LEAST_TURN {
            return Some(Refusal::SameDirection);
        }
        if self.separation_permille < LEAST_SEPARATION_PERMILLE {
            return Some(Refusal::Overlap);
        }
        None
    }

    const fn turn(&self) -> i32 {
        ((self.open[1] - self.open[0]) - (self.close[1] - self.close[0])).abs()
    }

    pub const fn closing_site(&self) -> usize {
        let [close, open] = [self.close[1] - self.close[0], self.open[1] - self.open[0]];
        if open >= close { 0 } else { 1 }
    }

    pub const fn opening_site(&self) -> usize {
        1 - self.closing_site()
    }

    pub const fn rest(&self) -> Point {
        self.rest
    }

    pub const fn close(&self) -> Point {
        self.close
    }

    pub const fn open(&self) -> Point {
        self.open
    }

    pub const fn spread(&self) -> Point {
        self.spread
    }

    pub const fn close_spread(&self) -> i32 {
        self.close_spread
    }

    /// Smallest distance of two states, in thousandths of their common standard deviation.
    pub const fn separation_permille(&self) -> i32 {
        self.separation_permille
    }

    pub const fn to_words(&self) -> [i32; MODEL_WORDS] {
        let Self { rest, close, open, spread, separation_permille, close_spread } = self;
        [
            VERSION,
            rest[0],
            rest[1],
            close[0],
            close[1],
            open[0],
            open[1],
            spread[0],
            spread[1],
            *separation_permille,
            *close_spread,
        ]
    }

    pub const fn from_words(words: [i32; MODEL_WORDS]) -> Result<Self, Refusal> {
        let [version, rf, re, cf, ce, of, oe, sf, se, separation, close_spread] = words;
        if version != VERSION {
            return Err(Refusal::Damaged);
        }
        let (rest, close, open, spread) = ([rf, re], [cf, ce], [of, oe], [sf, se]);
        Self { rest, close, open, spread, separation_permille: separation, close_spread }.checked()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MV: i32 = 1_000;

    fn first_session() -> EmgModel {
        EmgModel::of_uv([61 * MV, 48 * MV], [445 * MV, 165 * MV], [156 * MV, 1_490 * MV]).unwrap()
    }

    #[test]
    fn a_model_survives_its_words_and_nonsense_does_not() {
        let words = first_session().to_words();
        assert_eq!(EmgModel::from_words(words), Ok(first_session()));
        assert_eq!(EmgModel::from_words([0; MODEL_WORDS]), Err(Refusal::Damaged));
        assert_eq!(EmgModel::from_words([-1; MODEL_WORDS]), Err(Refusal::Damaged));
        for n in 0..MODEL_WORDS {
            for nonsense in [i32::MIN, -1, i32::MAX] {
                let mut words = words;
                words[n] = nonsense;
                assert!(EmgModel::from_words(words).is_err(), "word {n} = {nonsense}");
            }
        }
    }

    #[test]
    fn the_site_of_a_contraction_is_the_electrode_that_is_relatively_stronger() {
        assert_eq!(first_session().closing_site(), 0);
        let swapped =
            EmgModel::of_uv([48 * MV, 61 * MV], [165 * MV, 445 * MV], [1_490 * MV, 156 * MV]).unwrap();
        assert_eq!(swapped.closing_site(), 1);
        // A fist drives both electrodes alike, extended fingers the extensor's more: its site is the flexor's.
        let fist = EmgModel::of_uv([61 * MV, 48 * MV], [453 * MV, 415 * MV], [156 * MV, 1_490 * MV]).unwrap();
        assert_eq!(fist.closing_site(), 0);
    }

    #[test]
    fn what_does_not_separate_is_refused_with_its_reason() {
        let rest = [60 * MV; 2];
        for (close, open, refusal) in [
            ([100 * MV, 60 * MV], [60 * MV, 900 * MV], Refusal::NoClosing),
            ([600 * MV, 60 * MV], [60 * MV, 90 * MV], Refusal::NoOpening),
            ([600 * MV, 600 * MV], [500 * MV, 900 * MV], Refusal::SameDirection),
        ] {
            assert_eq!(EmgModel::of_uv(rest, close, open), Err(refusal));
        }
        let good = first_session();
        let noisy = EmgModel::new(good.rest, good.close, good.open, [0, 1_100], 9_000);
        assert_eq!(noisy, Err(Refusal::RestNotQuiet));
        let close_by = EmgModel::new(good.rest, good.close, good.open, [0; 2], LEAST_SEPARATION_PERMILLE - 1);
        assert_eq!(close_by, Err(Refusal::Overlap));
    }
}
