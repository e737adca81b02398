//! The range of forces that fits the light for any shear.
//!
//! Shear turns the stress and makes it larger: with a shear of q times the force and `s^2 = 1 + 4 q^2` the light is
//! `sin^2(s phase) / s^2` of the peak's (Dubey 2006, equations 6 to 9). So the light folds where `s phase` is a quarter turn, at `1 / s^2` of
//! the peak's light, and q is known to be [`SHEAR_MAX_PERMILLE`] at most. Two things follow, whatever the shear does meanwhile:
//!
//! - As long as the light has stayed below [`FOLD`] the fold was not reached: the branch is still the one that it was, and the force
//!   lies between the two that no shear and the most shear give.
//! - Once the light was brighter, the force may have passed the fold or not, and no light tells which: it is between the least force
//!   that explains the light (without shear, below the fold) and the most (without shear, above it).
//!
//! The branch is known again in an open hand, or where another sensor's force agrees with one branch only. The dark level is
//! learned in an open hand; the peak's may be off by what the source drifts, for shear takes light away, too.

use super::curve::{Curve, HALF_TURN, ONE, phase_of};

/// Which branch of the curve the force is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// Below the peak: more force, more light.
    Rising,
    /// Above it: more force, less light.
    Falling,
}

impl Branch {
    /// The phase over the whole curve that this one of the rising branch stands for.
    #[must_use]
    pub const fn whole(self, phase: i32) -> i32 {
        match self {
            Self::Rising => phase,
            Self::Falling => HALF_TURN - phase,
        }
    }
}

/// Knowledge of the force's branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Track {
    /// No reading.
    Unknown,
    /// The branch is known.
    Certain(Branch),
    /// The force is on either branch.
    Either,
}

/// The range of forces that fits the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Force {
    /// The least force that fits the light with any shear, mN.
    pub least_mn: i32,
    /// The largest force that fits the light with any shear, mN.
    pub most_mn: i32,
}

impl Force {
    /// Middle of the range from least to most, mN.
    pub const fn mn(&self) -> i32 {
        (self.least_mn + self.most_mn) / 2
    }

    /// Half the width of that range, mN: the true force is within [`mn`](Self::mn) +- this.
    pub const fn uncertainty_mn(&self) -> i32 {
        self.most_mn - self.mn()
    }
}

/// Readings of other sensors in a slow frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hints {
    /// The hand is surely open.
    pub unloaded: bool,
    /// Load by the force sensor, mN. None: it gives no number.
    pub force_mn: Option<i32>,
}

/// The most shear that an object can have, of the force: friction on the strip, with room (`docs/photoelastic.md`).
pub const SHEAR_MAX_PERMILLE: i32 = 500;
/// `s^2` and `s` at that shear; the second in 1/1024.
const STRETCH_SQUARED: i32 = 1 + 4 * SHEAR_MAX_PERMILLE * SHEAR_MAX_PERMILLE / 1_000_000;
const STRETCH_Q10: i32 = 1_448;
/// Part of the span below which the light cannot have reached the fold with any shear: 1 / s^2, less drift and noise.
pub const FOLD: i32 = ONE / STRETCH_SQUARED - ONE / 25;
/// How far the peak's level may be off, as a part of the span: the source drifts by 2 % and on.
const BRIGHT_OFF: i32 = ONE / 40;
/// Noise of a mean and drift of the dark level, as a part of the span: 0.4 %.
const NOISE: i32 = ONE / 250;
/// Table, frozen birefringence and delay at 6 N/s, mN.
const OFF_MN: i32 = 60;
/// Part of the span below which there is no load, or a force at the curve's end.
const DARK: i32 = ONE / 50;
/// Consecutive slow frames without a reading before the force is unknown.
const MISSED_MAX: u8 = 4;
/// Forces that another sensor can tell apart, mN.
const APART_MN: i32 = 600;

/// Follows one head.
#[derive(Clone, Debug, Default)]
pub struct Tracker {
    /// The calibrated curve with today's levels.
    today: Option<Curve>,
    /// The light as a part of the span, None while there is no reading.
    part: Option<i32>,
    /// The branch, if it is known.
    known: Option<Branch>,
    /// Whether the force may have passed the curve's end since the branch was known.
    ended: bool,
    missed: u8,
}

