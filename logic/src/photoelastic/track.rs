//! Which of the two forces that one intensity can mean is the right one.
//!
//! The branch is known where only one is possible: in an open hand, where another sensor measures the force, and where the
//! motor closes or opens and the light follows. From there it is followed. A turn that ends clearly below the peak keeps the
//! branch. One that reaches the peak, as far as the peak is known, may have passed it: the branch that follows is a guess
//! ([`turn`](super::turn)) until it is known again, and is said to be one.
//!
//! The light of the source drifts, so the peak's level is learned whenever the force surely passed it, and the dark level
//! in an open hand.

use super::curve::{Curve, HALF_TURN, ONE, PEAK, phase_of};
use super::turn::{Branch, NEAREST, Turn};

/// What is known about the force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Track {
    /// Nothing, and why.
    Unknown(Why),
    /// The branch is known.
    Certain(Branch),
    /// The force may have passed the peak or turned there: this branch is the likelier one.
    Likely(Branch),
    /// At the end of the curve or beyond it.
    Saturated,
}

/// Why no force is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Why {
    /// No point has been passed yet that only one force can mean.
    #[default]
    Starting,
    /// No reading.
    NoReading,
    /// The light changed faster than it can be followed.
    TooFast,
    /// The force was beyond the curve's end and still rose.
    Beyond,
}

/// A force, and how far off it may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Force {
    /// The likeliest, mN.
    pub mn: i32,
    /// How far the true one may be from it, mN. Of a guess: as far as the other branch.
    pub uncertainty_mn: i32,
}

/// What else is known in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hints {
    /// The hand is surely open.
    pub unloaded: bool,
    /// What another sensor measures, mN.
    pub force_mn: Option<i32>,
    /// The motor: 1 closes, -1 opens.
    pub drive: i8,
}

/// Phase from which the peak is near: 0.35 rad.
const NEAR: i32 = 913;
/// So far the phase has to come back to have turned, 0.025 rad: more than noise.
const TURNED: i32 = 65;
/// More in a cycle cannot be followed: 0.6 rad.
const FAST: i32 = 1_565;
/// At the curve's end: 0.05 rad. And away from it again: 0.12 rad.
const END: i32 = 130;
const OFF_THE_END: i32 = 313;
/// Cycles without load after which a guess is taken to have been of the wrong branch: 3 s.
const DARK_FOR: u8 = 240;
/// A motor's way that shows in the phase: 0.2 rad.
const MOVED: i32 = 522;
/// Cycles after a drive in which the fingers may still move: 0.15 s.
const DRIVEN_FOR: u8 = 12;
/// How far the peak's level may be off before it was seen, and after, as a part of the span.
const BRIGHT_UNSEEN: i32 = ONE / 40;
const BRIGHT_SEEN: i32 = ONE / 250;
/// Noise and drift of a mean, as a part of the span: 0.2 %.
const NOISE: i32 = ONE / 500;
/// Table and delay at 6 N/s, mN.
const OFF_MN: i32 = 60;
/// Cycles in a row without a reading that are waited for.
const MISSED_MAX: u8 = 4;
/// Forces that another sensor can tell apart, mN.
const APART_MN: i32 = 600;

/// Follows one head.
#[derive(Clone, Debug, Default)]
pub struct Tracker {
    /// As calibrated, with today's levels.
    today: Option<Curve>,
    bright_off: i32,
    phase: Option<i32>,
    branch: Option<Branch>,
    certain: bool,
    why: Why,
    saturated: bool,
    part: i32,
    /// The highest phase and level since the peak is near, 0 while it is not.
    top: i32,
    top_q4: i32,
    /// The lowest phase since it turned.
    low: Option<i32>,
    turn: Turn,
    dark: u8,
    drive: i8,
    driven: u8,
    drive_from: Option<i32>,
    missed: u8,
    corrections: u32,
}

