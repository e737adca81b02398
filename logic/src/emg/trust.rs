//! Whether a myosensor's envelope is one of a muscle: whether it is doubted, and whether a contraction is proven.
//!
//! Each doubt has a time that no sound recording reaches (`docs/emg.md`). A doubt takes an electrode's weight; it vetoes nothing
//! of the other one. Proof is what no single fault does: the envelope turns or curves again and again; that the other electrode
//! hears it too is asked for in [`decide`](super::decide).

use super::mains::{Mains, UNIT_UV, WINDOW};

/// Top of an envelope's range, uV above the live zero: 3.15 V at the pin.
pub const TOP_UV: i32 = 2_850_000;
/// Readings without a number that are bridged: 50 ms.
const BRIDGED_READINGS: u8 = 12;
/// An envelope stands still while it is within 1 % and this of where it stood, uV.
const STILL_UV: i32 = 1_500;
/// Slow frames of standing still that no sound recording has: 1 s, of 0.77 s in 45 minutes of contractions.
const FLAT_FRAMES: u16 = 80;
/// Hum varies by less than this part of its level, 1/16.
const HUM_PART: i32 = 16;
/// Slow frames of rise without a fall of 3 % that no sound recording has: 2.5 s. The longest in those 45 minutes is 2 s.
const CREEP_FRAMES: u16 = 200;
/// Slow frames at the top of the range that no sound recording has: 1.5 s. Recordings have 0.35 s.
const TOP_FRAMES: u16 = 120;
/// Slow frames of activity without a pause that no muscle has: 60 s. One person has tone for more than 30 s.
const ENDLESS_FRAMES: u16 = 4_800;
/// Good slow frames after which an electrode is believed again: 1 s.
const BACK_FRAMES: u16 = 80;
/// Slow frames between the points of a curve, 50 ms, and before its first one counts.
const LAG: usize = 4;
const FIRST_PROOF_FRAMES: u16 = 20;
/// The part of its level by which a proof curves, and slow frames between two proofs: 0.15 s, more than one jump takes. Two
/// make a muscle.
const PROOF_PART: i32 = 12;
const PROOF_APART: u16 = 12;
/// Slow frames without a proof after which a contraction has to prove itself again: 1 s.
const PROOF_LASTS: u16 = 80;

/// Quality of a myosensor's envelope: a muscle's signal, or a kind of fault.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// A muscle's signal.
    #[default]
    Good,
    /// No contact: out of range, or as restless as a loose electrode.
    LeadOff,
    /// Constant, with mains in its spectrum.
    Hum,
    /// Rises without falling back.
    Creep,
    /// Constant within 1 %.
    Flat,
    /// Active for longer than a muscle can be.
    Endless,
    /// At the top of the range.
    Saturated,
}

impl Quality {
    /// Name in reports.
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

/// Watches one electrode.
#[derive(Clone, Debug)]
pub struct Trust {
    quality: Quality,
    good: u16,
    /// Readings in a row without a number, and the last one with it, uV.
    missing: u8,
    last_uv: i32,
    /// Means of the last slow frames, in a ring.
    past_uv: [i32; 2 * LAG],
    place: u8,
    anchor_uv: i32,
    flat: u16,
    /// Where it stood when it last had for as long as no muscle does.
    hum_uv: i32,
    active_for: u16,
    foot_uv: i32,
    crest_uv: i32,
    climbing: u16,
    at_top: u16,
    /// Proofs of this contraction, two at most, and slow frames since the last.
    proofs: u8,
    since_proof: u16,
    window: [i16; WINDOW],
    filled: u8,
    /// Whether the window has a reading of this slow frame.
    kept: bool,
    mains: bool,
}

impl Default for Trust {
    /// Nothing is known yet.
    fn default() -> Self {
        Self {
            quality: Quality::Good,
            good: 0,
            missing: 0,
            last_uv: 0,
            past_uv: [0; 2 * LAG],
            place: 0,
            anchor_uv: 0,
            flat: 0,
            hum_uv: 0,
            active_for: 0,
            foot_uv: 0,
            crest_uv: 0,
            climbing: 0,
            at_top: 0,
            proofs: 0,
            since_proof: 0,
            window: [0; WINDOW],
            filled: 0,
            kept: false,
            mains: false,
        }
    }
}

impl Trust {
    /// Takes a reading above the live zero, uV, None where the sensor gives no number. Returns the reading; in a gap of up to 50 ms,
    /// the last one before it.
    pub fn take(&mut self, uv: Option<i32>) -> Option<i32> {
        let Some(uv) = uv else {
            self.missing = self.missing.saturating_add(1);
            if self.missing > BRIDGED_READINGS {
                (self.proofs, self.hum_uv) = (0, 0);
                self.lose(Quality::LeadOff);
            }
            return self.last_uv();
        };
        (self.missing, self.last_uv) = (0, uv);
        if !self.kept && usize::from(self.filled) < WINDOW {
            self.window[usize::from(self.filled)] = (uv / UNIT_UV).clamp(-32_768, 32_767) as i16;
            self.filled += 1;
            self.kept = true;
        }
        Some(uv)
    }

