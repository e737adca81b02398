//! The wearer's wish from both envelopes. The *share* of a site's calibrated rise says whether, the *place* of
//! the electrodes' ratio between calibrated closing and opening which way. Constant hum and tone are subtracted.

use super::constants::Fitted;
use super::fitted::FITTED;
use super::level::{FLOOR_LEVEL, level_of, uv_of};
use super::model::EmgModel;
use super::trust::HUM_SHIFT;

/// Top of the sensor's range, uV: above, no motion starts, but one that has started goes on.
pub const OVER_UV: i32 = 2_950_000;
/// Share of opening that opens even if a sensor is doubted, per mille.
const STRONG: i32 = 1_000;
/// Share of opening above the calibrated one of closing, from which an opening begins beside a doubted closing electrode.
const BESIDE: i32 = 100;
/// Share from which an electrode does not rest, and sixteenths of the calibrated rise of the other electrode
/// below which that takes no part in a closing or an opening, and from which it does.
const WORKS: i32 = 240;
const UNHEARD: [i32; 2] = [4, 2];
const HEARD: i32 = 8;
/// Share of closing that closes even without a reading of the opening site, per mille.
const ALONE: i32 = 900;
/// Deviations of its calibrated place that no closing reaches.
const APART: i32 = 3;
const CALM_FRAMES: u16 = 40;
const HUM_FRAMES: i32 = 21;
const MOST_DRIFT_UV: i32 = 1_500_000;
const ACTIVE: [i32; 2] = [350, 250];
const ACTIVE_UV: [i32; 2] = [159_000, 112_000];
/// Least rise of the other electrode that proves a contraction, Q10 octaves, and in deviations of its rest.
const HEARS_AT_ALL: i32 = 300;
const HEARS_SPREADS: i32 = 1;
/// Without calibration: envelopes from which closing and opening begin, uV; least distance of the other
/// electrode, Q10 octaves; duration, slow frames.
const DEFAULT_BEGINS_UV: [i32; 2] = [600_000, 1_500_000];
const DEFAULT_OVER: [i32; 2] = [1_322, 2_900];
const DEFAULT_FRAMES: i32 = 24;
const DEFAULT_HEARS: [i32; 2] = [512, 256];

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wish {
    #[default]
    Rest,
    Close,
    Open,
}

#[derive(Clone, Copy, Debug, Default)]
pub struct Electrode {
    /// Mean envelope above the live zero, uV, [`OVER_UV`] at most; None: no valid reading.
    pub uv: Option<i32>,
    pub over: bool,
    /// Blocks nothing, and starts only a strong wish.
    pub doubted: bool,
    pub still: bool,
    pub hums: bool,
    /// Active without the other electrode: hides no opening.
    pub lone: bool,
}

/// Activity of an electrode, and the other one's part in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Part {
    #[default]
    Rest,
    Unheard,
    Unknown,
    Heard,
}

#[derive(Clone, Copy, Debug)]
struct Sites {
    /// Electrode 1 closes.
    crossed: bool,
    rest: [i32; 2],
    rest_uv: [i32; 2],
    span: [i32; 2],
    begins: [i32; 2],
    ends: [i32; 2],
    fall: [i32; 2],
    both: [i32; 2],
    /// Least rise of the other electrode with each wish; 0: its signal is too small.
    hears: [i32; 2],
    /// Its calibrated rise, Q10 octaves.
    other: [i32; 2],
    works_uv: [i32; 2],
    /// Share from which an opening begins beside a doubted closing electrode.
    beside: i32,
    /// Difference of both rises as calibrated for closing, and what opening adds to it.
    close_ratio: i32,
    turn: i32,
    /// Place from which a strong opening opens at once.
    apart: i32,
    active_uv: [[i32; 2]; 2],
}