impl Tracker {
    /// Takes the mean of a cycle, in 1/16 of a sample, None where there is none.
    pub fn step(&mut self, calibrated: &Curve, level_q4: Option<i32>, hints: Hints) {
        let Some(level_q4) = level_q4 else {
            self.missed = self.missed.saturating_add(1);
            if self.missed > MISSED_MAX {
                self.lose(Why::NoReading);
                self.phase = None;
            }
            return;
        };
        self.missed = 0;
        let curve = self.renewed(calibrated, level_q4, hints.unloaded);
        self.part = curve.part(level_q4);
        let phase = phase_of(self.part);
        let before = self.phase.replace(phase).unwrap_or(phase);
        if hints.unloaded && phase < NEAR {
            self.know(Branch::Rising);
            (self.drive, self.driven, self.drive_from) = (0, 0, None);
            return;
        }
        if (phase - before).abs() > FAST {
            self.lose(Why::TooFast);
        }
        if let Some((branch, is_last)) = self.turn.step(&curve, before, phase)
            && !self.certain
        {
            let passed = self.branch.is_some_and(|now| now == branch);
            self.branch = Some(branch);
            if is_last && passed {
                self.see_peak(calibrated);
            }
        }
        self.peak(phase, level_q4, hints.drive, calibrated);
        self.end(phase);
        self.drive(phase, hints.drive);
        if let Some(mn) = hints.force_mn {
            self.told(&curve, phase, mn);
        }
    }

    /// The calibrated curve with today's levels.
    fn renewed(&mut self, calibrated: &Curve, level_q4: i32, unloaded: bool) -> Curve {
        let mut curve = match self.today {
            Some(today) if today.force_mn == calibrated.force_mn => today,
            _ => {
                self.bright_off = BRIGHT_UNSEEN;
                *calibrated
            }
        };
        let span = calibrated.bright_q4 - calibrated.dark_q4;
        // Nothing is brighter than the peak. Darker than no load is only what lies beyond the curve's end.
        if level_q4 > curve.bright_q4 {
            curve.bright_q4 = level_q4.min(calibrated.bright_q4 + span / 10);
        }
        if unloaded && (level_q4 - calibrated.dark_q4).abs() < span / 8 {
            let off = level_q4 - curve.dark_q4;
            curve.dark_q4 += (off + off.signum() * 15) / 16;
        }
        self.today = Some(curve);
        curve
    }

    fn lose(&mut self, why: Why) {
        self.branch = None;
        self.certain = false;
        self.saturated = false;
        self.why = why;
        self.turn.forget();
        (self.top, self.low, self.drive_from) = (0, None, None);
    }

    fn know(&mut self, branch: Branch) {
        self.corrections += u32::from(self.branch.is_some_and(|now| now != branch));
        self.branch = Some(branch);
        self.certain = true;
        self.saturated = false;
        self.dark = 0;
        self.turn.settle();
    }

    /// Learns the peak's level from the highest of the last visit.
    fn see_peak(&mut self, calibrated: &Curve) {
        let Some(today) = &mut self.today else {
            return;
        };
        let span = calibrated.bright_q4 - calibrated.dark_q4;
        today.bright_q4 =
            self.top_q4.min(calibrated.bright_q4 + span / 10).max(calibrated.bright_q4 - span / 10);
        self.bright_off = BRIGHT_SEEN;
    }

    /// Near the peak: whether the phase has turned, and whether it may have passed.
    fn peak(&mut self, phase: i32, level_q4: i32, drive: i8, calibrated: &Curve) {
        if phase < PEAK - NEAR {
            (self.top, self.low) = (0, None);
            return;
        }
        if let Some(low) = &mut self.low {
            *low = phase.min(*low);
            if phase - *low <= TURNED {
                return;
            }
            // Up again: another visit. What the last one was stays as it was guessed.
            self.turn.again();
            (self.low, self.top) = (None, 0);
        }
        if phase > self.top {
            (self.top, self.top_q4) = (phase, level_q4);
        }
        if self.top - phase <= TURNED {
            return;
        }
        self.low = Some(phase);
        let Some(from) = self.branch else {
            return;
        };
        // 1 - cos^2: the part that is missing to the peak.
        let missed = i64::from(PEAK - self.top);
        let may_be_off = i64::from(self.bright_off + NOISE);
        // Phase to rad: pi / 8192; its square as a part of ONE: (pi / 8192)^2 2^20 = 0.1542.
        if missed * missed * 1_542 / 10_000 > may_be_off {
            return;
        }
        let pushed = matches!((drive, from), (1, Branch::Rising) | (-1, Branch::Falling));
        if pushed && self.certain {
            self.branch = Some(from.other());
            self.see_peak(calibrated);
            return;
        }
        self.certain = false;
        // Most likely it turned, but the peak may be that much lower today.
        if missed > i64::from(NEAREST) && self.bright_off == BRIGHT_SEEN {
            return;
        }
        self.branch = Some(from.other());
        self.turn.visit(from);
    }