    /// The last reading, bridged, uV.
    pub fn last_uv(&self) -> Option<i32> {
        (self.missing <= BRIDGED_READINGS).then_some(self.last_uv)
    }

    /// Takes the mean of a slow frame, uV; `active_uv` is the envelope from which the muscle is active.
    pub fn judge(&mut self, active_uv: i32, uv: i32) {
        self.kept = false;
        let place = usize::from(self.place) % (2 * LAG);
        let (middle, far) = (self.past_uv[(place + LAG) % (2 * LAG)], self.past_uv[place]);
        let curve_uv = (uv - 2 * middle + far).abs();
        self.past_uv[place] = uv;
        self.place = place as u8 + 1;

        let is_active = uv >= active_uv;
        self.active_for = if is_active { self.active_for.saturating_add(1) } else { 0 };
        let is_top = uv >= TOP_UV;
        self.at_top = if is_top { self.at_top.saturating_add(1) } else { 0 };
        self.stand(uv);
        let turned = self.climb(uv);
        let curves = curve_uv > uv.max(1) / PROOF_PART && !is_top && uv.max(middle).max(far) < TOP_UV;
        // A muscle does not let go of half in 50 ms: what does has come off, or back on, and proves nothing.
        self.prove((turned || curves) && uv >= middle / 2);

        let constant = if self.mains { Quality::Hum } else { Quality::Flat };
        let quality = if self.at_top >= TOP_FRAMES {
            Quality::Saturated
        } else if !is_active {
            Quality::Good
        } else if self.flat >= FLAT_FRAMES {
            constant
        } else if self.climbing >= CREEP_FRAMES {
            let creeps = self.crest_uv - self.foot_uv > self.foot_uv / 16;
            if creeps { Quality::Creep } else { constant }
        } else if self.active_for >= ENDLESS_FRAMES {
            Quality::Endless
        } else {
            Quality::Good
        };
        match quality {
            Quality::Good => self.good = self.good.saturating_add(1),
            bad => self.lose(bad),
        }
        // A fault may end in another: nothing is good again before a muscle has been seen at rest or at work.
        if self.good >= BACK_FRAMES && (!is_active || self.has_turned_twice()) {
            self.quality = Quality::Good;
        }
    }

    fn lose(&mut self, quality: Quality) {
        self.good = 0;
        // The first reason stays, but a still envelope may later turn out to be mains.
        if self.is_good() || (self.quality == Quality::Flat && quality == Quality::Hum) {
            self.quality = quality;
        }
    }

    /// A working muscle turns again and again. One jump from a fault to another does so once.
    fn prove(&mut self, turns: bool) {
        self.since_proof = self.since_proof.saturating_add(1);
        if self.active_for < FIRST_PROOF_FRAMES || self.since_proof > PROOF_LASTS {
            self.proofs = 0;
        }
        if turns
            && self.active_for >= FIRST_PROOF_FRAMES
            && (self.proofs == 0 || self.since_proof >= PROOF_APART)
        {
            self.proofs = (self.proofs + 1).min(2);
            self.since_proof = 0;
        }
    }

