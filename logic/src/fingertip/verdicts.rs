//! What the fingertip makes of its detectors' verdicts: said, believed, acted on.

use tenax_hal_shim::detector::DetectorSet;

use crate::detectors::Detectors;

/// The detectors that the reflex may act on: all, unless somebody says otherwise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Acting(pub DetectorSet);

impl Default for Acting {
    fn default() -> Self {
        Self(DetectorSet::ALL)
    }
}

impl Acting {
    /// All of them but these.
    pub const fn but(self, off: DetectorSet) -> Self {
        Self(self.0.without(off))
    }
}

/// What the detectors say in one tick: all of it, and what of it is believed and may be acted on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Verdicts {
    /// All that is said.
    pub said: DetectorSet,
    /// The slip that is believed and may be acted on.
    pub slip: DetectorSet,
    /// The warnings that are.
    pub incipient: DetectorSet,
}

impl Verdicts {
    pub fn of(detectors: &Detectors, Acting(acting): Acting) -> Self {
        let (slip, incipient) = (detectors.slip(), detectors.incipient());
        let verdicts = |said: DetectorSet| said.without(detectors.ignored()).and(acting);
        Self { said: slip.or(incipient), slip: verdicts(slip), incipient: verdicts(incipient) }
    }
}
