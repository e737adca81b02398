//! Drift of the quadrants (cells A to D, clockwise) in a grasp. The element on them is rigid: A + C = B + D.
//! One cell that breaks this is computed from the other three. A slow fall of all with the motor at rest,
//! beyond what skin yields, is drift of all. So is a slow rise, which is reported and not corrected.

use tenax_hal_shim::channel::FSR_COUNT;

use super::sensor::CARRIES_MN;

const SIGNS: [i32; FSR_COUNT] = [1, -1, 1, -1];
/// Tolerated contradiction of the cells, mN, and as a part of the load (Interlink's guide).
const TOLERATED_MN: i32 = 60;
const TOLERATED_PART: i32 = 20;
const CONTRADICTS_FOR: u8 = 40;
const LEARN: u8 = 40;
const LEARN_SHIFT: u32 = 3;
const GAIN_Q: u32 = 12;
/// Averages of a cell over `2^ANCHOR_SHIFT` readings, 3 s; decay of votes over `2^VOTES_SHIFT` readings.
const ANCHOR_SHIFT: u32 = 8;
const VOTES_SHIFT: u32 = 9;
const CLEARLY: i32 = 2;
/// Votes that exceed noise. A vote is 2^VOTE_SHIFT mN^2.
const HEARD: i32 = 200;
const VOTE_SHIFT: u32 = 8;
/// Drift that is followed in a reading, mN: 0.24 N/s of one cell, 0.5 N/s of all.
const CELL_FOLLOWS_MN: i32 = 3;
const ALL_FOLLOWS_MN: i32 = 6;
const STILL_FOR: u32 = 40;
const YIELDS_PART: i32 = 5;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cells {
    Known([i32; FSR_COUNT]),
    /// Too few cells carry a force: it cannot be told from drift.
    Sunk,
}

#[derive(Clone, Debug, Default)]
pub struct Drift {
    /// Quadrant (0 to 3: A to D) that drifts against the others.
    blamed: Option<u8>,
    /// Contradiction beyond the cells' gains, mN: the sign of the blamed cell times its drift.
    off_mn: i32,
    contradicts: u8,
    /// Readings since the grasp began, and A - B + C - D as a part of the load, caused by unequal gains.
    learned: u8,
    gain: i32,
    /// Averages of 3 s, mN Q8, and the part of the contradiction that each cell explains.
    anchors: [i32; FSR_COUNT],
    votes: [i32; FSR_COUNT],
    /// Drift of all cells together, mN, and the load at which they were constant.
    sunk_mn: i32,
    stood_at_mn: Option<i32>,
    /// Load without its slow rise at rest, and with it, mN.
    rests_mn: Option<[i32; 2]>,
    /// All cells together drift upwards in this grasp.
    rises: bool,
}

impl Drift {
    pub fn blamed(&self) -> Option<usize> {
        // `%` lets the compiler drop the bounds check.
        self.blamed.map(|cell| usize::from(cell) % FSR_COUNT)
    }

    /// Cells that drift, one bit each.
    pub fn doubted(&self) -> u8 {
        if self.rises { (1 << FSR_COUNT) - 1 } else { self.blamed().map_or(0, |cell| 1 << cell) }
    }

    /// `loaded_mn`: load of a grasp. `opened`: the motor has opened the hand since it last closed it.
    pub fn step(&mut self, read_mn: [i32; FSR_COUNT], loaded_mn: i32, opened: bool) -> Cells {
        self.let_go(read_mn, opened);
        let cells = self.corrected(read_mn);
        if self.sunk_mn > 0 {
            if cells.iter().sum::<i32>() < loaded_mn {
                self.sunk_mn = 0;
                return Cells::Known(self.corrected(read_mn));
            }
            if read_mn.iter().filter(|&&mn| mn >= CARRIES_MN).count() + 1 < FSR_COUNT {
                return Cells::Sunk;
            }
        }
        Cells::Known(cells)
    }

