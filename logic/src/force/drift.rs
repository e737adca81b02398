//! Drift of the quadrants (cells A to D, clockwise) in a grasp. Two things are known of the true cells: the element
//! on them is rigid, A + C = B + D, and with the motor at rest their sum changes by no more than skin yields. What
//! breaks either is drift, of the set of cells that explains best how load, contradiction and shear moved together.
//! Shear changes by itself, so it weighs least.

use tenax_hal_shim::channel::FSR_COUNT;

use super::sensor::CARRIES_MN;

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
/// Votes that exceed noise; a vote is 2^VOTE_SHIFT mN^2.
const HEARD: i32 = 14_000;
const VOTE_SHIFT: u32 = 6;
/// Drift that is followed in a reading, mN: 0.24 N/s of the contradiction, 0.5 N/s of the load.
const CELL_FOLLOWS_MN: i32 = 3;
const ALL_FOLLOWS_MN: i32 = 6;
const STILL_FOR: u32 = 40;
/// Average of the change in a reading over `2^RATE_SHIFT` readings, 1.6 s.
const RATE_SHIFT: u32 = 7;
const Q: u32 = 12;
/// Largest load, mN.
const LOAD_MAX: i32 = 1 << 17;
const YIELDS_PART: i32 = 5;

/// Load, shear along x and y, contradiction.
type Parts = [i32; 4];
const WEIGHTS: Parts = [8, 1, 1, 8];
/// Sets of cells, a bit each.
const SETS: usize = 1 << FSR_COUNT;
/// Parts of a drift of 1 mN of each cell of a set, and 2^16 by the sum of their weighted squares.
const DRIFTS: [(Parts, i64); SETS] = {
    let (mut all, mut set) = ([([0; 4], 0); SETS], 1);
    while set < SETS {
        let bits = set as i32;
        let [l, x, y, k] = parts([bits & 1, bits >> 1 & 1, bits >> 2 & 1, bits >> 3 & 1]);
        let squares = WEIGHTS[0] * l * l + WEIGHTS[1] * x * x + WEIGHTS[2] * y * y + WEIGHTS[3] * k * k;
        all[set] = ([l, x, y, k], (1 << 16) / squares as i64);
        set += 1;
    }
    all
};

const fn parts([a, b, c, d]: [i32; FSR_COUNT]) -> Parts {
    [a + b + c + d, a + b - c - d, a + d - b - c, a - b + c - d]
}