    /// At the ends of the curve.
    fn end(&mut self, phase: i32) {
        self.dark = if phase < END { self.dark.saturating_add(1) } else { 0 };
        if self.branch != Some(Branch::Falling) {
            return;
        }
        if phase < END {
            self.saturated = true;
        } else if self.saturated && phase > OFF_THE_END {
            self.saturated = false;
            self.certain = false;
            if self.drive > 0 {
                self.lose(Why::Beyond);
            }
        }
        if !self.certain && self.dark >= DARK_FOR {
            self.corrections += 1;
            self.branch = Some(Branch::Rising);
            self.saturated = false;
        }
    }

    /// The motor closes, and the light shows on which branch, or opens.
    fn drive(&mut self, phase: i32, drive: i8) {
        self.driven = if drive != 0 { DRIVEN_FOR } else { self.driven.saturating_sub(1) };
        if self.driven == 0 || (drive != 0 && drive != self.drive) || phase > PEAK - NEAR {
            self.drive_from = None;
        }
        if drive != 0 {
            self.drive = drive;
        }
        if self.driven == 0 {
            self.drive = 0;
            return;
        }
        if phase > PEAK - NEAR {
            return;
        }
        let from = *self.drive_from.get_or_insert(phase);
        if (phase - from).abs() > MOVED {
            self.drive_from = Some(phase);
            let brighter = phase > from;
            self.know(if brighter == (self.drive > 0) { Branch::Rising } else { Branch::Falling });
        }
    }

    /// Another sensor measures this.
    fn told(&mut self, curve: &Curve, phase: i32, mn: i32) {
        let [rising, falling] =
            [Branch::Rising, Branch::Falling].map(|branch| curve.force_mn(branch.whole(phase)));
        if mn > curve.force_mn(HALF_TURN) + APART_MN {
            self.lose(Why::Beyond);
        } else if falling - rising > APART_MN {
            let nearer = (mn - rising).abs() < (falling - mn).abs();
            self.know(if nearer { Branch::Rising } else { Branch::Falling });
        }
    }

    /// What is known about the force.
    #[must_use]
    pub const fn track(&self) -> Track {
        match self.branch {
            None => Track::Unknown(self.why),
            Some(_) if self.saturated => Track::Saturated,
            Some(branch) if self.certain => Track::Certain(branch),
            Some(branch) => Track::Likely(branch),
        }
    }

    /// The force, None while none is known. Of a head that is saturated it is the least.
    #[must_use]
    pub fn force(&self) -> Option<Force> {
        let (curve, branch, phase) = (self.today.as_ref()?, self.branch?, self.phase?);
        let at = |phase: i32| curve.force_mn(branch.whole(phase));
        let mn = at(phase);
        let off = NOISE + (i64::from(self.bright_off) * i64::from(self.part.max(0)) / i64::from(ONE)) as i32;
        let [low, high] = [self.part - off, self.part + off].map(phase_of);
        // Where the band reaches the peak, it goes on on the other side.
        let over = if self.part + off > ONE { PEAK - phase_of(2 * ONE - self.part - off) } else { 0 };
        let beyond = curve.force_mn(branch.other().whole(PEAK - over.max(0)));
        let beyond = if over > 0 { (beyond - mn).abs() } else { 0 };
        let mut uncertainty_mn = (at(low) - mn).abs().max((at(high) - mn).abs()).max(beyond) + OFF_MN;
        if !self.certain {
            for phase in [low, high] {
                let other_mn = curve.force_mn(branch.other().whole(phase));
                uncertainty_mn = uncertainty_mn.max((other_mn - mn).abs() + OFF_MN);
            }
        }
        if self.saturated {
            uncertainty_mn = uncertainty_mn.max(curve.force_mn(HALF_TURN) / 3);
        }
        Some(Force { mn, uncertainty_mn })
    }

    /// How often the branch was found to be the other one.
    #[must_use]
    pub const fn corrections(&self) -> u32 {
        self.corrections
    }
}

#[cfg(test)]
mod tests;