    pub fn think(&mut self, read_mn: [i32; FSR_COUNT], loaded_mn: i32, still: u32) {
        let load_mn: i32 = self.corrected(read_mn).iter().sum();
        if load_mn < loaded_mn {
            (self.learned, self.contradicts, self.stood_at_mn) = (0, 0, None);
            (self.rests_mn, self.rises) = (None, false);
        } else if self.sunk_mn == 0 || read_mn.iter().filter(|&&mn| mn >= CARRIES_MN).count() + 1 >= FSR_COUNT
        {
            self.contradict(read_mn, load_mn);
            self.sink(load_mn, still);
            self.rise(load_mn, loaded_mn, still);
        }
    }

    fn corrected(&self, mut cells: [i32; FSR_COUNT]) -> [i32; FSR_COUNT] {
        if let Some(blamed) = self.blamed() {
            cells[blamed] -= SIGNS[blamed] * self.off_mn;
        }
        // No cell pulls.
        cells.map(|mn| (mn + self.sunk_mn / FSR_COUNT as i32).max(0))
    }

    fn let_go(&mut self, read_mn: [i32; FSR_COUNT], opened: bool) {
        let carries = |n: usize| read_mn[n] >= CARRIES_MN;
        if let Some(blamed) = self.blamed()
            && (0..FSR_COUNT).all(|n| n == blamed || !carries(n))
            && (opened || self.sunk_mn == 0)
        {
            self.off_mn = SIGNS[blamed] * read_mn[blamed];
            if !carries(blamed) {
                self.blamed = None;
            }
        }
        if opened && !(0..FSR_COUNT).any(carries) {
            self.sunk_mn = 0;
        }
    }

    fn contradict(&mut self, read_mn: [i32; FSR_COUNT], load_mn: i32) {
        if (0..FSR_COUNT).any(|n| read_mn[n] < CARRIES_MN && self.blamed() != Some(n)) {
            // A shear that lifts the element off a cell breaks the rule, too.
            self.contradicts = 0;
            return;
        }
        let of = |cells: &[i32; FSR_COUNT]| cells.iter().zip(SIGNS).map(|(mn, sign)| mn * sign).sum::<i32>();
        // A load is below 2^17.
        let now = of(&read_mn) - if self.blamed.is_some() { self.off_mn } else { 0 };
        if self.learned < LEARN {
            if self.learned == 0 {
                self.anchors = read_mn.map(|mn| mn << ANCHOR_SHIFT);
                self.votes = [0; FSR_COUNT];
                self.gain = 0;
            }
            self.learned += 1;
            let part = ((i64::from(now) << GAIN_Q) / i64::from(load_mn.max(1))) as i32;
            let limit = (1 << GAIN_Q) / 4;
            self.gain += (part.clamp(-limit, limit) - self.gain) >> LEARN_SHIFT;
        }
        let moved = core::array::from_fn(|n| {
            let lacks = (read_mn[n] << ANCHOR_SHIFT) - self.anchors[n];
            self.anchors[n] += lacks >> ANCHOR_SHIFT;
            lacks >> ANCHOR_SHIFT
        });
        let all_moved = of(&moved);
        for ((votes, moved), sign) in self.votes.iter_mut().zip(moved).zip(SIGNS) {
            // A cell moves by less than 2^15 mN, all of them by less than 2^17.
            let vote = (i64::from(all_moved) * i64::from(moved * sign)) >> VOTE_SHIFT;
            *votes = votes.saturating_add(vote as i32).saturating_sub(*votes >> VOTES_SHIFT);
        }
        let excess = now - ((i64::from(load_mn) * i64::from(self.gain)) >> GAIN_Q) as i32;
        let beyond = excess.abs() > TOLERATED_MN + load_mn / TOLERATED_PART;
        self.contradicts = if beyond { self.contradicts.saturating_add(1) } else { 0 };
        let (mut most, mut votes) = (0, self.votes[0]);
        for (cell, &own) in (0..).zip(&self.votes) {
            if own >= votes {
                (most, votes) = (cell, own);
            }
        }
        match self.blamed() {
            None if self.contradicts >= CONTRADICTS_FOR => self.blamed = Some(most),
            Some(blamed) if votes / CLEARLY > self.votes[blamed].max(0) + HEARD => self.blamed = Some(most),
            _ => {}
        }
        if self.blamed.is_some() {
            self.off_mn += excess.clamp(-CELL_FOLLOWS_MN, CELL_FOLLOWS_MN);
        }
    }

