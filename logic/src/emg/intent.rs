//! What the wearer wants: rest, close or open, from the levels of both electrodes.
//!
//! Levels are compared where the wearer has shown them (calibrated), each contraction at its site. Opening is the wish
//! that can do harm by mistake, and the recordings have it where nobody means it: a wearer who lets go of a flexed wrist
//! or a fist extends it for 0.2 to 0.5 s, with up to nine tenths of a held extension and the flexor at rest. So opening
//! begins at once only above what was held at calibration, or after 0.7 s of somewhat less; once begun, it goes on down to a
//! third. Closing begins early and needs a clear direction. What is neither is activity without a wish.

use super::log2::level_of;
use super::model::{EmgModel, octaves};
use super::quality::Expected;

/// How far above the calibrated level opening begins at once: 20 %.
const OPEN_AT_ONCE: i32 = octaves(263);
/// And how far below it after [`SLOW_READINGS`]: at 60 %. Crests of other movements last 0.47 s there at most.
const OPEN_SLOWLY: i32 = octaves(737);
/// How far below it opening ends: at 35 %.
const OPEN_ENDS: i32 = octaves(1_515);
/// At first opening ends this far below where it began: a crest of another movement is over as soon as it falls.
const OPEN_SLACK: i32 = octaves(100);
/// Readings for which it does.
const CREST_READINGS: u16 = 24;
/// Readings over which its end then goes down to [`OPEN_ENDS`]: 0.3 s.
const RELAX_READINGS: i32 = 72;
/// Readings above the threshold that open: a single one may be a glitch.
const OPEN_READINGS: u16 = 2;
/// Readings that open slowly: 0.7 s.
const SLOW_READINGS: u16 = 168;
/// How many readings one below the threshold takes away.
const SLOW_LEAK: u16 = 2;
/// Readings above the threshold that close: 17 ms.
const CLOSE_READINGS: u16 = 4;
/// The same soon after opening, 0.25 s: while an extended wrist relaxes, the flexor catches it for 0.16 s.
const CLOSE_READINGS_AFTER_OPENING: u16 = 60;
/// How long that is: 0.5 s.
const SOON_READINGS: u16 = 120;
/// Parts of the way from rest to the contraction, per mille, and the least distances from rest: from where closing
/// begins, where it ends, and from where the opening site is active. Rest drifts by up to half between recordings.
const CLOSE_PERMILLE: i32 = 400;
const CLOSE_LEAST: i32 = octaves(600);
const ACTIVE_PERMILLE: i32 = 420;
const END_PERMILLE: i32 = 300;
const END_LEAST: i32 = octaves(450);
/// Parts of the way from the closing ratio of both electrodes to the opening one, per mille.
const RATIO_OPENS: i32 = 620;
const RATIO_STILL_OPENS: i32 = 500;
const RATIO_CLOSES: i32 = 550;
const RATIO_STILL_CLOSES: i32 = 620;
/// On the straight way from the closing contraction to the opening one, closing ends here, per mille.
const NEARER_TO_CLOSING: i32 = 500;
const STILL_NEARER_TO_CLOSING: i32 = 570;
/// The part of the way from rest to the opening contraction, per mille, from which its electrode forbids closing: both
/// muscles at once ask for nothing.
const BOTH_PERMILLE: i32 = 600;
/// Without the other electrode nothing tells a fist from an extension: closing then needs nearly all of its level.
const CLOSE_ALONE: i32 = octaves(300);

/// Readings for which an unproven contraction may move the hand: 92 ms.
pub const UNPROVEN_READINGS: u16 = 22;
/// One that may open it and that the other electrode hears too: 0.4 s after it began or last fell back from a crest.
const HEARD_READINGS: u16 = 96;
/// One at the top of its range that the other electrode hears well: 0.6 s. It proves nothing there; recordings have 0.55 s,
/// and the other electrode then at three times its rest.
const CLIPPED_READINGS: u16 = 144;
/// How far the other electrode stands out from rest when it hears the same contraction: by 23 %. A fault has one electrode.
const HEARS_TOO: i32 = octaves(300);
/// And when it hears it well: twice its rest. It then stands at 2.8 times what was calibrated at most; above, it contracts.
const HEARS_WELL: i32 = octaves(1_000);
const HEARS_AT_MOST: i32 = octaves(1_500);

