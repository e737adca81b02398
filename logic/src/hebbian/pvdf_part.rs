//! The films' vibration above their quiet level, and what it adds to o1.
//!
//! Noise and the rest of hum are always there and do not come from the object, so each film's quiet level is subtracted from its
//! envelope. It follows the envelope's median while the finger is known to be unloaded, and is held in a grasp. A finger that starts
//! in a grasp, for example after a reset, cannot tell noise from slip: its films are not used until it lets go.

use tenax_hal_shim::channel::PVDF_COUNT;

use super::Gains;
use super::detector::Felt;
use super::network::Weight;

/// Fraction bits of a film's envelope (Q16) that are below what a film can tell; 4 are left, as a gauge's load has.
const ENVELOPE_SHIFT: u32 = 12;

/// How far a quiet level goes after an envelope in a tick, 1/16 of a sample: 4 mV in 0.15 s. A step of one size, whatever
/// the envelope's, makes it the median, which an impact does not move.
const QUIET_STEP: i32 = 1;

/// Quiet levels, readings, and gains.
#[derive(Clone, Debug, Default)]
pub(super) struct PvdfPart {
    /// Quiet level of each film, 1/16 of a sample.
    quiet: [i32; PVDF_COUNT],
    /// Whether the finger has been unloaded since the start.
    quiet_known: bool,
    /// Envelope of each film above its quiet level, 1/16 of a sample.
    heard: [i32; PVDF_COUNT],
    /// Gains from `heard` to o1, with the present weights.
    gains: Gains<PVDF_COUNT>,
    /// Whether a weight or a maximum has changed since the gains were computed.
    stale: bool,
}

impl PvdfPart {
    /// Takes one tick. Gives the films' part of o1; 0 while the quiet levels are not known.
    #[inline]
    pub(super) fn process(&mut self, felt: &Felt<'_>) -> i64 {
        self.quiet_known |= felt.unloaded;
        if !self.quiet_known {
            return 0;
        }
        let beyond: [i32; PVDF_COUNT] =
            core::array::from_fn(|n| (felt.envelopes[n] >> ENVELOPE_SHIFT) - self.quiet[n]);
        if felt.unloaded {
            for (quiet, beyond) in self.quiet.iter_mut().zip(beyond) {
                *quiet += beyond.signum() * QUIET_STEP;
            }
        }
        self.heard = beyond.map(|beyond| beyond.max(0));
        self.parts().map(i64::from).sum()
    }

    /// Envelope of each film above its quiet level, 1/16 of a sample.
    pub(super) const fn heard(&self) -> &[i32; PVDF_COUNT] {
        &self.heard
    }

    /// Part that each film adds to o1.
    #[inline]
    pub(super) fn parts(&self) -> impl Iterator<Item = i32> {
        self.gains.each().iter().zip(&self.heard).map(|(gain, &heard)| gain.part(heard))
    }

    /// Whether the quiet levels are known.
    pub(super) const fn is_quiet_known(&self) -> bool {
        self.quiet_known
    }

    /// A weight or a maximum has changed.
    pub(super) const fn outdate(&mut self) {
        self.stale = true;
    }

    /// Whether a weight or a maximum has changed since the gains were computed.
    pub(super) const fn is_outdated(&self) -> bool {
        self.stale
    }

    /// Makes the gains anew.
    pub(super) fn renew(&mut self, weights: &[Weight], maxima: &[u32]) {
        self.gains = Gains::of(weights, maxima);
        self.stale = false;
    }
}
