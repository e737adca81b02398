//! Target force of a slide: friction needs (L + g) / mu, where L is the load that the object had before it
//! slid, g what the load still grows by, and mu the ratio that the slide shows.
//!
//! What an object has gained in speed, its load less what friction carries shows: dv = (1 - Ft/L) g dt. A
//! faster object needs more force to stop within the same time.

use tenax_hal_shim::channel::frames;
use tenax_hal_shim::wire::Forces;

use crate::force::friction::LEAST_PERMILLE;

/// First target, before the slide's ratio is known, beyond the force at the begin, per mille: a step that shows
/// whether Ft follows, and more where S1 reports slip, since friction may have fallen to 0.6 of what held. Each as far
/// as the slip is sure.
const PROBE_PERMILLE: i64 = 250;
const MORE_PERMILLE: i64 = 400;
/// Ft/Fn, per mille, from which friction may have fallen, and from which as far: little is smoother.
const RARE_PERMILLE: i64 = 50;
const USUAL_PERMILLE: i64 = 225;
/// Target as a part of what friction needs, per mille, for an object that hardly moves.
const AIM_PERMILLE: i32 = 1_200;
/// Speed that raises the target by as much as friction needs, mm/s: 9.81 m/s2 for 60 ms.
const STOPS_MM_S: i32 = 589;
/// Speed that a falling object gains in a reading of 12.5 ms, mm/s.
const GAINS_MM_S: i32 = 123;
const SPEED_MAX_MM_S: i32 = 300;
/// Rise of Fn from which the ratio is the friction's: below, the quadrants' hysteresis hides the fall of Ft.
const SHOWS_PERMILLE: i32 = 1_040;
/// Rise of Ft/Fn that is more than noise, per mille.
const RISES_PERMILLE: i64 = 1_050;
/// Part of the load below which Ft shows that the object slides, per mille.
const SLIDES_PERMILLE: i32 = 900;
/// Growth within 100 ms from which a load grows on while the object slides, as a part of it, beyond its noise.
const GROWS_PART: i32 = 32;
/// Deviation of Fn from which the slope of Ft over Fn shows, as a part of Fn, per mille.
const SPREAD_PERMILLE: i64 = 50;
/// Slope of Ft over Fn as a part of friction's, per mille, from which Ft follows Fn, as that of a sliding object does,
/// and below which it stays, as that of a held one.
const FOLLOWS_PERMILLE: i64 = 500;
const STAYS_PERMILLE: i64 = 450;
/// Target at most, as a multiple of the force at the begin: if the vibration was loud, or Ft followed what another detector
/// felt; if that is not shown yet.
const MOST_SURE: i32 = 4;
const MOST_FELT: i32 = 2;
/// Quiet readings at the target after which the slide is over, 37.5 ms.
const QUIET_READINGS: u8 = 3;
/// Readings at the target after which nothing more is expected of it, 200 ms.
const REACHED_READINGS: u8 = 16;
/// Closing without effect on Fn after which the slide is over: the motor stalls.
const STALLS_FRAMES: u32 = frames(250);
/// Largest force, mN, for products below 2^31.
const FORCE_MAX: i32 = 1 << 17;

/// Load of the last 100 ms in which the hand stood still.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Carried {
    /// Largest Ft, mN, and its growth in that time.
    pub ft_mn: i32,
    pub grown_mn: i32,
}

/// Reports of slip at this moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Heard {
    /// S1, above the threshold that is set; below it.
    pub loud: bool,
    pub quiet: bool,
    /// Another detector.
    pub felt: bool,
}

impl Heard {
    pub const fn slip(self) -> bool {
        self.loud || self.quiet || self.felt
    }
}

/// Ft over Fn of a slide, a straight line of least squares; mN.
#[derive(Clone, Copy, Debug, Default)]
struct Line {
    readings: i64,
    mean_fn: i64,
    mean_ft: i64,
    /// Sums of the squared deviations of Fn, and of its products with those of Ft, mN^2.
    squares: i64,
    products: i64,
}

impl Line {
    fn add(&mut self, fn_mn: i64, ft_mn: i64) {
        self.readings += 1;
        let (x, y) = (fn_mn - self.mean_fn, ft_mn - self.mean_ft);
        self.mean_fn += x.checked_div(self.readings).unwrap_or(0);
        self.mean_ft += y.checked_div(self.readings).unwrap_or(0);
        self.squares += x * (fn_mn - self.mean_fn);
        self.products += x * (ft_mn - self.mean_ft);
    }