impl Sites {
    fn of(f: &Fitted, model: &EmgModel) -> Self {
        let crossed = model.closing_site() == 1;
        let by_site = |point: [i32; 2]| by_site(crossed, point);
        let (rest, close, open) = (by_site(model.rest()), by_site(model.close()), by_site(model.open()));
        let spread = by_site(model.spread());
        let span = [(close[0] - rest[0]).max(512), (open[1] - rest[1]).max(512)];
        let begins = [0, 1].map(|n| {
            let least = f.least_rise.max(f.least_spreads * spread[n]) * 1_000 / span[n];
            f.begins[n].max(least).min(850)
        });
        let ends = [0, 1].map(|n| f.ends[n].min(begins[n] - f.hysteresis * 1_000 / span[n]).max(f.least_end));
        let fall = [0, 1].map(|n| f.fall.max(f.least_fall * 1_000 / span[n]));
        let hears = [close[1] - rest[1], open[0] - rest[0]];
        let both = [0, 1].map(|n| (hears[n] * 1_000 / span[1 - n]).max(0));
        let turn = ((open[1] - open[0]) - (close[1] - close[0])).max(256);
        let active = [0, 1].map(|k: usize| {
            [0, 1].map(|n: usize| (rest[n] + span[n] * ACTIVE[k] / 1_000).min(level_of(ACTIVE_UV[k])))
        });
        Self {
            crossed,
            rest,
            rest_uv: rest.map(uv_of),
            span,
            begins,
            ends,
            fall,
            beside: (both[0] + BESIDE).min(STRONG),
            both: both.map(|share| share + f.both),
            hears: [0, 1].map(|n: usize| {
                let least = (HEARS_SPREADS * spread[1 - n]).min(hears[n] / 2).max(hears[n] / 4);
                if hears[n] >= HEARS_AT_ALL { least } else { 0 }
            }),
            other: hears,
            works_uv: [0, 1].map(|n: usize| uv_of(rest[n] + span[n] * WORKS / 1_000)),
            close_ratio: close[1] - rest[1] - (close[0] - rest[0]),
            turn,
            apart: f.place_begins.max(APART * model.close_spread() * 1_000 / turn),
            active_uv: [0, 1].map(|n: usize| {
                [0, 1].map(|k: usize| uv_of(active[k][n].max(rest[n] + [300, 200][k]) - 1) + 1)
            }),
        }
    }

    /// Rise of the other electrode with a rise of a site in a contraction, as calibrated.
    fn expected(&self, n: usize, rise: i32) -> i32 {
        rise.min(self.span[n]) * self.other[n] / self.span[n].max(1)
    }

    /// Part of the other electrode in an activity of a site. `rise`: above rest and what was added to it.
    fn part(&self, n: usize, electrodes: [&Electrode; 2], rise: [i32; 2]) -> Part {
        let n = n & 1;
        let (own, other) = (electrodes[n], electrodes[1 - n]);
        let Some(uv) = own.uv.filter(|&uv| uv >= self.works_uv[n]) else { return Part::Rest };
        let expected = self.expected(n, level_of(uv) - self.rest[n]);
        match 16 * rise[1 - n] {
            _ if other.uv.is_none() || self.other[n] < HEARS_AT_ALL => Part::Unknown,
            rise if rise < UNHEARD[n] * expected => Part::Unheard,
            // A doubted electrode vouches for nothing.
            rise if rise >= HEARD * expected && !other.doubted => Part::Heard,
            _ => Part::Unknown,
        }
    }
}

fn by_site<T>(crossed: bool, [flexor, extensor]: [T; 2]) -> [T; 2] {
    if crossed { [extensor, flexor] } else { [flexor, extensor] }
}

#[derive(Clone, Debug)]
pub struct Decide {
    sites: Option<Sites>,
    machine: Machine,
}

#[derive(Clone, Debug, Default)]
struct Machine {
    fitted: &'static Fitted,
    wish: Wish,
    next: Wish,
    stands: i32,
    /// Slow frames since activity that is no opening, and since opening.
    since: [i32; 2],
    calm: u16,
    /// Shares of both sites and the place, Q4.
    mean: [i32; 3],
    was_lone: bool,
    parts: [Part; 2],
    crest: i32,
    /// Crest of a closing that has not ended by its own share, though the other muscle may hide it; 0: none.
    held: i32,
    trough: [i32; 2],
    /// Offset of rest, uV, Q8.
    drift: [i32; 2],
    /// Envelope of the hum that is part of it, uV; 0 without hum.
    hum_uv: [i32; 2],
}