const fn tolerated_mn(load_mn: i32) -> i32 {
    TOLERATED_MN + load_mn / TOLERATED_PART
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cells {
    Known([i32; FSR_COUNT]),
    /// Too few cells carry a force: it cannot be told from drift.
    Sunk,
}

#[derive(Clone, Debug, Default)]
pub struct Drift {
    /// Cells that drift, a bit each.
    set: u8,
    /// Contradiction beyond the cells' gains that is taken for drift, mN.
    off_mn: i32,
    contradicts: u8,
    /// Readings since the grasp began, and the contradiction as a part of the load, caused by unequal gains.
    learned: u8,
    gain: i32,
    /// Averages of 3 s, mN Q8, and how much of the moves from them the drift of each set explains.
    anchors: [i32; FSR_COUNT],
    votes: [i32; SETS],
    /// Load without its slow change at rest, and with it, and that change in a reading, mN with [`Q`] fraction bits.
    rests: [i32; 2],
    rate: i32,
    /// That change exceeds what skin yields.
    changes: bool,
}

impl Drift {
    /// Cells that drift, a bit each.
    pub const fn doubted(&self) -> u8 {
        self.set
    }

    /// `loaded_mn`: load of a grasp. `opened`: the motor has opened the hand since it last closed it.
    pub fn step(&mut self, read_mn: [i32; FSR_COUNT], loaded_mn: i32, opened: bool) -> Cells {
        self.let_go(&read_mn, opened);
        let cells = self.corrected(read_mn);
        if self.changes && cells.iter().sum::<i32>() < loaded_mn {
            self.forget_load();
            return Cells::Known(self.corrected(read_mn));
        }
        if self.is_sunk(&read_mn) { Cells::Sunk } else { Cells::Known(cells) }
    }

    pub fn think(&mut self, read_mn: [i32; FSR_COUNT], loaded_mn: i32, still: u32) {
        let load_mn: i32 = self.corrected(read_mn).iter().sum();
        if load_mn < loaded_mn {
            (self.learned, self.contradicts) = (0, 0);
            self.forget_load();
        } else if !self.is_sunk(&read_mn) {
            let is_known = self.contradict(read_mn, load_mn);
            self.vote(read_mn, is_known && still >= STILL_FOR);
            let load_mn = parts(read_mn)[0] - self.contradicting_mn() * self.drift()[0];
            self.rest(load_mn, loaded_mn, still);
            self.choose(load_mn);
        }
    }

    const fn has(&self, cell: usize) -> bool {
        self.set >> cell & 1 != 0
    }

    /// Parts of a drift of 1 mN of each cell that drifts.
    fn drift(&self) -> Parts {
        // `%` lets the compiler drop the bounds check.
        DRIFTS[usize::from(self.set) % SETS].0
    }

    /// Drift of each cell that drifts, mN, as the contradiction shows it.
    fn contradicting_mn(&self) -> i32 {
        let [.., contradiction] = self.drift();
        self.off_mn.checked_div(contradiction).unwrap_or(0)
    }

    /// Drift of all cells together that is none of the contradiction, mN.
    fn changed_mn(&self) -> i32 {
        let [from, to] = self.rests;
        if self.changes { (to - from) >> Q } else { 0 }
    }

    fn is_sunk(&self, read_mn: &[i32; FSR_COUNT]) -> bool {
        let carrying = read_mn.iter().filter(|&&mn| mn >= CARRIES_MN).count();
        self.changed_mn() < 0 && carrying + 1 < FSR_COUNT
    }

    fn forget_load(&mut self) {
        (self.rests, self.rate, self.changes) = ([0; 2], 0, false);
        if self.drift()[3] == 0 {
            self.set = 0;
        }
    }

    fn corrected(&self, mut cells: [i32; FSR_COUNT]) -> [i32; FSR_COUNT] {
        let [count, ..] = self.drift();
        let each_mn = self.contradicting_mn() + self.changed_mn().checked_div(count).unwrap_or(0);
        for (n, mn) in cells.iter_mut().enumerate() {
            // No cell pulls.
            *mn = (*mn - if self.has(n) { each_mn } else { 0 }).max(0);
        }
        cells
    }

    /// What cells that contradict read while no other carries anything is drift.
    fn let_go(&mut self, read_mn: &[i32; FSR_COUNT], opened: bool) {
        let carries = |own: bool| (0..).zip(read_mn).any(|(n, &mn)| self.has(n) == own && mn >= CARRIES_MN);
        let (own, other) = (carries(true), carries(false));
        let [count, .., contradiction] = self.drift();
        if contradiction != 0 && !other && (opened || count == 1 && self.changed_mn() >= 0) {
            let read_mn: i32 = (0..).zip(read_mn).filter(|(n, _)| self.has(*n)).map(|(_, mn)| mn).sum();
            self.off_mn = read_mn.checked_div(count).unwrap_or(0) * contradiction;
            if !own {
                self.set = 0;
            }
        }
        if opened && !own && !other {
            self.forget_load();
        }
    }

    /// Contradiction beyond drift and the cells' gains, mN. None while a shear lifts the rigid element off a cell, which breaks the rule, too:
    /// by the other three, that cell would have to pull.
    fn excess_mn(&self, read_mn: [i32; FSR_COUNT], load_mn: i32) -> Option<i32> {
        let ([.., drifts], [.., reads]) = (self.drift(), parts(read_mn));
        let now = reads - if drifts != 0 { self.off_mn } else { 0 };
        // A load is below 2^17.
        let excess_mn = now - ((i64::from(load_mn) * i64::from(self.gain)) >> GAIN_Q) as i32;
        let is_alone = self.set.is_power_of_two();
        let is_lifted = |(n, mn): (usize, i32)| {
            let pulls_mn = if n % 2 == 0 { excess_mn } else { -excess_mn };
            let lifts = self.learned < LEARN || pulls_mn > -tolerated_mn(load_mn);
            mn < CARRIES_MN && !(is_alone && self.has(n)) && lifts
        };
        (!(0..).zip(read_mn).any(is_lifted)).then_some(excess_mn)
    }

    /// The cells cannot all be right in this reading.
    pub fn is_contradicted(&self, read_mn: [i32; FSR_COUNT], load_mn: i32) -> bool {
        let excess_mn = self.excess_mn(read_mn, load_mn).unwrap_or(0);
        self.learned >= LEARN && excess_mn.abs() > tolerated_mn(load_mn)
    }

    /// False while a cell is lifted.
    fn contradict(&mut self, read_mn: [i32; FSR_COUNT], load_mn: i32) -> bool {
        if self.learned == 0 {
            (self.votes, self.gain) = ([0; SETS], 0);
        }
        let Some(now) = self.excess_mn(read_mn, load_mn) else {
            self.contradicts = 0;
            return false;
        };
        if self.learned < LEARN {
            self.learned += 1;
            let part = ((i64::from(now) << GAIN_Q) / i64::from(load_mn.max(1))) as i32;
            let limit = (1 << GAIN_Q) / 4;
            self.gain = (self.gain + (part >> LEARN_SHIFT)).clamp(-limit, limit);
        }
        let excess = self.excess_mn(read_mn, load_mn).unwrap_or(now);
        let beyond = excess.abs() > tolerated_mn(load_mn);
        self.contradicts = if beyond { self.contradicts.saturating_add(1) } else { 0 };
        if self.drift()[3] != 0 {
            self.off_mn += excess.clamp(-CELL_FOLLOWS_MN, CELL_FOLLOWS_MN);
        }
        true
    }

    fn vote(&mut self, read_mn: [i32; FSR_COUNT], rests: bool) {
        if !rests {
            self.anchors = read_mn.map(|mn| mn << ANCHOR_SHIFT);
            return;
        }
        let moved = parts(core::array::from_fn(|n| {
            let lacks = (read_mn[n] << ANCHOR_SHIFT) - self.anchors[n];
            self.anchors[n] += lacks >> ANCHOR_SHIFT;
            lacks >> ANCHOR_SHIFT
        }));
        let weighted: Parts = core::array::from_fn(|n| WEIGHTS[n] * moved[n]);
        for (votes, (drift, inverse)) in self.votes.iter_mut().zip(&DRIFTS) {
            // A part moves by less than 2^17 mN, so that the product is below 2^24.
            let along: i32 = weighted.iter().zip(drift).map(|(moved, drift)| moved * drift).sum();
            let vote = (i64::from(along) * i64::from(along) * inverse) >> (16 + VOTE_SHIFT);
            *votes = (*votes - (*votes >> VOTES_SHIFT)).saturating_add(vote.min(1 << 30) as i32);
        }
    }

    /// The motor and what is faster than any drift change the load itself; a drift goes on meanwhile.
    fn rest(&mut self, load_mn: i32, loaded_mn: i32, still: u32) {
        // A load is below 2^17 mN.
        let load = load_mn << Q;
        let [from, to] = if self.rests == [0; 2] { [load; 2] } else { self.rests };
        let off = load - to;
        if still < STILL_FOR || (off >> Q).abs() > tolerated_mn(load_mn) {
            self.rests = [(from + off - self.rate).clamp(1, LOAD_MAX << Q), load];
            return;
        }
        let change = off.clamp(-ALL_FOLLOWS_MN << Q, ALL_FOLLOWS_MN << Q);
        self.rate += (change - self.rate) >> RATE_SHIFT;
        self.rests = [from, to + change];
        let (from_mn, change_mn) = (from >> Q, (to + change - from) >> Q);
        let yields_mn = from_mn / YIELDS_PART;
        self.changes |= change_mn < -yields_mn || change_mn > yields_mn.max(loaded_mn);
    }

    fn choose(&mut self, load_mn: i32) {
        let contradicts =
            self.contradicts >= CONTRADICTS_FOR || self.contradicting_mn().abs() > tolerated_mn(load_mn);
        if !contradicts && !self.changes {
            return;
        }
        let own = self.votes[usize::from(self.set) % SETS].saturating_mul(CLEARLY).saturating_add(HEARD);
        let (mut best, mut votes) = (self.set, if self.set == 0 { 0 } else { own });
        for ((set, &own), (drift, _)) in (0..).zip(&self.votes).zip(&DRIFTS) {
            if own > votes && (drift[3] != 0 || !contradicts) {
                (best, votes) = (set, own);
            }
        }
        if best != self.set {
            if self.drift()[3] == 0 {
                self.off_mn = 0;
            }
            self.set = best;
        }
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
    fn cells_that_drift_are_found_and_taken_off_while_a_load_grows_or_falls() {
        for (set, way, pours) in
            (1..16_u8).flat_map(|set| [(set, 1.0, 0.0), (set, 1.0, 1.0), (set, 1.0, -1.0), (set, -1.0, 0.5)])
        {
            let mut drift = holding(cells(6_500.0, 1_200.0, 0.0));
            // What falls to nothing is unknown.
            let seconds = if way > 0.0 || set.count_ones() == 1 { 120 } else { 8 };
            for n in 0..80 * seconds {
                let t_s = f64::from(n) / 80.0;
                // Half a newton in 7 s, and 100 mN/s of drift.
                let x = 1_200.0 + pours * 70.0 * t_s.min(7.0);
                let mut true_cells = cells(6_500.0, x, 0.0);
                (0..4)
                    .filter(|cell| set >> cell & 1 != 0)
                    .for_each(|cell| true_cells[cell] += way * 100.0 * t_s);
                let [a, b, c, d] = known(step(&mut drift, read(true_cells), STILL));
                let (fx, fy) = (f64::from(a + b - c - d), f64::from(a + d - b - c));
                let off = (fx - x).hypot(fy);
                let most = if set.count_ones() == 1 { 750.0 } else { 1_700.0 };
                assert!(off < most, "{set:04b}, {way}, {pours}: {off} mN after {t_s} s, {drift:?}");
            }
            assert_eq!(drift.doubted(), set, "{way}, {pours}");
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
        assert_eq!(drift.doubted(), 0);
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
    fn all_cells_that_rise_slowly_at_rest_are_taken_off_and_not_what_presses_or_closes() {
        for (mn_a_reading, motor, all) in
            [(5.0, STILL, true), (0.25, STILL, true), (40.0, STILL, false), (5.0, MOVES, false)]
        {
            let mut drift = holding(cells(6_500.0, 1_200.0, 0.0));
            let mut load = 6_500.0;
            while load < 13_000.0 {
                load += mn_a_reading;
                let now = read(cells(load, 1_200.0, 0.0));
                let known: i32 = known(step(&mut drift, now, motor)).iter().sum();
                let true_mn = if all { 6_500 } else { now.iter().sum() };
                assert!((true_mn - 100..true_mn + 1_400).contains(&known), "{known} mN for {true_mn}");
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
            assert_eq!(drift.doubted(), 1 << 2);
            let mut empty = [0.0; FSR_COUNT];
            empty[2] += off;
            let cells = known(step(&mut drift, read(empty), MOVES));
            assert!(cells.iter().all(|&mn| mn <= CARRIES_MN), "{cells:?}");
        }
    }
}