impl Tracker {
    /// Takes the mean of a cycle, in 1/16 of a sample, None where there is none.
    pub fn step(&mut self, calibrated: &Curve, level_q4: Option<i32>, hints: Hints) {
        let Some(level_q4) = level_q4 else {
            self.missed = self.missed.saturating_add(1);
            if self.missed > MISSED_MAX {
                *self = Self { today: self.today, missed: self.missed, ended: true, ..Self::default() };
            }
            return;
        };
        self.missed = 0;
        let curve = self.renewed(calibrated, level_q4, hints.unloaded);
        let part = curve.part(level_q4);
        let before = self.part.replace(part);
        if hints.unloaded && part < FOLD {
            (self.known, self.ended) = (Some(Branch::Rising), false);
            return;
        }
        // As bright as a fold can be, or so fast that it may have been meanwhile.
        let jumped = before.map_or(ONE, |before| (part - before).abs());
        if part + jumped >= FOLD {
            self.known = None;
        }
        if part < DARK && self.known != Some(Branch::Rising) {
            (self.known, self.ended) = (None, true);
        }
        if let Some(mn) = hints.force_mn {
            self.compare(&curve, mn);
        }
    }

    /// The calibrated curve with today's levels.
    fn renewed(&mut self, calibrated: &Curve, level_q4: i32, unloaded: bool) -> Curve {
        let mut curve = match self.today {
            Some(today) if today.force_mn == calibrated.force_mn => today,
            _ => *calibrated,
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

    /// Another sensor measures this: the branch is known where only one explains it.
    fn compare(&mut self, curve: &Curve, mn: i32) {
        let Some(part) = self.part.filter(|part| part + ONE / 10 < FOLD) else { return };
        let [rising, falling] = [Branch::Rising, Branch::Falling].map(|branch| range(curve, branch, part));
        let agrees = |(least, most): (i32, i32)| mn > least - APART_MN / 2 && mn < most + APART_MN / 2;
        match (agrees(rising), agrees(falling)) {
            (true, false) => (self.known, self.ended) = (Some(Branch::Rising), false),
            (false, true) if part >= DARK => (self.known, self.ended) = (Some(Branch::Falling), false),
            (false, false) => (self.known, self.ended) = (None, true),
            _ => {}
        }
    }

    /// What is known about the force.
    pub const fn track(&self) -> Track {
        match (self.part, self.known) {
            (None, _) => Track::Unknown,
            (_, Some(branch)) => Track::Certain(branch),
            (_, None) => Track::Either,
        }
    }

    /// The force, None without a reading.
    pub fn force(&self) -> Option<Force> {
        let (curve, part) = (self.today.as_ref()?, self.part?);
        let of = |branch| range(curve, branch, part);
        let (least_mn, most_mn) = match self.known {
            Some(branch) => of(branch),
            None if self.ended => (of(Branch::Rising).0, curve.force_mn(HALF_TURN) + OFF_MN),
            None => (of(Branch::Rising).0, of(Branch::Falling).1),
        };
        Some(Force { least_mn, most_mn })
    }
}

/// The least and the most force on a branch that explain the light, whatever the shear, mN.
fn range(curve: &Curve, branch: Branch, part: i32) -> (i32, i32) {
    let off = NOISE + (i64::from(BRIGHT_OFF) * i64::from(part.max(0)) / i64::from(ONE)) as i32;
    let (low, high) = (part - off, part + off);
    // With the most shear the light means this phase, as far as it is there at all.
    let sheared = |part: i32| {
        (branch.whole(phase_of(STRETCH_SQUARED * part.clamp(0, ONE / STRETCH_SQUARED))) << 10) / STRETCH_Q10
    };
    let plain = |part: i32| branch.whole(phase_of(part));
    let (least, most) = match branch {
        Branch::Rising => (plain(low), sheared(high)),
        Branch::Falling => (sheared(high), plain(low)),
    };
    ((curve.force_mn(least) - OFF_MN).max(0), curve.force_mn(most) + OFF_MN)
}

#[cfg(test)]
mod tests;