impl Decide {
    pub fn new(model: Option<&EmgModel>) -> Self {
        Self::with(&FITTED, model)
    }

    pub fn with(fitted: &'static Fitted, model: Option<&EmgModel>) -> Self {
        Self { sites: model.map(|model| Sites::of(fitted, model)), machine: Machine::new(fitted) }
    }

    /// Site (0 closes, 1 opens) of electrode 0 (flexor) or 1 (extensor), or the other way round.
    pub fn site_of(&self, electrode: usize) -> usize {
        // `& 1` lets the compiler drop the bounds check, here and below.
        (electrode ^ usize::from(self.sites.as_ref().is_some_and(|sites| sites.crossed))) & 1
    }

    /// Envelopes, uV, at which an electrode becomes active and ceases to be.
    pub fn active_uv(&self, electrode: usize) -> [i32; 2] {
        self.sites.as_ref().map_or(ACTIVE_UV, |sites| sites.active_uv[self.site_of(electrode)])
    }

    /// Electrode of the present wish; at rest, the opening one.
    pub fn mover(&self) -> usize {
        self.site_of(self.machine.site())
    }

    /// Rest level and least rise of the other electrode, Q10 octaves; None if contractions hardly raise it.
    pub fn hears(&self) -> Option<[i32; 2]> {
        let site = self.machine.site();
        match &self.sites {
            Some(sites) => (sites.hears[site] > 0).then(|| [sites.rest[1 - site], sites.hears[site]]),
            None => Some([FLOOR_LEVEL, DEFAULT_HEARS[site]]),
        }
    }

    /// Rise of the other electrode below which it takes no part in an electrode's rise, Q10 octaves; 0: not known.
    pub fn unheard(&self, electrode: usize, rise: i32) -> i32 {
        let n = self.site_of(electrode);
        self.sites.as_ref().map_or(0, |sites| UNHEARD[n] * sites.expected(n, rise) / 16)
    }

    /// By site.
    pub const fn parts(&self) -> [Part; 2] {
        self.machine.parts
    }

    /// The opening electrode has more than a closing gives it.
    pub fn outweighs(&self) -> bool {
        self.sites.as_ref().is_none_or(|sites| self.machine.mean[1] / 16 >= sites.beside)
    }

    pub fn strength_permille(&self) -> u16 {
        let Machine { fitted, wish, mean, .. } = &self.machine;
        if *wish == Wish::Rest {
            return 0;
        }
        let site = self.machine.site();
        let (ends, range) = (fitted.ends[site], (STRONG - fitted.ends[site]).max(1));
        ((mean[site] / 16 - ends).clamp(0, range) * 1_000 / range) as u16
    }

    pub fn take(&mut self, electrodes: &[Electrode; 2]) -> Wish {
        match &self.sites {
            Some(sites) => self.machine.calibrated(sites, by_site(sites.crossed, electrodes.each_ref())),
            None => self.machine.uncalibrated(electrodes),
        }
        self.machine.wish
    }
}

impl Machine {
    fn new(fitted: &'static Fitted) -> Self {
        Self { fitted, since: [i32::MAX; 2], ..Self::default() }
    }

    fn site(&self) -> usize {
        usize::from(self.wish != Wish::Close)
    }