    /// (dFt / dFn) / (Ft / Fn). None while Fn has hardly risen.
    fn slope_permille(&self) -> Option<i64> {
        let spread = self.mean_fn * SPREAD_PERMILLE / 1_000;
        let shows = self.readings >= 3 && self.squares >= self.readings * spread * spread;
        let slope_permille = (self.products * 1_000).checked_div(self.squares).filter(|_| shows)?;
        (slope_permille * self.mean_fn).checked_div(self.mean_ft)
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Slide {
    /// L + g, mN.
    load_mn: i32,
    before_mn: i32,
    /// The load was growing as the slide began.
    grew: bool,
    /// Fn at the begin, mN.
    began_mn: i32,
    most_mn: i32,
    mu_permille: Option<u16>,
    speed_mm_s: i32,
    loud: bool,
    felt: bool,
    /// How much of the first step it is worth.
    sure_permille: i32,
    /// Largest target while nothing but a quiet slip was reported, mN.
    most_quiet_mn: i32,
    quiet_readings: u8,
    /// Since the last reading: a report, or the motor ran.
    stirred: bool,
    stalled_frames: u32,
    reached_readings: u8,
    line: Line,
    followed: bool,
    /// Sums of Ft and Fn while it slid, mN.
    slid_mn: [i64; 2],
}

impl Slide {
    pub fn begin(
        forces: &Forces,
        carried: Carried,
        heard: Heard,
        sure_permille: i32,
        most_quiet_mn: i32,
    ) -> Self {
        let before_mn = carried.ft_mn.clamp(1, FORCE_MAX);
        Self {
            load_mn: (before_mn + carried.grown_mn.max(0) / 2).min(FORCE_MAX),
            before_mn,
            grew: carried.grown_mn >= (before_mn / GROWS_PART).max(1),
            began_mn: forces.fn_mn.clamp(1, FORCE_MAX),
            most_mn: forces.fn_mn,
            mu_permille: None,
            speed_mm_s: 0,
            loud: heard.loud,
            felt: heard.felt,
            sure_permille,
            most_quiet_mn,
            quiet_readings: 0,
            stirred: true,
            stalled_frames: 0,
            reached_readings: 0,
            line: Line::default(),
            followed: false,
            slid_mn: [0; 2],
        }
    }

    /// Missing force, mN, by a reading. None while the ratio is unknown. Call it once a slow frame.
    pub fn feel(&mut self, forces: &Forces, heard: Heard, sure_permille: i32) -> Option<i32> {
        self.sure_permille = self.sure_permille.max(sure_permille);
        let ratio = forces.ratio_permille?;
        let (fn_mn, ft_mn) = (forces.fn_mn.clamp(0, FORCE_MAX), forces.ft_mn.clamp(0, FORCE_MAX));
        if fn_mn > self.most_mn {
            (self.most_mn, self.stalled_frames) = (fn_mn, 0);
        }
        let falls_permille = (self.before_mn - ft_mn) / (self.before_mn / 1_000).max(1);
        let gains = GAINS_MM_S * falls_permille.clamp(-1_000, 1_000) / 1_000;
        self.speed_mm_s = (self.speed_mm_s + gains).clamp(0, SPEED_MAX_MM_S);
        if !heard.slip() {
            self.speed_mm_s /= 2;
        } else if self.speed_mm_s > 0 {
            self.slid_mn[0] += i64::from(ft_mn);
            self.slid_mn[1] += i64::from(fn_mn);
        }
        self.still_held(fn_mn, ft_mn);
        self.follow(fn_mn, ft_mn, heard);
        let shows = self.shows(fn_mn) && ratio >= LEAST_PERMILLE;
        let falls = i64::from(ft_mn) * 1_000 < i64::from(self.before_mn) * i64::from(SLIDES_PERMILLE);
        self.mu_permille = match self.mu_permille {
            // Nothing but the films of a hand that hums may be loud, and what is held shows no friction.
            None if shows && (self.loud || self.followed) => Some(ratio),
            Some(mu) if falls && heard.slip() => Some(mu.min(ratio.max(LEAST_PERMILLE))),
            // What is held shows less than friction, so that friction is at least as much.
            Some(mu) if ratio > mu => Some(mu + (ratio - mu) / 2),
            mu => mu,
        };
        let lacks_mn = self.lacks_mn(forces);
        let reached = lacks_mn <= 0;
        let quiet = reached && !core::mem::take(&mut self.stirred);
        self.reached_readings = if reached { self.reached_readings.saturating_add(1) } else { 0 };
        self.quiet_readings = if quiet { self.quiet_readings + 1 } else { 0 };
        Some(lacks_mn)
    }

    pub fn lacks_mn(&self, forces: &Forces) -> i32 {
        if self.is_refuted() { 0 } else { self.target_mn() - forces.fn_mn }
    }

    /// Fn rises, and Ft never followed: nothing slides.
    pub fn is_refuted(&self) -> bool {
        !self.followed && self.line.slope_permille().is_some_and(|slope| slope < STAYS_PERMILLE)
    }

    /// A ratio beyond that of the begin: the object was held until now, and its load has grown to Ft.
    fn still_held(&mut self, fn_mn: i32, ft_mn: i32) {
        let [now, began] =
            [(ft_mn, self.began_mn), (self.before_mn, fn_mn)].map(|(a, b)| i64::from(a) * i64::from(b));
        if self.mu_permille.is_none() && !self.followed && now * 1_000 > began * RISES_PERMILLE {
            self.load_mn = self.load_mn.max(ft_mn);
            (self.began_mn, self.before_mn, self.line) = (fn_mn.max(1), ft_mn, Line::default());
        }
    }

    fn follow(&mut self, fn_mn: i32, ft_mn: i32, heard: Heard) {
        if !self.shows(fn_mn) {
            return;
        }
        self.line.add(fn_mn.into(), ft_mn.into());
        let follows = self.line.slope_permille().is_some_and(|slope| slope >= FOLLOWS_PERMILLE);
        self.followed |= follows;
        // What slides weighs at least what friction carries, unless friction slows it: the load has grown since.
        let grown_mn = (ft_mn - self.load_mn).max(0);
        if heard.loud && self.grew {
            self.load_mn += grown_mn / 2;
        } else if !self.loud && heard.slip() && self.speed_mm_s == 0 && follows {
            self.load_mn += grown_mn;
        }
    }

    fn shows(&self, fn_mn: i32) -> bool {
        i64::from(fn_mn) * 1_000 >= i64::from(self.began_mn) * i64::from(SHOWS_PERMILLE)
    }

    fn target_mn(&self) -> i32 {
        let load = i64::from(self.load_mn);
        let wanted = match self.mu_permille {
            None => {
                let (fn_mn, ft_mn) = (i64::from(self.began_mn), i64::from(self.before_mn));
                let ratio = ft_mn * 1_000 / fn_mn.max(1);
                let more = MORE_PERMILLE * (ratio.clamp(RARE_PERMILLE, USUAL_PERMILLE) - RARE_PERMILLE)
                    / (USUAL_PERMILLE - RARE_PERMILLE);
                let step = PROBE_PERMILLE + if self.loud { more } else { 0 };
                let aim = 1_000 + step * i64::from(self.sure_permille) / 1_000;
                load * aim / 1_000 * fn_mn / ft_mn.max(1)
            }
            Some(mu) => {
                let aim = i64::from(AIM_PERMILLE + self.speed_mm_s * 1_000 / STOPS_MM_S);
                (load * aim).checked_div(mu.into()).unwrap_or(load)
            }
        };
        let most_mn = match (self.loud || (self.felt && self.followed), self.felt) {
            (true, _) => MOST_SURE * self.began_mn,
            (false, true) => MOST_FELT * self.began_mn,
            (false, false) => self.most_quiet_mn,
        };
        wanted.min(most_mn.into()) as i32
    }

    /// Call it once a frame. True: it is over.
    pub fn tick(&mut self, drives: bool, heard: Heard) -> bool {
        (self.loud, self.felt) = (self.loud | heard.loud, self.felt | heard.felt);
        self.stirred |= drives || heard.slip();
        self.stalled_frames += drives as u32;
        self.quiet_readings >= QUIET_READINGS
            || self.reached_readings >= REACHED_READINGS
            || self.is_refuted()
            || self.stalled_frames >= STALLS_FRAMES
    }

    pub const fn is_quiet(&self) -> bool {
        !self.loud && !self.felt
    }

    /// Mean Ft/Fn while it slid, per mille. None while its friction is unknown.
    pub fn slid_permille(&self) -> Option<u16> {
        let [ft_mn, fn_mn] = self.slid_mn;
        let mean = (ft_mn * 1_000).checked_div(fn_mn).map(|ratio| ratio.min(1_000) as u16);
        self.mu_permille.map(|mu| mean.unwrap_or(mu))
    }
}
