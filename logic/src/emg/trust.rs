//! Quality of a myosensor's envelope, and the turns that only a muscle makes. Each fault has a duration that
//! no sound recording reaches (`docs/emg.md`). A doubted electrode vetoes nothing of the other one.

use heapless::Vec;

use super::decide::Part;
use super::mains::{Mains, UNIT_UV, WINDOW};

/// Top of an envelope's range, uV above the live zero: 3.15 V at the pin.
pub const TOP_UV: i32 = 2_850_000;
/// Readings without a number that are bridged: 50 ms.
const BRIDGED_READINGS: u8 = 12;
/// Constant: within 1 % and this, uV.
const STILL_UV: i32 = 1_500;
/// Slow frames of a constant envelope that is doubted: 1 s. Sound recordings have 0.77 s at most.
const FLAT_FRAMES: u16 = 80;
/// Hum varies by less than 1/16 of its level.
pub const HUM_SHIFT: u32 = 4;
/// Slow frames of rise without a fall of 3 %: 2.5 s. Sound recordings have 2 s at most.
const CREEP_FRAMES: u16 = 200;
/// Slow frames at the top of the range: 1.5 s. Recordings have 0.35 s.
const TOP_FRAMES: u16 = 120;
/// Slow frames of activity without a pause: 60 s. One person has tone for more than 30 s.
const ENDLESS_FRAMES: u16 = 4_800;
/// Evidence against a muscle a slow frame of activity, by the other electrode's [`Part`]: enough in 2.4 to 4.2 s.
const AGAINST: [[u16; 4]; 2] = [[0, 7, 4, 4], [0, 5, 4, 4]];
const ENOUGH: u16 = 1_344;
const REST_TAKES: u16 = 40;
/// Evidence below which the band was wide, or at rest, within the last second.
const FRESH: u16 = 560;
/// Slow frames in a row without the other electrode's part after which this one hides no opening: 0.75 s.
const LONE_FRAMES: i8 = -60;
/// Slow frames in a row without and with its part that end and make the proof of a closing: 0.2 s, 0.38 s.
const DEAF_FRAMES: i8 = -16;
const JOINED_FRAMES: i8 = 30;
/// Fall from a crest and rise from the trough after it that leave a narrow band, thirty-seconds: 22 and 28 %.
const FALLS: i32 = 7;
const RISES: i32 = 9;
/// Fall within 50 ms of an electrode that comes off, or back on, eighths: no muscle of the recordings relaxes as fast while it works.
const OFF_FALLS: i32 = 3;
/// Good slow frames after which an electrode is believed again: 1 s.
const BACK_FRAMES: u16 = 80;
/// Slow frames between the points of a curve, 50 ms, and before its first one counts.
const LAG: usize = 4;
const FIRST_PROOF_FRAMES: u16 = 20;
/// Least curvature of a proof, as a part of the level, and slow frames between two proofs: 0.15 s.
const PROOF_PART: i32 = 12;
const PROOF_APART: u16 = 12;
/// Part of the other electrode's change within 0.1 s that may be this one's: a turn within it is its signal.
const ECHO_PART: i32 = 8;
/// Slow frames without a proof after which a contraction has to prove itself again: 1 s.
const PROOF_LASTS: u16 = 80;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    #[default]
    Good,
    /// Out of range, or as restless as a loose electrode.
    LeadOff,
    /// Constant, with mains in its spectrum.
    Hum,
    Creep,
    /// Constant within 1 %.
    Flat,
    /// Active without the other electrode's part, without a muscle's falls, or for 60 s.
    Endless,
    Saturated,
}

#[derive(Clone, Debug, Default)]
pub struct Trust {
    quality: Quality,
    good: u16,
    missing: u8,
    last_uv: i32,
    past_uv: [i32; 2 * LAG],
    place: u8,
    anchor_uv: i32,
    flat: u16,
    /// Last envelope that was constant (1 % + 1.5 mV) for 1 s, uV above the live zero. 0: none.
    hum_uv: i32,
    active_for: u16,
    foot_uv: i32,
    crest_uv: i32,
    climbing: u16,
    at_top: u16,
    evidence: u16,
    /// A crest, or the trough after it, uV.
    band_uv: [i32; 2],
    comes_off: bool,
    /// The band was wide within the last second.
    lively: bool,
    lone: bool,
    /// Slow frames in a row with the other electrode's part, or negative, without it.
    run: i8,
    /// Proofs of this contraction, two at most, and slow frames since the last.
    proofs: u8,
    since_proof: u16,
    window: Vec<i16, WINDOW>,
    mains: bool,
}