    fn calibrated(&mut self, sites: &Sites, electrodes: [&Electrode; 2]) {
        let f = self.fitted;
        let over = electrodes[1].over;
        // `max(1)`, far below any span or turn, rules a division by zero out.
        let mut blind = electrodes.map(|electrode| electrode.uv.is_none() || electrode.doubted);
        let mut rise = [0, 1].map(|n: usize| {
            electrodes[n].uv.map_or(0, |uv| level_of(uv - (self.drift[n] >> 8)) - sites.rest[n])
        });
        self.parts = [0, 1].map(|n: usize| sites.part(n, electrodes, rise));
        blind[0] |= electrodes[0].lone;
        if blind[0] {
            rise[0] = 0;
        }
        let share = [0, 1].map(|n: usize| rise[n] * 1_000 / sites.span[n].max(1));
        let place = (rise[1] - rise[0] - sites.close_ratio) * 1_000 / sites.turn.max(1);
        let now = [share[0].min(1_300), share[1].min(1_300), place.clamp(-1_000, 2_000)];
        for (mean, now) in self.mean.iter_mut().zip(now) {
            *mean += (now * 16 - *mean) / f.mean_frames.max(1);
        }
        if blind[0] {
            (self.mean[0], self.mean[2]) = (0, 16 * now[2]);
        }
        if electrodes[0].lone && !self.was_lone {
            // A co-contraction whose closing electrode is doubted is no opening that begins.
            self.trough[1] = self.mean[1] / 16;
        }
        self.was_lone = electrodes[0].lone;
        let wish = self.wanted(sites, blind, over);
        self.settle(wish);
        // A doubted closing electrode says nothing about the ratio.
        let lately = !blind[0] && self.since[0] < f.after_frames[0];
        let strong = rise[1] - sites.span[1] >= if lately { f.firmer } else { 0 };
        let alone = || share[0] < sites.both[1] + f.both || electrodes[0].still;
        let rises = || !electrodes[0].lone || share[1] >= self.trough[1] + f.rise;
        let apart = || (blind[0] || place >= sites.apart && alone()) && rises();
        if strong && !over && self.wish != Wish::Open && apart() {
            (self.wish, self.next, self.stands) = (Wish::Open, Wish::Open, 0);
            self.mean = now.map(|value| value * 16);
        }
        self.follow(sites, electrodes, wish);
    }

    fn wanted(&mut self, sites: &Sites, blind: [bool; 2], over: bool) -> Wish {
        let f = self.fitted;
        let [closes, opens, place] = self.mean.map(|mean| mean >> 4);
        let own = (self.wish != Wish::Rest).then(|| self.site());
        for (n, share) in [closes, opens].into_iter().enumerate() {
            if own == Some(n) {
                self.crest =
                    (self.crest + (share * 256 - self.crest) / f.crest_frames.max(1)).max(share * 256);
                self.trough[n] = share;
            }
            self.trough[n] = self.trough[n].min(share);
        }
        if own.is_none() {
            self.crest = 0;
        }
        let ends = |crest: i32, n: usize| sites.ends[n].max((crest >> 8) - sites.fall[n]);
        if own == Some(0) {
            self.held = self.crest;
        } else if closes < ends(self.held, 0) {
            self.held = 0;
        }
        let held = self.held > 0;
        let ends = |n: usize| ends(self.crest, n);
        let begins = |n: usize| {
            if n == 0 && held && place < f.place_stays[1] {
                0
            } else {
                sites.begins[n].max(self.trough[n] + f.rise)
            }
        };
        // A fist that is firmer than the calibrated one drives both muscles more.
        let firmer = (closes - 1_000).max(0) * sites.span[0] / sites.span[1].max(1);
        let both = opens >= sites.both[0] + firmer + if held { f.both } else { 0 };
        let busy = !blind[0] && place < f.place_begins && (closes >= f.busy || opens >= f.busy);
        self.since[0] = if busy { 0 } else { self.since[0].saturating_add(1) };
        self.since[1] = if self.wish == Wish::Open { 0 } else { self.since[1].saturating_add(1) };
        let calm =
            self.since[0] >= f.after_frames[1] || (self.since[0] >= f.after_frames[0] && opens >= STRONG);
        let may_open = calm && !blind[1] && closes < sites.both[1];
        let may_close = !over && !blind[0] && !both && (!blind[1] || closes >= ALONE);
        match self.wish {
            Wish::Open if over => Wish::Open,
            Wish::Open if (place >= f.place_stays[1] || blind[0]) && opens >= ends(1) => Wish::Open,
            Wish::Close if may_close && place <= f.place_stays[0] && closes >= ends(0) => Wish::Close,
            Wish::Rest | Wish::Close if may_open && place >= f.place_begins && opens >= begins(1) => {
                Wish::Open
            }
            Wish::Rest | Wish::Open if may_close && place <= f.place_begins && closes >= begins(0) => {
                Wish::Close
            }
            _ => Wish::Rest,
        }
    }

