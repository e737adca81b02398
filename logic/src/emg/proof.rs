//! Proof that a wish is a muscle's. A fault lies under one electrode, and jumps or stands still: an opening is
//! proven if the other electrode has risen out of proportion *and* its own envelope rose by degrees or turned.

use super::decide::{Decide, OVER_UV, Wish};
use super::level::{TOP_LEVEL, level_of};
use super::model::Point;
use super::trust::{TOP_UV, Trust};

/// Slow frames in a block, 0.1 s; the first five blocks are the time before.
const BLOCK_FRAMES: u8 = 8;
const BLOCKS: usize = 9;
const BEFORE: usize = 5;
/// Least rise of the other electrode, Q10 octaves: 9 %.
const LEAST_HEARD: i32 = 123;
/// Slow frames from the begin of a wish in which the other electrode has to rise: 1.5 s.
const HEARD_FRAMES: u16 = 120;
/// Slow frames from the begin of a wish in which the other electrode rises at once: 38 ms.
const AT_ONCE_FRAMES: u16 = 3;
/// Slow frames in a row that make a rise, closing and opening: one is a glitch.
const HEARD_FOR: [u8; 2] = [5, 2];
/// Gradual rise: at most [`MOST_IN_BLOCK`] of it in a block, per mille, and at least [`PART_OF_BLOCK`] in [`BLOCKS_OF_RISE`] blocks.
const MOST_IN_BLOCK: i32 = 650;
const PART_OF_BLOCK: i32 = 100;
const BLOCKS_OF_RISE: usize = 3;
const LEAST_RISE: i32 = 512;
/// Fall of both electrodes within 0.9 s, Q10 octaves, 15 %: 98.9 % of the recorded 4.2 s of both muscles' work have one, 2,000 drawn pairs of ripples none.
const BOTH_FALL: i32 = 240;
const SLOWER: i32 = 600;
const APART_PART: i32 = 12;
/// Slow frames within which the same wish goes on without new proof: 0.1 s.
const GOES_ON_FRAMES: u16 = 8;
/// Slow frames for which a proven opening above the sensor's range stays proven: 0.5 s.
const OVER_FRAMES: u16 = 40;
/// Slow frames after a doubt within which an opening may have begun during it: 0.5 s.
const RETURNED_FRAMES: u8 = 40;
/// Slow frames of rest that take back what an unproven opening adds: it makes the next harder to believe, three times at most.
const WARY_FRAMES: u16 = 800;
/// Rise and fall of a swing, Q10 octaves; swings that the other electrode does not hear, within 3 s.
const SWING: i32 = 1_024;
const LONE_SWINGS: u8 = 2;
const SWING_FRAMES: u16 = 240;

#[derive(Clone, Copy, Debug, Default)]
struct Swings {
    /// 0: none.
    low: i32,
    high: Option<i32>,
    was_active: bool,
    other: [i32; 2],
    lone: u8,
    since: u16,
}

impl Swings {
    /// Levels of both electrodes in a slow frame; `unheard`: rise of the other one below which it takes no part in a rise of this one. True
    /// if this one swings alone.
    #[inline(never)]
    fn take(&mut self, level: i32, other: i32, is_active: bool, unheard: impl Fn(i32) -> i32) -> bool {
        self.since += u16::from(self.lone > 0);
        if self.since > SWING_FRAMES {
            (self.lone, self.since) = (0, 0);
        }
        self.other[1] = self.other[1].max(other);
        match self.high {
            Some(high) if level <= high - SWING => {
                if self.other[1] - self.other[0] >= unheard(high - self.low).max(2 * LEAST_HEARD) {
                    self.lone = 0;
                } else if self.was_active {
                    (self.lone, self.since) = ((self.lone + 1).min(LONE_SWINGS), 0);
                }
                (self.low, self.high, self.other) = (level, None, [other; 2]);
            }
            Some(high) => {
                self.high = Some(high.max(level));
                self.was_active |= is_active;
            }
            None if level <= self.low || self.low == 0 => (self.low, self.other) = (level, [other; 2]),
            None if level >= self.low + SWING => (self.high, self.was_active) = (Some(level), is_active),
            None => {}
        }
        self.lone >= LONE_SWINGS
    }
}

#[derive(Clone, Debug, Default)]
pub struct Proof {
    /// Highest level of each block, oldest first, 0 before the first reading; the last is under way.
    blocks: [[i16; BLOCKS]; 2],
    /// Mean levels of the same blocks, Q3.
    means: [[i32; BLOCKS]; 2],
    frames: u8,
    wish: Wish,
    age: u16,
    before: [i32; 2],
    hears: u8,
    heard: bool,
    /// The other electrode rose by twice its least rise within [`AT_ONCE_FRAMES`] of the wish's begin.
    pub at_once: bool,
    apart: bool,
    proven: bool,
    over: u16,
    last: (Wish, u16),
    wary: u16,
    swings: [Swings; 2],
    /// Slow frames for which the mover's last doubt counts, and the other electrode's lowest level since it began.
    returned: u8,
    lowest: i32,
}