/// Without calibration: an electrode below this is inactive, uV; what silences the reflex. A millivolt below the 160 that
/// count as activity, since readings and levels are rounded.
const DEFAULT_ACTIVE_UV: i32 = 159_000;
const DEFAULT_INACTIVE_UV: i32 = 112_000;
/// Without calibration: where closing and opening begin, uV, and how far the other electrode must be below: by a factor of
/// 2.5 and of 8. Recorded fists have 1.18 V on the extensor, relaxed arms with hum 0.26 V.
const DEFAULT_CLOSE: i32 = level_of(600_000);
const DEFAULT_CLOSE_OVER: i32 = octaves(1_322);
const DEFAULT_OPEN: i32 = level_of(1_500_000);
const DEFAULT_OPEN_OVER: i32 = octaves(3_000);
/// For how many readings: 0.3 s.
const DEFAULT_READINGS: u16 = 72;

/// What the wearer wants of the hand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wish {
    /// Nothing, or nothing clear.
    #[default]
    Rest,
    /// To close it.
    Close,
    /// To open it.
    Open,
}

/// One electrode now.
#[derive(Clone, Copy, Debug, Default)]
pub struct Electrode {
    /// Its level; none while it is lost.
    pub level: Option<i32>,
    /// Whether what it hears has been proven to be a muscle.
    pub proven: bool,
    /// Whether it is at the top of its range.
    pub clipped: bool,
    /// Whether it has just fallen back from a crest.
    pub turned: bool,
    /// Whether it stands still: then it vetoes nothing.
    pub unmodulated: bool,
}

/// A wearer's levels, ready to compare with. By site: first the one that closes.
#[derive(Clone, Copy, Debug)]
struct Sites {
    /// Index of the closing electrode.
    closing: usize,
    /// Of the opening contraction at its site, and at the other.
    open: i32,
    open_beside: i32,
    /// Of the closing one at its own.
    close: i32,
    close_begins: i32,
    close_ends: i32,
    opening_active: i32,
    opening_inactive: i32,
    /// From here the opening electrode forbids closing.
    both: i32,
    rest: [i32; 2],
    ratio_opens: i32,
    ratio_still_opens: i32,
    ratio_closes: i32,
    ratio_still_closes: i32,
    /// The way from closing to opening, and how far on it closing reaches.
    way: [i32; 2],
    nearer: i32,
    still_nearer: i32,
}

impl Sites {
    fn of(model: &EmgModel) -> Self {
        let (closing, opening) = (model.closing_site(), model.opening_site());
        let sites = |point: [i32; 2]| [point[closing], point[opening]];
        let (rest, close, open) = (sites(model.rest()), sites(model.close()), sites(model.open()));
        let spread = sites(model.spread());
        let above_rest = |n: usize, to: i32, permille: i32, least: i32| {
            rest[n] + (part(to - rest[n], permille)).max(least).max(4 * spread[n])
        };
        let ratio = |point: [i32; 2]| point[1] - point[0];
        let turn = ratio(open) - ratio(close);
        let at_ratio = |permille: i32| ratio(close) + part(turn, permille);
        let way = [open[0] - close[0], open[1] - close[1]];
        let product = |point: [i32; 2]| way[0] * point[0] + way[1] * point[1];
        let (from, length) = (product(close), (product(open) - product(close)) / 1_000);
        let close_begins = above_rest(0, close[0], CLOSE_PERMILLE, CLOSE_LEAST);
        let opening_active = above_rest(1, open[1], ACTIVE_PERMILLE, CLOSE_LEAST);
        Self {
            closing,
            open: open[1],
            open_beside: open[0],
            close: close[0],
            close_begins,
            close_ends: above_rest(0, close[0], END_PERMILLE, END_LEAST).min(close_begins - octaves(100)),
            opening_active,
            opening_inactive: opening_active - octaves(300),
            both: rest[1] + part(open[1] - rest[1], BOTH_PERMILLE),
            rest,
            ratio_opens: at_ratio(RATIO_OPENS),
            ratio_still_opens: at_ratio(RATIO_STILL_OPENS),
            ratio_closes: at_ratio(RATIO_CLOSES),
            ratio_still_closes: at_ratio(RATIO_STILL_CLOSES),
            way,
            nearer: from + length * NEARER_TO_CLOSING,
            still_nearer: from + length * STILL_NEARER_TO_CLOSING,
        }
    }
}

/// So many thousandths of a difference of levels.
const fn part(difference: i32, permille: i32) -> i32 {
    difference * permille / 1_000
}