    fn settle(&mut self, wish: Wish) {
        let f = self.fitted;
        let dwell = match wish {
            // Ripple ends no closing while the place says closing.
            Wish::Rest if self.wish == Wish::Close && self.mean[2] <= 16 * f.place_stays[0] => f.dwell[1],
            Wish::Rest => f.dwell[0],
            Wish::Close if self.since[1] < f.after_frames[0] => f.after_dwell,
            Wish::Close => f.dwell[2],
            Wish::Open => f.dwell[3],
        };
        self.stand(wish, dwell);
    }

    fn stand(&mut self, wish: Wish, dwell: i32) {
        self.stands = if wish == self.next { self.stands.saturating_add(1) } else { 1 };
        self.next = wish;
        if self.stands >= dwell {
            self.wish = wish;
        }
    }

    fn follow(&mut self, sites: &Sites, electrodes: [&Electrode; 2], wish: Wish) {
        let f = self.fitted;
        let calm = [self.wish, wish] == [Wish::Rest; 2] && (0..2).all(|n| self.mean[n] < 16 * f.ends[n]);
        self.calm = if calm { self.calm.saturating_add(1) } else { 0 };
        for (n, &Electrode { uv, hums, .. }) in electrodes.into_iter().enumerate() {
            let Some(uv) = uv else { continue };
            let added = (uv - sites.rest_uv[n]).min(MOST_DRIFT_UV) * 256;
            if hums {
                self.hum_uv[n] = uv;
            }
            if self.calm >= CALM_FRAMES || hums {
                let frames = if hums { HUM_FRAMES } else { f.rest_frames.max(1) };
                self.drift[n] += (added - self.drift[n]) / frames;
            }
            // What was added is no more than what is there; hum is constant, so what falls below it is none.
            if uv < self.hum_uv[n] - (self.hum_uv[n] >> HUM_SHIFT) {
                (self.drift[n], self.hum_uv[n]) = (0, 0);
            } else if added < self.drift[n] && self.drift[n] > 0 {
                self.drift[n] += (added.max(0) - self.drift[n]) / 8;
            }
        }
    }

    fn uncalibrated(&mut self, electrodes: &[Electrode; 2]) {
        self.parts = electrodes.map(|electrode| match electrode.uv {
            Some(uv) if uv >= ACTIVE_UV[0] => Part::Unknown,
            _ => Part::Rest,
        });
        let mut level = electrodes.map(|electrode| electrode.uv.map(level_of));
        level[0] = level[0].filter(|_| !electrodes[0].lone);
        let is_over = electrodes[1].over;
        let wants = |n: usize, wish: Wish| {
            let slack = if self.wish == wish { 512 } else { 0 };
            let stands_out = |own: i32| {
                let over = level[1 - n].is_none_or(|other| own - other >= DEFAULT_OVER[n] - slack);
                own >= level_of(DEFAULT_BEGINS_UV[n]) - slack && over
            };
            level[n].is_some_and(stands_out)
        };
        let wish = if self.wish == Wish::Open && is_over || !is_over && wants(1, Wish::Open) {
            Wish::Open
        } else if level[1].is_some() && !is_over && wants(0, Wish::Close) {
            Wish::Close
        } else {
            Wish::Rest
        };
        self.stand(wish, if wish == Wish::Rest { 1 } else { DEFAULT_FRAMES });
        self.mean = [16 * 750; 3];
    }
}

#[cfg(test)]
mod tests;
