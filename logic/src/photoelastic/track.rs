//! Range of forces that fits the light for any shear. With a shear of q times the force and `s^2 = 1 + 4 q^2`
//! the light is `sin^2(s phase) / s^2` of the peak's (Dubey 2006, equations 6 to 9), q at most
//! [`SHEAR_MAX_PERMILLE`]. While the light stays below [`FOLD`] the branch is still the same; after brighter
//! light the range is that of both. The branch is known again in an open hand, or by another sensor.

use super::curve::{Curve, HALF_TURN, ONE, phase_of};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    Rising,
    Falling,
}

impl Branch {
    pub const fn whole(self, phase: i32) -> i32 {
        match self {
            Self::Rising => phase,
            Self::Falling => HALF_TURN - phase,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Track {
    Unknown,
    Certain(Branch),
    Either,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Force {
    pub least_mn: i32,
    pub most_mn: i32,
}

impl Force {
    pub const fn mn(&self) -> i32 {
        (self.least_mn + self.most_mn) / 2
    }

    pub const fn uncertainty_mn(&self) -> i32 {
        self.most_mn - self.mn()
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hints {
    pub unloaded: bool,
    pub force_mn: Option<i32>,
}

/// Largest shear, of the force: friction on the strip, with room (`docs/photoelastic.md`).
pub const SHEAR_MAX_PERMILLE: i32 = 500;
const STRETCH_SQUARED: i32 = 1 + 4 * SHEAR_MAX_PERMILLE * SHEAR_MAX_PERMILLE / 1_000_000;
const STRETCH_Q10: i32 = 1_448;
/// Part of the span below which the light cannot have reached the fold: 1 / s^2, less drift and noise.
pub const FOLD: i32 = ONE / STRETCH_SQUARED - ONE / 25;
/// Error of the peak's level, as a part of the span: the source drifts by 2 % and on.
const BRIGHT_OFF: i32 = ONE / 40;
const NOISE: i32 = ONE / 250;
/// Table, frozen birefringence and delay at 6 N/s, mN.
const OFF_MN: i32 = 60;
/// Part of the span below which there is no load, or a force at the curve's end.
const DARK: i32 = ONE / 50;
const MISSED_MAX: u8 = 4;
const APART_MN: i32 = 600;

#[derive(Clone, Debug, Default)]
pub struct Tracker {
    today: Option<Curve>,
    part: Option<i32>,
    known: Option<Branch>,
    ended: bool,
    missed: u8,
}

impl Tracker {
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

    fn renewed(&mut self, calibrated: &Curve, level_q4: i32, unloaded: bool) -> Curve {
        let mut curve = match self.today {
            Some(today) if today.force_mn == calibrated.force_mn => today,
            _ => *calibrated,
        };
        let span = calibrated.bright_q4 - calibrated.dark_q4;
        // No light is above the peak's, and none below the dark level before the curve's end.
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

    pub const fn track(&self) -> Track {
        match (self.part, self.known) {
            (None, _) => Track::Unknown,
            (_, Some(branch)) => Track::Certain(branch),
            (_, None) => Track::Either,
        }
    }

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

/// Least and largest force on a branch that explain the light with any shear, mN.
fn range(curve: &Curve, branch: Branch, part: i32) -> (i32, i32) {
    let off = NOISE + (i64::from(BRIGHT_OFF) * i64::from(part.max(0)) / i64::from(ONE)) as i32;
    let (low, high) = (part - off, part + off);
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
