//! Whether a myosensor's envelope is one of a muscle.
//!
//! What is observable: three readings a slow frame (3, 3 and 6.5 ms apart) of an envelope that the myosensor has already
//! smoothed over tens of milliseconds. A muscle's envelope never stands still: the shared recordings, behind a 4 Hz
//! low-pass, stay within 1 % of a level for at most 163 ms while the muscle works, and curve by more than 8 % within
//! 225 ms of their onset. Rectified mains, a lifted electrode and a broken wire stand still; creep climbs without ever
//! turning back. A fault and a contraction that begin alike cannot be told apart at once: until an envelope has curved, it
//! is unproven, and what it may do is bounded ([`intent`](super::intent)).

use super::log2::level_of;
use super::mains::{Mains, UNIT_UV, WINDOW};

/// From here an envelope above the live zero is at the top of its range, uV: 3.15 V at the pin.
pub const TOP_UV: i32 = 2_850_000;

/// And from this far below it is away from there.
const TOP_SLACK_UV: i32 = 50_000;

/// Readings in a row without a number after which a sensor is lost: 25 ms.
const MISSING_READINGS: u8 = 6;
/// Slow frames in which an envelope at the top may be a strong contraction: 1.5 s. Recordings have 0.35 s.
const TOP_FRAMES: u16 = 120;
/// An envelope stands still while it is within 1 % and this of where it stood, uV.
const STILL_UV: i32 = 1_500;
/// Slow frames of standing still that no working muscle has: 250 ms.
const FLAT_FRAMES: u16 = 20;
/// Slow frames of standing still from which a muscle does not veto the other: 200 ms.
const UNMODULATED_FRAMES: u16 = 16;
/// Slow frames without falling back by 3 % that no working muscle has: 1.2 s. Recordings have 0.64 s.
const CREEP_FRAMES: u16 = 96;
/// It creeps if it has climbed by one part in so many in the second half of that; if not, it stands still under its
/// ripple.
const CREEP_PART: i32 = 16;
/// Slow frames of activity without a pause that nobody keeps up: 30 s.
const ENDLESS_FRAMES: u16 = 2_400;
/// Slow frames far below the calibrated rest that are a contact lost: 4 s.
const SILENT_FRAMES: u16 = 320;
/// How far below, as a difference of levels: a factor of 4.
const SILENT_DEPTH: i32 = 2_048;
/// Slow frames over which the unrest of a weak envelope is judged: 3.2 s.
const UNREST_FRAMES: u16 = 256;
/// Of them, so many curve by more than a fifth of their level: a loose contact. Weak envelopes on record reach 29 %,
/// noise of 30 mV rms on 100 mV has 46 % and more.
const UNREST_MANY: u16 = UNREST_FRAMES * 2 / 5;
/// What a fifth is.
const UNREST_PART: i32 = 5;
/// An envelope below this is compared with this, uV: 15 mV of unrest moves nothing. The scenes' rest of 50 mV with 8 mV rms
/// curves by more than 10 mV in 4 of 10 slow frames.
const UNREST_LEAST_UV: i32 = 75_000;
/// What is weak: below this at all times, uV. A strong contraction that comes and goes curves as much.
const WEAK_UV: i32 = 300_000;
/// Good slow frames in a row after which a lost sensor is believed again: 1 s.
const BACK_FRAMES: u16 = 80;
/// An envelope that begins is judged after so many slow frames, when the step response of a front end has settled
/// (second order at 4 Hz: to 4 %): 225 ms.
const PROOF_FRAMES: u16 = 18;
/// Curving that proves a muscle, twice: one part in so many of its level, 8 %.
const PROOF_PART: i32 = 12;
/// Slow frames without curving below the top after which a contraction has to prove itself again: 0.4 s. Recordings curve
/// again within 225 ms.
const STRAIGHT_FRAMES: u8 = 32;
/// How far a proven contraction has stood out from the learned rest, as a difference of levels: a factor of 3.5. The crests
/// of a restless contact stay below.
const PROOF_RISE: i32 = 1_843;
/// Slow frames of inactivity after which a contraction must prove itself again: 100 ms. One that has not yet must do so
/// without a pause.
const FORGET_FRAMES: u8 = 8;
/// Slow frames from one point of the curve to the next: 50 ms.
const LAG: usize = 4;

/// What an envelope is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// A muscle's.
    #[default]
    Good,
    /// No contact: out of range, far below rest, or as restless as a loose electrode.
    LeadOff,
    /// It stands still and mains is in it.
    Hum,
    /// It climbs and climbs.
    Creep,
    /// It stands still.
    Flat,
    /// It has been active for longer than anybody keeps up.
    Endless,
    /// It stays at the top of its range.
    Saturated,
}

impl Quality {
    /// What reports call it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::LeadOff => "no contact",
            Self::Hum => "mains hum",
            Self::Creep => "creep",
            Self::Flat => "stands still",
            Self::Endless => "endless activity",
            Self::Saturated => "saturated",
        }
    }
}