/// Decides from reading to reading.
#[derive(Clone, Debug, Default)]
pub struct Intent {
    sites: Option<Sites>,
    wish: Wish,
    /// Readings in a row that ask for opening and for closing; leaky, that ask for slow opening.
    opens: u16,
    closes: u16,
    slow: u16,
    /// Readings since opening began, and since it ended.
    open_for: u16,
    since_open: u16,
    /// Readings for which an unproven contraction has moved the hand, and of rest that are still to come.
    moved: u16,
    waits: u16,
    strength_permille: u16,
}

impl Intent {
    /// For a wearer, or for nobody in particular.
    #[must_use]
    pub fn new(model: Option<&EmgModel>) -> Self {
        Self { sites: model.map(Sites::of), since_open: u16::MAX, ..Self::default() }
    }

    /// What is expected of both electrodes, flexor first.
    #[must_use]
    pub fn expected(&self) -> [Expected; 2] {
        let Some(sites) = &self.sites else {
            let (active, inactive) = (level_of(DEFAULT_ACTIVE_UV), level_of(DEFAULT_INACTIVE_UV));
            return [Expected { active, inactive, rest: None }; 2];
        };
        let closing =
            Expected { active: sites.close_begins, inactive: sites.close_ends, rest: Some(sites.rest[0]) };
        let opening = Expected {
            active: sites.opening_active,
            inactive: sites.opening_inactive,
            rest: Some(sites.rest[1]),
        };
        if sites.closing == 0 { [closing, opening] } else { [opening, closing] }
    }

    /// Takes both electrodes, flexor first: what the wearer wants.
    pub fn take(&mut self, electrodes: &[Electrode; 2]) -> Wish {
        let (wish, mover, most) = match self.sites {
            Some(sites) => {
                let [closing, opening] = if sites.closing == 0 { [0, 1] } else { [1, 0] };
                let levels = [electrodes[closing].level, electrodes[opening].level];
                self.calibrated(&sites, levels, electrodes[closing].unmodulated);
                let hears = |n: usize| levels[n].is_some_and(|level| level >= sites.rest[n] + HEARS_TOO);
                let hears_well =
                    |level| level >= sites.rest[0] + HEARS_WELL && level <= sites.open_beside + HEARS_AT_MOST;
                let clips_well = electrodes[opening].clipped && levels[0].is_some_and(hears_well);
                match self.wish {
                    Wish::Open if clips_well => (Wish::Open, opening, CLIPPED_READINGS),
                    Wish::Open if hears(0) => (Wish::Open, opening, HEARD_READINGS),
                    Wish::Open => (Wish::Open, opening, UNPROVEN_READINGS),
                    // A weak flexor may take seconds to curve.
                    wish if hears(1) => (wish, closing, u16::MAX),
                    wish => (wish, closing, UNPROVEN_READINGS),
                }
            }
            None => {
                self.uncalibrated([electrodes[0].level, electrodes[1].level]);
                (self.wish, usize::from(self.wish == Wish::Open), UNPROVEN_READINGS)
            }
        };
        if most > UNPROVEN_READINGS && electrodes[mover].turned {
            (self.moved, self.waits) = (0, 0);
        }
        self.bound(wish, electrodes[mover].proven, most)
    }

    /// Lets an unproven contraction move the hand for `most` readings. A pause does not begin a new while.
    fn bound(&mut self, wish: Wish, proven: bool, most: u16) -> Wish {
        if proven {
            (self.moved, self.waits) = (0, 0);
            return wish;
        }
        if wish == Wish::Rest {
            self.waits = self.waits.saturating_sub(1);
            if self.waits == 0 {
                self.moved = self.moved.saturating_sub(1);
            }
            return wish;
        }
        if most == u16::MAX {
            return wish;
        }
        if self.moved >= most {
            // What follows a pause has to wait for three times as long as this took.
            self.waits = self.waits.max(3 * UNPROVEN_READINGS);
            return Wish::Rest;
        }
        self.moved += 1;
        wish
    }