impl Trust {
    /// uV above the live zero. Gives the reading; in a gap of up to 50 ms, the last one before it.
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
        Some(uv)
    }

    pub fn last_uv(&self) -> Option<i32> {
        (self.missing <= BRIDGED_READINGS).then_some(self.last_uv)
    }

    /// Change within 0.1 s, uV, before the frame is judged.
    pub fn change_uv(&self, uv: i32) -> i32 {
        (uv - self.past_uv[usize::from(self.place) % (2 * LAG)]).abs()
    }

    /// `other_uv`: the other electrode's change within 0.1 s.
    pub fn judge(&mut self, active_uv: i32, uv: i32, other_uv: i32) {
        // A full window waits for its spectrum.
        let _full = self.window.push((self.last_uv / UNIT_UV).clamp(-32_768, 32_767) as i16);
        let place = usize::from(self.place) % (2 * LAG);
        let (middle, far) = (self.past_uv[(place + LAG) % (2 * LAG)], self.past_uv[place]);
        self.past_uv[place] = uv;
        self.place = place as u8 + 1;

        let is_active = uv >= active_uv;
        self.active_for = if is_active { self.active_for.saturating_add(1) } else { 0 };
        let is_top = uv >= TOP_UV;
        self.at_top = if is_top { self.at_top.saturating_add(1) } else { 0 };
        self.stand(uv);
        let turned = self.climb(uv);
        let echo = || (uv - far).abs() * ECHO_PART <= other_uv;
        let curve_uv = || (uv - 2 * middle + far).abs();
        let curves = || curve_uv() * PROOF_PART > uv.max(1) && uv.max(middle).max(far) < TOP_UV;
        self.comes_off = uv < middle - (middle >> 3) * OFF_FALLS;
        let comes_off = self.comes_off;
        self.prove(|| (turned || curves()) && !echo() && !comes_off);

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

    /// The other electrode's part, once a slow frame. `counts`: it is not moving the hand itself. `both_fall`: as muscles do.
    pub fn weigh(&mut self, part: Part, closes: bool, counts: bool, both_fall: bool) {
        self.run = match part {
            Part::Heard => self.run.max(0).saturating_add(1),
            Part::Unheard => self.run.min(0).saturating_sub(1),
            _ => 0,
        };
        if part == Part::Rest {
            self.evidence = self.evidence.saturating_sub(REST_TAKES);
            (self.band_uv, self.lively, self.lone) = ([0, i32::MAX], false, false);
            return;
        }
        if both_fall && part != Part::Unheard {
            self.evidence = 0;
        } else if self.evidence >= ENOUGH {
            self.lose(Quality::Endless);
            return;
        }
        if self.is_good() {
            self.evidence += AGAINST[usize::from(!closes)][part as usize & 3];
        }
        self.lone = self.run <= LONE_FRAMES || self.lone && !(counts && self.run >= JOINED_FRAMES);
        self.lively &= self.is_fresh();
        self.wander(self.last_uv);
    }

    fn wander(&mut self, uv: i32) {
        if self.comes_off {
            self.band_uv = [uv, i32::MAX];
            return;
        }
        let [crest, trough] = &mut self.band_uv;
        *trough = (*trough).min(uv);
        if *trough >= *crest - (*crest >> 5) * FALLS {
            (*crest, *trough) = ((*crest).max(uv), i32::MAX);
        } else if uv > *trough + (*trough >> 5) * RISES {
            (self.evidence, self.run, self.lively, self.lone) = (0, 0, true, false);
            self.band_uv = [uv, i32::MAX];
        }
    }

    /// Active without the other electrode, or higher for longer than a muscle.
    pub const fn is_lone(&self) -> bool {
        self.lone || self.is_at_top() || matches!(self.quality, Quality::Endless)
    }

    /// At the top of its range for 0.5 s.
    const fn is_at_top(&self) -> bool {
        self.at_top >= TOP_FRAMES / 3
    }

    /// At rest, or out of a narrow band, within the last second.
    pub const fn is_fresh(&self) -> bool {
        self.evidence < FRESH
    }

    /// The other electrode has taken its part for long enough to prove a closing.
    pub const fn is_joined(&self) -> bool {
        self.run >= JOINED_FRAMES || self.lively
    }

    pub const fn is_deaf(&self) -> bool {
        self.run < DEAF_FRAMES && !self.lively
    }

    fn lose(&mut self, quality: Quality) {
        self.good = 0;
        // The first reason stays, but a constant envelope may later turn out to be mains.
        if self.is_good() || (self.quality == Quality::Flat && quality == Quality::Hum) {
            self.quality = quality;
        }
    }

    fn prove(&mut self, turns: impl FnOnce() -> bool) {
        self.since_proof = self.since_proof.saturating_add(1);
        let is_late = self.active_for >= FIRST_PROOF_FRAMES;
        if !is_late || self.since_proof > PROOF_LASTS {
            self.proofs = 0;
        }
        if is_late && (self.proofs == 0 || self.since_proof >= PROOF_APART) && turns() {
            (self.proofs, self.since_proof) = ((self.proofs + 1).min(2), 0);
        }
    }

    fn stand(&mut self, uv: i32) {
        if (uv - self.anchor_uv).abs() * 100 > self.anchor_uv + 100 * STILL_UV {
            (self.anchor_uv, self.flat) = (uv, 0);
        } else if uv < TOP_UV {
            self.flat = self.flat.saturating_add(1);
        }
        if self.flat >= FLAT_FRAMES {
            self.hum_uv = self.anchor_uv;
        } else if (uv - self.hum_uv).abs() > (self.hum_uv >> HUM_SHIFT) + STILL_UV {
            // A level that comes back there may be a muscle's, until it is constant again.
            self.hum_uv = 0;
        }
    }

    fn climb(&mut self, uv: i32) -> bool {
        let turned = self.active_for > 0 && uv < self.crest_uv - (self.crest_uv >> 5) - STILL_UV;
        if self.active_for == 0 || turned {
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

    pub const fn quality(&self) -> Quality {
        self.quality
    }

    pub const fn is_good(&self) -> bool {
        matches!(self.quality, Quality::Good)
    }

    /// Doubted, and without the reason of it: seated again, or at rest.
    pub const fn returns(&self) -> bool {
        !self.is_good() && self.good > 0
    }

    pub const fn is_still(&self) -> bool {
        self.flat >= FLAT_FRAMES / 5
    }

    /// Doubted since it was constant.
    pub const fn is_constant(&self) -> bool {
        matches!(self.quality, Quality::Flat | Quality::Hum)
    }

    pub const fn hums(&self) -> bool {
        self.is_constant() && self.flat >= FLAT_FRAMES
    }

    pub fn hums_at(&self, uv: i32) -> bool {
        self.is_constant() && (uv - self.hum_uv).abs() <= (self.hum_uv >> HUM_SHIFT) + STILL_UV
    }

    /// One proof within the last second: the envelope fell back by 3 % or curved.
    pub const fn has_turned(&self) -> bool {
        self.proofs >= 1
    }

    /// Two proofs at least 0.15 s apart: one jump from a fault to another gives only one.
    pub const fn has_turned_twice(&self) -> bool {
        self.proofs >= 2
    }

    /// Not doubted, nor at the top of its range, nor constant for 0.6 s.
    pub const fn is_sound(&self) -> bool {
        self.is_good() && !self.is_at_top() && self.flat < 3 * FLAT_FRAMES / 5
    }

    /// Neither a fall of 3 % nor a proof for 1 s.
    pub const fn is_straight(&self) -> bool {
        self.climbing >= PROOF_LASTS && self.since_proof >= PROOF_LASTS
    }

    pub fn window(&self) -> Option<&[i16; WINDOW]> {
        self.window.as_slice().try_into().ok()
    }

    pub fn hear(&mut self, mains: Mains) {
        self.mains = mains.is_heard();
        self.window.clear();
    }
}

#[cfg(test)]
mod tests;