impl Proof {
    /// Levels of a slow frame, None without a number. `hears`: rest of the other electrode and its least rise, Q10
    /// octaves; None if it hardly rises, so that only turning twice proves. `raised`: the mover is active.
    #[inline(never)]
    pub fn take(
        &mut self,
        levels: [Option<i32>; 2],
        wish: Wish,
        mover: usize,
        trust: &Trust,
        hears: Option<[i32; 2]>,
        raised: bool,
    ) -> bool {
        self.keep(levels);
        self.doubt(wish, 1 - mover, !trust.is_good());
        self.begin(wish);
        if self.age == 0 && self.returned > 0 {
            // An electrode that is seated again during a contraction has not seen it begin.
            self.before[(1 - mover) & 1] = self.lowest;
        }
        if wish == Wish::Rest {
            return false;
        }
        let over = levels[mover & 1].is_some_and(|level| level >= const { level_of(OVER_UV) });
        self.over = if over { self.over.saturating_add(1) } else { 0 };
        self.age = self.age.saturating_add(1);
        let heard = hears.map(|[rest, least]| {
            let (other, least) = (1 - mover, least.max(LEAST_HEARD));
            let rise = match wish {
                Wish::Open => self.rise(other, levels[other & 1], rest),
                // Nothing is lost while it is averaged: a closing begins without a proof.
                _ => self.mean_rise(other, rest),
            };
            self.at_once |= self.returned == 0 && self.age <= AT_ONCE_FRAMES && rise >= 2 * least;
            rise >= least * (1 + i32::from(self.wary.div_ceil(WARY_FRAMES)))
        });
        self.hears = if heard == Some(true) { self.hears.saturating_add(1) } else { 0 };
        self.heard |= self.age <= HEARD_FRAMES && self.hears >= HEARD_FOR[usize::from(wish == Wish::Open)];
        if !self.proven {
            let is_heard = heard.is_some();
            if is_heard && wish == Wish::Open {
                let returned = self.returned > 0 && trust.has_turned_twice();
                self.apart = self.apart || returned || self.rise_apart();
            }
            self.proven = !is_heard && trust.has_turned_twice()
                || match wish {
                    Wish::Open => self.heard && self.apart && (trust.has_turned() || self.is_gradual(mover)),
                    _ => self.heard || is_heard && trust.is_joined(),
                };
        }
        // What turned after a steady rise may be the other electrode's signal: it has to be heard again.
        let straight = self.proven && wish == Wish::Open && trust.is_straight();
        if straight || self.over > OVER_FRAMES || !(over || trust.is_sound() && raised) {
            self.proven = false;
            if !(raised && trust.returns()) {
                // The contraction is over, or no muscle's: a later one has to be heard again.
                self.heard = false;
                self.age = if raised && trust.is_constant() { 0 } else { HEARD_FRAMES };
            }
        }
        self.proven &= !trust.is_straight() && (wish == Wish::Open || !trust.is_deaf());
        self.proven
    }

    pub fn swing_alone(&mut self, levels: [Option<i32>; 2], active: [bool; 2], decide: &Decide) -> [bool; 2] {
        let [Some(flexor), Some(extensor)] = levels else { return [false; 2] };
        let [own, other] = &mut self.swings;
        [
            own.take(flexor, extensor, active[0], |rise| decide.unheard(0, rise)),
            other.take(extensor, flexor, active[1], |rise| decide.unheard(1, rise)),
        ]
    }

    fn keep(&mut self, levels: [Option<i32>; 2]) {
        self.frames = (self.frames + 1) % BLOCK_FRAMES;
        let next = self.frames == 0;
        for ((blocks, means), level) in self.blocks.iter_mut().zip(&mut self.means).zip(levels) {
            if next {
                // `rotate_left` pulls in memmove.
                for n in 1..BLOCKS {
                    blocks[n - 1] = blocks[n];
                    means[n - 1] = means[n];
                }
            }
            let Some(level) = level.map(|level| level as i16) else { continue };
            let last = &mut blocks[BLOCKS - 1];
            *last = if next { level } else { level.max(*last) };
            if means[0] == 0 {
                *means = [8 * i32::from(level); BLOCKS];
            }
            let mean = &mut means[BLOCKS - 1];
            *mean += (8 * i32::from(level) - *mean) >> 2;
        }
    }