    fn calibrated(&mut self, sites: &Sites, levels: [Option<i32>; 2], closing_unmodulated: bool) {
        let [closing, opening] = levels;
        let ratio = match levels {
            [Some(a), Some(b)] => Some(b - a),
            _ => None,
        };
        // An electrode that hums or is lost says nothing about the other one's contraction.
        let ratio_allows = |least: i32| closing_unmodulated || ratio.is_none_or(|ratio| ratio >= least);
        let above = opening.map_or(i32::MIN / 2, |level| level - sites.open);

        let begins = ratio_allows(sites.ratio_opens);
        self.opens = if begins && above >= OPEN_AT_ONCE { self.opens.saturating_add(1) } else { 0 };
        self.slow = if begins && above >= -OPEN_SLOWLY {
            (self.slow + 1).min(2 * SLOW_READINGS)
        } else {
            self.slow.saturating_sub(SLOW_LEAK)
        };
        let slowly = self.slow >= SLOW_READINGS;
        let stays = above >= self.open_ends() && ratio_allows(sites.ratio_still_opens);
        let opens = match self.wish {
            // What began slowly ends where it would have anyway, not when its count has run down.
            Wish::Open => stays || (slowly && above >= -OPEN_ENDS),
            _ => self.opens >= OPEN_READINGS || (slowly && above >= -OPEN_ENDS),
        };
        if opens {
            self.open_for = if slowly { u16::MAX } else { self.open_for.saturating_add(1) };
            self.since_open = 0;
            self.closes = 0;
            self.wish = Wish::Open;
            self.strength_permille = strength(above, -OPEN_ENDS, OPEN_AT_ONCE);
            return;
        }
        self.open_for = 0;
        self.since_open = self.since_open.saturating_add(1);
        if self.wish == Wish::Open {
            self.wish = Wish::Rest;
        }
        self.close(sites, closing, levels, ratio);
    }

    fn close(&mut self, sites: &Sites, closing: Option<i32>, levels: [Option<i32>; 2], ratio: Option<i32>) {
        let directed = |most: i32, nearer: i32| match (ratio, levels) {
            (Some(ratio), [Some(a), Some(b)]) => {
                ratio <= most && b < sites.both && sites.way[0] * a + sites.way[1] * b <= nearer
            }
            _ => closing.is_some_and(|level| level >= sites.close - CLOSE_ALONE),
        };
        let begins = closing.is_some_and(|level| level >= sites.close_begins)
            && directed(sites.ratio_closes, sites.nearer);
        self.closes = if begins { self.closes.saturating_add(1) } else { 0 };
        let needed =
            if self.since_open < SOON_READINGS { CLOSE_READINGS_AFTER_OPENING } else { CLOSE_READINGS };
        let closes = match self.wish {
            Wish::Close => {
                closing.is_some_and(|level| level >= sites.close_ends)
                    && directed(sites.ratio_still_closes, sites.still_nearer)
            }
            _ => self.closes >= needed,
        };
        self.wish = if closes { Wish::Close } else { Wish::Rest };
        self.strength_permille =
            strength(closing.unwrap_or(0) - sites.close, sites.close_ends - sites.close, OPEN_AT_ONCE);
    }

    /// Where opening ends, relative to its calibrated level.
    fn open_ends(&self) -> i32 {
        const FROM: i32 = OPEN_AT_ONCE - OPEN_SLACK;
        let relaxing = i32::from(self.open_for.saturating_sub(CREST_READINGS)).min(RELAX_READINGS);
        FROM - (FROM + OPEN_ENDS) * relaxing / RELAX_READINGS
    }

    /// Only what nobody can mistake, and only if it lasts.
    fn uncalibrated(&mut self, levels: [Option<i32>; 2]) {
        let [Some(flexor), Some(extensor)] = levels else {
            (self.wish, self.opens, self.closes) = (Wish::Rest, 0, 0);
            return;
        };
        let slack = |wish: Wish| if self.wish == wish { octaves(500) } else { 0 };
        let (open, close) = (slack(Wish::Open), slack(Wish::Close));
        let opens = extensor >= DEFAULT_OPEN - open && extensor - flexor >= DEFAULT_OPEN_OVER - open;
        let closes = flexor >= DEFAULT_CLOSE - close && flexor - extensor >= DEFAULT_CLOSE_OVER - close;
        self.opens = if opens { self.opens.saturating_add(1) } else { 0 };
        self.closes = if closes { self.closes.saturating_add(1) } else { 0 };
        self.wish = if self.opens >= DEFAULT_READINGS {
            Wish::Open
        } else if self.closes >= DEFAULT_READINGS {
            Wish::Close
        } else {
            Wish::Rest
        };
        let above = if self.wish == Wish::Open { extensor - DEFAULT_OPEN } else { flexor - DEFAULT_CLOSE };
        self.strength_permille = strength(above, -octaves(500), octaves(500));
    }

    /// How strongly the last wish is meant, per mille: for the speed.
    #[must_use]
    pub const fn strength_permille(&self) -> u16 {
        self.strength_permille
    }
}

/// Where a level lies between its end and its full strength, per mille.
fn strength(level: i32, ends: i32, full: i32) -> u16 {
    // Not `clamp`, which panics if its ends are in the wrong order.
    ((level.min(full).max(ends) - ends) * 1_000 / (full - ends).max(1)) as u16
}