impl core::fmt::Display for Quality {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name())
    }
}

/// What is expected of a channel: levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Expected {
    /// From here it is active.
    pub active: i32,
    /// Below here it is not active any more.
    pub inactive: i32,
    /// Rest, if it has been learned.
    pub rest: Option<i32>,
}

/// Watches one channel.
#[derive(Clone, Debug)]
pub struct Watch {
    lost: Option<Quality>,
    good: u16,
    missing: u8,
    /// Of the slow frame under way.
    sum_uv: i32,
    count: u8,
    /// Means of the last slow frames, in a ring.
    past_uv: [i32; 2 * LAG],
    place: u8,
    /// Where it stood when it last moved.
    anchor_uv: i32,
    flat: u16,
    /// Slow frames since it became active, 0 while it is not; and since it last was.
    active_for: u16,
    inactive_for: u8,
    tall: bool,
    proven: bool,
    /// Slow frames since it last curved, and since it first did without a longer while between.
    straight_for: u8,
    curved_for: u8,
    /// Slow frames since it last turned, the highest point since, and the point half way to a verdict.
    foot_uv: i32,
    crest_uv: i32,
    climbing: u16,
    turned: bool,
    at_top: u16,
    silent: u16,
    restless: u16,
    unrest_frames: u16,
    loose: bool,
    window: [i16; WINDOW],
    filled: u8,
    mains: bool,
}

impl Default for Watch {
    fn default() -> Self {
        Self {
            lost: None,
            good: 0,
            missing: 0,
            sum_uv: 0,
            count: 0,
            past_uv: [0; 2 * LAG],
            place: 0,
            anchor_uv: 0,
            flat: 0,
            active_for: 0,
            inactive_for: 0,
            tall: false,
            proven: false,
            straight_for: 0,
            curved_for: 0,
            foot_uv: 0,
            crest_uv: 0,
            climbing: 0,
            turned: false,
            at_top: 0,
            silent: 0,
            restless: 0,
            unrest_frames: 0,
            loose: false,
            window: [0; WINDOW],
            filled: 0,
            mains: false,
        }
    }
}

impl Watch {
    /// Takes a reading above the live zero, uV, none where the sensor gives no number.
    pub fn take(&mut self, expected: &Expected, uv: Option<i32>) {
        let Some(uv) = uv else {
            self.missing = self.missing.saturating_add(1);
            if self.missing >= MISSING_READINGS {
                self.lose(Quality::LeadOff);
            }
            return;
        };
        self.missing = 0;
        if self.count == 0 && usize::from(self.filled) < WINDOW {
            self.window[usize::from(self.filled)] = (uv / UNIT_UV).clamp(-32_768, 32_767) as i16;
            self.filled += 1;
        }
        self.sum_uv += uv;
        self.count += 1;
        if self.count == 3 {
            let mean_uv = self.sum_uv / 3;
            (self.sum_uv, self.count) = (0, 0);
            self.judge(expected, mean_uv);
        }
    }

    /// Takes the mean of a slow frame.
    fn judge(&mut self, expected: &Expected, uv: i32) {
        let level = level_of(uv);
        let (middle, far) = (self.before(LAG), self.before(2 * LAG));
        let curve_uv = (uv - 2 * middle + far).abs();
        if let Some(oldest) = self.past_uv.get_mut(usize::from(self.place)) {
            *oldest = uv;
        }
        self.place = (self.place + 1) % (2 * LAG) as u8;

        self.follow_activity(expected, level);
        let tall = expected.rest.is_none_or(|rest| level >= rest + PROOF_RISE);
        self.tall = self.active_for > 0 && (self.tall || tall);
        let curves = curve_uv > uv.max(1) / PROOF_PART && uv.max(middle).max(far) < TOP_UV;
        self.prove(curves);
        self.stand(uv);
        self.climb(uv);
        if uv >= TOP_UV {
            self.at_top = self.at_top.saturating_add(1);
        } else if uv < TOP_UV - TOP_SLACK_UV {
            self.at_top = 0;
        }
        let is_silent = expected.rest.is_some_and(|rest| level + SILENT_DEPTH < rest);
        self.silent = if is_silent { self.silent.saturating_add(1) } else { 0 };
        self.count_unrest(uv, curve_uv);

        let active = self.active_for > 0;
        let turnless = active && self.climbing >= CREEP_FRAMES;
        let creeps = turnless && self.crest_uv - self.foot_uv > self.foot_uv / CREEP_PART;
        let bad = if self.at_top >= TOP_FRAMES {
            Some(Quality::Saturated)
        } else if creeps {
            Some(Quality::Creep)
        } else if turnless || (active && self.flat >= FLAT_FRAMES) {
            Some(if self.mains { Quality::Hum } else { Quality::Flat })
        } else if self.active_for >= ENDLESS_FRAMES {
            Some(Quality::Endless)
        } else if self.loose || self.silent >= SILENT_FRAMES {
            Some(Quality::LeadOff)
        } else {
            None
        };
        match bad {
            Some(quality) => self.lose(quality),
            None => self.good = self.good.saturating_add(1),
        }
        // A fault may end in another: nothing is good again before a muscle has been seen at rest or at work.
        if self.good >= BACK_FRAMES && (!active || self.proven) {
            self.lost = None;
        }
    }

