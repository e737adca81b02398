//! The films' vibration above their quiet level, and its part of o1. The quiet level follows the envelope's
//! median while the finger is unloaded; until it is known, the films are not used.

use tenax_hal_shim::channel::PVDF_COUNT;

use super::Gains;
use super::network::Weight;
use crate::detectors::Sensed;

/// Fraction bits of an envelope (Q16) below the resolution of a film; 4 are left, as a gauge's load has.
const ENVELOPE_SHIFT: u32 = 12;
/// Step of a quiet level in a tick, 1/16 of a sample. A constant step makes it the median.
const QUIET_STEP: i32 = 1;

#[derive(Clone, Debug, Default)]
pub(super) struct PvdfPart {
    quiet: [i32; PVDF_COUNT],
    pub quiet_known: bool,
    /// Envelopes above their quiet levels, 1/16 of a sample.
    pub heard: [i32; PVDF_COUNT],
    gains: Gains<PVDF_COUNT>,
    pub stale: bool,
}

impl PvdfPart {
    /// The films' part of o1; 0 while the quiet levels are not known.
    #[inline]
    pub(super) fn process(&mut self, sensed: &Sensed<'_>) -> i64 {
        self.quiet_known |= sensed.unloaded;
        if !self.quiet_known {
            return 0;
        }
        let beyond: [i32; PVDF_COUNT] =
            core::array::from_fn(|n| (sensed.envelopes[n] >> ENVELOPE_SHIFT) - self.quiet[n]);
        if sensed.unloaded {
            for (quiet, beyond) in self.quiet.iter_mut().zip(beyond) {
                *quiet += beyond.signum() * QUIET_STEP;
            }
        }
        self.heard = beyond.map(|beyond| beyond.max(0));
        self.parts().map(i64::from).sum()
    }

    #[inline]
    pub(super) fn parts(&self) -> impl Iterator<Item = i32> {
        self.gains.0.iter().zip(&self.heard).map(|(gain, &heard)| gain.part(heard))
    }

    pub(super) fn renew(&mut self, weights: &[Weight], maxima: &[u32]) {
        self.gains = Gains::of(weights, maxima);
        self.stale = false;
    }
}