    fn stand(&mut self, uv: i32) {
        if (uv - self.anchor_uv).abs() > self.anchor_uv / 100 + STILL_UV {
            (self.anchor_uv, self.flat) = (uv, 0);
        } else if uv < TOP_UV {
            // At the top of its range a contraction stands still too.
            self.flat = self.flat.saturating_add(1);
        }
        if self.flat >= FLAT_FRAMES {
            self.hum_uv = self.anchor_uv;
        } else if (uv - self.hum_uv).abs() > self.hum_uv / HUM_PART + STILL_UV {
            // What comes back there may be a muscle, until it stands still again.
            self.hum_uv = 0;
        }
    }

    /// Whether it has just fallen back by 3 %.
    fn climb(&mut self, uv: i32) -> bool {
        let turned = self.active_for > 0 && uv < self.crest_uv - self.crest_uv / 32 - STILL_UV;
        if self.active_for == 0 || uv >= TOP_UV || turned {
            (self.crest_uv, self.climbing) = (uv, 0);
        } else {
            if self.climbing <= CREEP_FRAMES / 2 {
                self.foot_uv = uv;
            }
            self.crest_uv = self.crest_uv.max(uv);
            self.climbing = self.climbing.saturating_add(1);
        }
        turned
    }

    /// Returns the quality of the envelope.
    pub const fn quality(&self) -> Quality {
        self.quality
    }

    /// Whether the envelope is taken for a muscle's.
    pub const fn is_good(&self) -> bool {
        matches!(self.quality, Quality::Good)
    }

    /// Whether the envelope has been constant for 0.2 s.
    pub const fn is_still(&self) -> bool {
        self.flat >= FLAT_FRAMES / 5
    }

    /// Whether the electrode is doubted because its envelope is constant: its level then counts as hum.
    pub fn hums(&self) -> bool {
        matches!(self.quality, Quality::Flat | Quality::Hum) && self.flat >= FLAT_FRAMES
    }

    /// Whether this reading, uV, is still at the constant level for which the electrode is doubted. An active muscle would
    /// change it.
    #[must_use]
    pub fn hums_at(&self, uv: i32) -> bool {
        matches!(self.quality, Quality::Flat | Quality::Hum)
            && (uv - self.hum_uv).abs() <= self.hum_uv / HUM_PART + STILL_UV
    }

    /// Whether the present contraction has one proof of the last second: its envelope fell back by 3 % or curved, as a
    /// muscle's does.
    pub const fn has_turned(&self) -> bool {
        self.proofs >= 1
    }

    /// Whether the present contraction has two such proofs, at least 0.15 s apart: one jump from a fault to another
    /// gives only one.
    pub const fn has_turned_twice(&self) -> bool {
        self.proofs >= 2
    }

    /// Whether the envelope may still be a muscle's: not doubted, nor at the top of its range for 0.5 s, nor standing
    /// still for 0.6 s.
    pub const fn is_sound(&self) -> bool {
        self.is_good() && self.at_top < TOP_FRAMES / 3 && self.flat < 3 * FLAT_FRAMES / 5
    }

    /// Whether the active envelope has neither fallen back by 3 % nor given a proof for 1 s.
    pub const fn is_straight(&self) -> bool {
        self.climbing >= PROOF_LASTS && self.since_proof >= PROOF_LASTS
    }

    /// Returns the window, the input of [`mains_of`](super::mains::mains_of): 64 readings, one a slow frame, the oldest
    /// first, 128 uV a unit. None until it is full; then it stays until [`hear`](Self::hear).
    pub fn window(&self) -> Option<&[i16; WINDOW]> {
        (usize::from(self.filled) == WINDOW).then_some(&self.window)
    }

    /// Takes the result of the window and begins the next one.
    pub const fn hear(&mut self, mains: Mains) {
        self.mains = mains.is_heard();
        self.filled = 0;
    }
}

#[cfg(test)]
mod tests;
