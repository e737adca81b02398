//! The peak of the curve has two ways out. Which one the force took is guessed from how fast it goes down again.
//!
//! Just before and just after the peak the phase of a force that passes goes at one speed; a change of speed in that very
//! moment is a turn. A force that turns and comes back at its own speed looks the same there, but further out it takes as
//! long from level to level as it did on the way in, and one that passed takes longer or shorter, as the curve is flatter
//! above the peak: how much is known from the curve. So a pass at an even speed tells where it came from, too, and mends an
//! earlier wrong guess. It is a guess all the same, not a proof: a hand may do anything. So what follows
//! from it is never certain.

use super::curve::{Curve, HALF_TURN, PEAK};

/// Distances from the peak at which time is taken, phase: 0.06, 0.15, 0.25, 0.35, 0.45 and 0.6 rad.
const LEVELS: [i32; 6] = [156, 391, 652, 913, 1_173, 1_565];
/// The nearest of them: what has turned before it did not reach the peak.
pub const NEAREST: i32 = LEVELS[0];

/// Which branch of the curve the force is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// Below the peak: more force, more light.
    Rising,
    /// Above it: more force, less light.
    Falling,
}

impl Branch {
    /// The other one.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Rising => Self::Falling,
            Self::Falling => Self::Rising,
        }
    }

    /// The phase over the whole curve that this one of the rising branch stands for.
    #[must_use]
    pub const fn whole(self, phase: i32) -> i32 {
        match self {
            Self::Rising => phase,
            Self::Falling => HALF_TURN - phase,
        }
    }
}

/// Instants in 1/16 of a cycle at which each level was passed towards the peak, None where that is not known.
type Times = [Option<u32>; LEVELS.len()];

/// A visit to the peak that may have ended on either side.
#[derive(Clone, Copy, Debug)]
struct Visit {
    from: Branch,
    towards: Times,
    /// When the nearest level was passed outwards.
    left_at: Option<u32>,
}

/// Takes the times, and judges visits.
#[derive(Clone, Debug, Default)]
pub struct Turn {
    now: u32,
    towards: Times,
    visit: Option<Visit>,
}

impl Turn {
    /// The force may have turned or passed, coming from this branch.
    pub const fn visit(&mut self, from: Branch) {
        self.visit = Some(Visit { from, towards: self.towards, left_at: None });
    }

    /// Whatever was open is settled by other means.
    pub const fn settle(&mut self) {
        self.visit = None;
    }

    /// It has turned on the way out: another visit begins, of which no time is known yet.
    pub fn again(&mut self) {
        self.visit = None;
        self.towards = Times::default();
    }

    /// All times are forgotten: readings are missing.
    pub fn forget(&mut self) {
        *self = Self { now: self.now, ..Self::default() };
    }

    /// Whether a visit is still open.
    #[must_use]
    pub const fn is_open(&self) -> bool {
        self.visit.is_some()
    }

    /// Goes on by one cycle, from one phase to another. A judgement, if there is one: the branch that the force is on more
    /// likely, and whether it is the last of this visit.
    pub fn step(&mut self, curve: &Curve, before: i32, phase: i32) -> Option<(Branch, bool)> {
        self.now = self.now.wrapping_add(16);
        let mut judged = None;
        // Towards the peak the furthest level comes first, outwards the nearest.
        for (n, level) in LEVELS.iter().map(|distance| PEAK - distance).enumerate() {
            let at = |span: i32, part: i32| self.now.wrapping_sub((16 * part / span.max(1)).unsigned_abs());
            if before < level && phase >= level {
                self.towards[n] = Some(at(phase - before, phase - level));
            } else if before >= level && phase < level {
                judged = self.outwards(curve, n, at(before - phase, level - phase)).or(judged);
                self.towards[n] = None;
            }
        }
        judged
    }

    fn outwards(&mut self, curve: &Curve, n: usize, at: u32) -> Option<(Branch, bool)> {
        let visit = self.visit.as_mut()?;
        if n == 0 {
            visit.left_at = Some(at);
            return None;
        }
        let Visit { from, towards, left_at } = *visit;
        let (in_first, in_last, out_first) = ((*towards.get(n)?)?, towards[0]?, left_at?);
        let level = *LEVELS.get(n)?;
        let inwards = i64::from(in_last.wrapping_sub(in_first).min(LONGEST));
        let outwards = i64::from(at.wrapping_sub(out_first).min(LONGEST));
        let way = |branch: Branch| {
            let at = |distance: i32| curve.force_mn(branch.whole(PEAK - distance));
            i64::from((at(LEVELS[0]) - at(level)).abs())
        };
        let is_last = n + 1 == LEVELS.len();
        if is_last {
            self.visit = None;
        }
        if n == 1 {
            // An even speed, whatever the branch?
            let even = 10 * outwards < 13 * inwards && 10 * inwards < 13 * outwards;
            if !even {
                self.visit = None;
            }
            return Some((if even { from.other() } else { from }, false));
        }
        // Outwards is to inwards as the ways on the two branches, if it passed at an even speed; whatever branch it was thought
        // to come from.
        let (rising, falling) = (way(Branch::Rising), way(Branch::Falling));
        let like = |took: i64, expected: i64| took.max(expected) * 100 / took.min(expected).max(1);
        let candidates = [
            (like(outwards * rising, inwards * falling), Branch::Falling),
            (like(outwards * falling, inwards * rising), Branch::Rising),
            (like(outwards, inwards), from),
        ];
        let (off, branch) = candidates.into_iter().min_by_key(|(off, _)| *off)?;
        if off > 115 {
            // The speed has changed since: no more can be told.
            self.visit = None;
            return None;
        }
        Some((branch, is_last))
    }
}

/// Visits of hours mean nothing: 1/16 of a cycle, 50 s.
const LONGEST: u32 = 1 << 16;