    fn sink(&mut self, load_mn: i32, still: u32) {
        if still < STILL_FOR {
            self.stood_at_mn = None;
            return;
        }
        let stood_at_mn = *self.stood_at_mn.get_or_insert(load_mn);
        let yields_mn = stood_at_mn / YIELDS_PART;
        let lacks_mn = stood_at_mn - yields_mn - load_mn;
        if lacks_mn > yields_mn {
            // Faster than any drift: it is another load.
            (self.sunk_mn, self.stood_at_mn) = (0, None);
        } else {
            self.sunk_mn += lacks_mn.clamp(0, ALL_FOLLOWS_MN);
        }
    }

    fn rise(&mut self, load_mn: i32, loaded_mn: i32, still: u32) {
        let [from_mn, follows_mn] = self.rests_mn.unwrap_or([load_mn; 2]);
        let off_mn = load_mn - follows_mn;
        if still < STILL_FOR || off_mn.abs() > TOLERATED_MN + load_mn / TOLERATED_PART {
            self.rests_mn = Some([(from_mn + off_mn).max(0), load_mn]);
            return;
        }
        let follows_mn = follows_mn + off_mn.clamp(-ALL_FOLLOWS_MN, ALL_FOLLOWS_MN);
        let from_mn = from_mn.min(follows_mn);
        self.rests_mn = Some([from_mn, follows_mn]);
        self.rises |= follows_mn - from_mn > loaded_mn.max(from_mn / YIELDS_PART);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    const LOADED_MN: i32 = 600;
    /// Readings since the motor was driven.
    const STILL: u32 = 1_000;
    const MOVES: u32 = 0;

    fn cells(load: f64, x: f64, y: f64) -> [f64; FSR_COUNT] {
        [load + x + y, load + x - y, load - x - y, load - x + y].map(|four| four / 4.0)
    }

    fn step(drift: &mut Drift, read_mn: [i32; FSR_COUNT], still: u32) -> Cells {
        let cells = drift.step(read_mn, LOADED_MN, false);
        drift.think(read_mn, LOADED_MN, still);
        cells
    }

    fn read(cells: [f64; FSR_COUNT]) -> [i32; FSR_COUNT] {
        cells.map(|mn| mn.max(0.0).round() as i32)
    }

    fn known(cells: Cells) -> [i32; FSR_COUNT] {
        match cells {
            Cells::Known(cells) => cells,
            Cells::Sunk => panic!("sunk"),
        }
    }

    fn holding(cells: [f64; FSR_COUNT]) -> Drift {
        let mut drift = Drift::default();
        (0..40).for_each(|_| _ = step(&mut drift, read(cells), MOVES));
        (0..40).for_each(|_| _ = step(&mut drift, read(cells), STILL));
        drift
    }

    #[test]
    fn one_cell_that_drifts_is_found_and_taken_off_while_a_load_grows_or_falls() {
        for (cell, way, pours) in
            (0..FSR_COUNT).flat_map(|n| [(n, 1.0, 0.0), (n, 1.0, 1.0), (n, 1.0, -1.0), (n, -1.0, 0.5)])
        {
            let mut drift = holding(cells(6_500.0, 1_200.0, 0.0));
            for n in 0..80 * 120 {
                let t_s = f64::from(n) / 80.0;
                // Half a newton in 7 s, and 100 mN/s of drift.
                let x = 1_200.0 + pours * 70.0 * t_s.min(7.0);
                let mut true_cells = cells(6_500.0, x, 0.0);
                true_cells[cell] += way * 100.0 * t_s;
                let [a, b, c, d] = known(step(&mut drift, read(true_cells), STILL));
                let (fx, fy) = (f64::from(a + b - c - d), f64::from(a + d - b - c));
                let off = (fx - x).hypot(fy);
                assert!(off < 750.0, "cell {cell}, {way}, {pours}: {off} mN after {t_s} s, {drift:?}");
            }
            assert_eq!(drift.blamed(), Some(cell), "{way}, {pours}");
        }
    }

    #[test]
    fn unequal_gains_and_hysteresis_blame_nobody_whatever_shear_does() {
        let gains = [1.08, 0.93, 0.97, 1.05];
        let with = |mut cells: [f64; FSR_COUNT]| {
            cells.iter_mut().zip(gains).for_each(|(mn, gain)| *mn *= gain);
            cells
        };
        let mut drift = holding(with(cells(4_000.0, 0.0, 0.0)));
        for n in 0..80 * 60 {
            let turn = f64::from(n) / 80.0;
            let load = 4_000.0 + f64::from(n) * 2.0;
            let now = with(cells(load, 0.3 * load * turn.sin(), 0.3 * load * turn.cos()));
            assert_eq!(known(step(&mut drift, read(now), MOVES)), read(now));
        }
        assert_eq!(drift.blamed(), None);
    }

    #[test]
    fn all_cells_that_sink_slowly_are_held_until_they_tell_nothing() {
        let mut drift = holding(cells(6_500.0, 1_200.0, 0.0));
        let mut seen = Vec::new();
        for n in 0..80 * 30 {
            let sunk = f64::from(n) / 80.0 * 100.0;
            match step(&mut drift, read(cells(6_500.0, 1_200.0, 0.0).map(|mn| mn - sunk)), STILL) {
                Cells::Known(cells) => seen.push(cells.iter().sum::<i32>()),
                Cells::Sunk => break,
            }
        }
        assert!((80 * 12..80 * 16).contains(&seen.len()), "{}", seen.len());
        assert!(seen.iter().all(|load| (5_100..=6_500).contains(load)), "{:?}", seen.last());
        assert_eq!(step(&mut drift, [0; FSR_COUNT], STILL), Cells::Sunk);
        assert_eq!(known(drift.step([0; FSR_COUNT], LOADED_MN, true)), [0; 4]);
    }

    #[test]
    fn all_cells_that_rise_slowly_at_rest_are_doubted_and_not_what_presses_or_closes() {
        for (mn_a_reading, motor, all) in
            [(5.0, STILL, true), (0.25, STILL, true), (40.0, STILL, false), (5.0, MOVES, false)]
        {
            let mut drift = holding(cells(6_500.0, 1_200.0, 0.0));
            let mut load = 6_500.0;
            while load < 13_000.0 {
                load += mn_a_reading;
                let now = read(cells(load, 1_200.0, 0.0));
                assert_eq!(known(step(&mut drift, now, motor)), now);
            }
            assert_eq!(drift.doubted() == 0b1111, all, "{mn_a_reading} mN, {motor}");
            step(&mut drift, [0; FSR_COUNT], STILL);
            assert_eq!(drift.doubted(), 0, "an empty hand");
        }
    }

    #[test]
    fn what_is_lost_at_once_or_let_go_by_the_motor_is_no_drift() {
        for (falls_mn, motor) in [(400.0, STILL), (20.0, MOVES)] {
            let mut drift = holding(cells(6_500.0, 0.0, 0.0));
            let mut load = 6_500.0;
            while load > 0.0 {
                load -= falls_mn;
                step(&mut drift, read(cells(load, 0.0, 0.0)), motor);
            }
            assert_eq!(known(step(&mut drift, [0; FSR_COUNT], motor)), [0; FSR_COUNT]);
        }
    }

    #[test]
    fn an_empty_hand_is_empty_whatever_a_cell_has_drifted() {
        for way in [1.0, -1.0] {
            let mut drift = holding(cells(6_500.0, 0.0, 0.0));
            let mut off = 0.0;
            for _ in 0..80 * 14 {
                off += way * 1.25;
                let mut now = cells(6_500.0, 0.0, 0.0);
                now[2] += off;
                step(&mut drift, read(now), STILL);
            }
            assert_eq!(drift.blamed(), Some(2));
            let mut empty = [0.0; FSR_COUNT];
            empty[2] += off;
            let cells = known(step(&mut drift, read(empty), MOVES));
            assert!(cells.iter().all(|&mn| mn <= CARRIES_MN), "{cells:?}");
        }
    }
}