    fn lose(&mut self, quality: Quality) {
        self.good = 0;
        // The first reason stays, but a still envelope may later turn out to be mains.
        if self.lost.is_none() || (self.lost == Some(Quality::Flat) && quality == Quality::Hum) {
            self.lost = Some(quality);
        }
    }

    /// The mean of this many slow frames ago, 1 to 2 [`LAG`].
    fn before(&self, frames: usize) -> i32 {
        self.past_uv[(usize::from(self.place) + 2 * LAG - frames) % (2 * LAG)]
    }

    fn follow_activity(&mut self, expected: &Expected, level: i32) {
        let threshold = if self.active_for > 0 { expected.inactive } else { expected.active };
        if level >= threshold {
            self.active_for = self.active_for.saturating_add(1);
            self.inactive_for = 0;
        } else if self.active_for > 0 {
            self.inactive_for += 1;
            if !self.proven || self.inactive_for >= FORGET_FRAMES {
                (self.active_for, self.inactive_for, self.proven) = (0, 0, false);
            }
        }
    }

    /// A working muscle curves again and again. One jump from a fault to another curves only for as long as it takes from
    /// the first point of the curve to the last.
    fn prove(&mut self, curves: bool) {
        self.straight_for = if curves { 0 } else { self.straight_for.saturating_add(1) };
        if self.active_for < PROOF_FRAMES || !self.tall || self.straight_for >= STRAIGHT_FRAMES {
            (self.proven, self.curved_for) = (false, 0);
            return;
        }
        self.curved_for = self.curved_for.saturating_add(u8::from(curves || self.curved_for > 0));
        let again = usize::from(self.curved_for) > 2 * LAG + 1;
        self.proven |= curves && again;
    }

    fn stand(&mut self, uv: i32) {
        if (uv - self.anchor_uv).abs() > self.anchor_uv / 100 + STILL_UV {
            (self.anchor_uv, self.flat) = (uv, 0);
        } else if uv < TOP_UV {
            // At the top of its range a contraction stands still too.
            self.flat = self.flat.saturating_add(1);
        }
    }

    fn climb(&mut self, uv: i32) {
        self.turned = self.active_for > 0 && uv < self.crest_uv - self.crest_uv / 32 - STILL_UV;
        if self.active_for == 0 || uv >= TOP_UV || self.turned {
            (self.crest_uv, self.climbing) = (uv, 0);
        } else {
            if self.climbing <= CREEP_FRAMES / 2 {
                self.foot_uv = uv;
            }
            self.crest_uv = self.crest_uv.max(uv);
            self.climbing = self.climbing.saturating_add(1);
        }
    }

    fn count_unrest(&mut self, uv: i32, curve_uv: i32) {
        if uv > WEAK_UV {
            (self.restless, self.unrest_frames, self.loose) = (0, 0, false);
            return;
        }
        self.restless += u16::from(curve_uv > uv.max(UNREST_LEAST_UV) / UNREST_PART);
        self.unrest_frames += 1;
        if self.unrest_frames == UNREST_FRAMES {
            self.loose = self.restless >= UNREST_MANY;
            (self.restless, self.unrest_frames) = (0, 0);
        }
    }

    /// What it is.
    #[must_use]
    pub fn quality(&self) -> Quality {
        self.lost.unwrap_or_default()
    }

    /// Whether its readings may be used.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.lost.is_none()
    }

    /// Whether a contraction has curved as only a muscle does.
    #[must_use]
    pub const fn is_proven(&self) -> bool {
        self.proven
    }

    /// Whether it is at the top of its range, where no contraction curves.
    #[must_use]
    pub const fn is_clipped(&self) -> bool {
        self.at_top > 0
    }

    /// Whether it has just fallen back by 3 %, as no fault does that stands still or climbs.
    #[must_use]
    pub const fn has_turned(&self) -> bool {
        self.turned
    }

    /// Whether it stands still, whatever its level: no muscle at work, which would veto another.
    #[must_use]
    pub const fn is_unmodulated(&self) -> bool {
        self.flat >= UNMODULATED_FRAMES
    }

    /// A full window for [`mains_of`](super::mains::mains_of), until [`hear`](Self::hear) begins the next one.
    #[must_use]
    pub fn window(&self) -> Option<&[i16; WINDOW]> {
        (usize::from(self.filled) == WINDOW).then_some(&self.window)
    }

    /// Takes what the window said.
    pub const fn hear(&mut self, mains: Mains) {
        self.mains = mains.is_heard();
        self.filled = 0;
    }
}

#[cfg(test)]
mod tests;