    fn doubt(&mut self, wish: Wish, other: usize, is_doubted: bool) {
        if is_doubted {
            let before = self.before(other);
            self.lowest = if self.returned < RETURNED_FRAMES { before } else { self.lowest.min(before) };
            self.returned = RETURNED_FRAMES;
        } else if wish != Wish::Open {
            self.returned = self.returned.saturating_sub(1);
        }
    }

    fn begin(&mut self, wish: Wish) {
        if self.proven {
            (self.last, self.wary) = ((self.wish, 0), 0);
        } else {
            self.last.1 = self.last.1.saturating_add(1);
        }
        if wish == self.wish {
            self.wary = self.wary.saturating_sub(u16::from(wish == Wish::Rest));
            return;
        }
        if self.wish == Wish::Open && !self.proven {
            self.wary = (self.wary + WARY_FRAMES).min(3 * WARY_FRAMES);
        }
        (self.wish, self.age, self.over) = (wish, 0, 0);
        self.before = [0, 1].map(|n: usize| self.before(n));
        self.heard = wish == self.last.0 && self.last.1 < GOES_ON_FRAMES;
        self.apart = self.heard;
        (self.at_once, self.proven) = (false, false);
    }

    /// Muscles contract together, and relax a little together; faults are each other's strangers.
    pub fn both_fall(&self, levels: [Option<i32>; 2]) -> bool {
        self.blocks.iter().zip(levels).all(|(blocks, level)| {
            level.is_some_and(|level| blocks.iter().any(|&crest| i32::from(crest) - level >= BOTH_FALL))
        })
    }

    pub fn levels(&self) -> Point {
        self.blocks.map(|[.., now]| now.into())
    }

    fn before(&self, n: usize) -> i32 {
        self.blocks[n & 1].iter().take(BEFORE).copied().max().map_or(0, i32::from)
    }

    /// Rise of the mean above that of before, or above rest if higher, Q10 octaves.
    fn mean_rise(&self, n: usize, rest: i32) -> i32 {
        let [before, .., now] = self.means[n & 1];
        now / 8 - (before / 8).max(rest)
    }

    /// Rise above the lower level of before and at the wish's begin, or above rest if higher, Q10 octaves.
    fn rise(&self, n: usize, level: Option<i32>, rest: i32) -> i32 {
        level.map_or(0, |level| level - self.before(n).min(self.before[n & 1]).max(rest))
    }

    /// Both rise, out of proportion: a signal that reaches both at once rises in proportion, or jumps.
    #[inline(never)]
    fn rise_apart(&self) -> bool {
        let low = self.blocks.map(|blocks| blocks.into_iter().min().map_or(0, i32::from));
        let most = [0, 1].map(|n: usize| {
            climbs(low[n], self.blocks[n].iter().fold(0, |most, &level| most.max(level.into()))) >> 3
        });
        let whole = most[0] * most[1] / 16;
        let mut apart = false;
        for n in 0..BLOCKS {
            let part = |own: usize| (climbs(low[own], self.blocks[own][n].into()) >> 3) * most[1 - own] / 16;
            let parts = [part(0), part(1)];
            let is_between = |part: i32| part > whole / 10 && part < whole / 10 * 8;
            apart |= (is_between(parts[0]) || is_between(parts[1]))
                && (parts[0] - parts[1]).abs() > (parts[0] + parts[1]) / APART_PART;
        }
        apart
    }

    fn is_gradual(&self, n: usize) -> bool {
        let blocks = self.blocks[n & 1].map(i32::from);
        let [.., last_but_one, last, now] = blocks;
        let steps = blocks.windows(2).map(|pair| (pair[1] - pair[0]).max(0));
        let (all, most) = steps.clone().fold((0, 0), |(all, most), step| (all + step, step.max(most)));
        let parts = steps.filter(|step| step * 1_000 >= all * PART_OF_BLOCK).count();
        let fastest = blocks.windows(2).map(|pair| climbs(pair[0], pair[1])).max().unwrap_or(0);
        let slows = climbs(last_but_one, last) * 1_000 <= fastest * SLOWER;
        let is_top = now.max(last) >= const { level_of(TOP_UV) };
        all >= LEAST_RISE
            && most * 1_000 <= all * MOST_IN_BLOCK
            && parts >= BLOCKS_OF_RISE
            && slows
            && !is_top
    }
}

/// Rise between two levels as a part of the range, Q18; 0 if it falls.
#[inline(never)]
const fn climbs(from: i32, to: i32) -> i32 {
    // 2 to the power of a level below the highest, to 0.2 %.
    const fn envelope(level: i32) -> i32 {
        let below = TOP_LEVEL - level;
        let part = 1_023 - (below & 1_023);
        let mantissa = 1_024 + ((part * (672 + ((352 * part) >> 10))) >> 10);
        (mantissa << 7) >> ((below >> 10) & 31)
    }
    if to > from { envelope(to) - envelope(from) } else { 0 }
}
