//! From the detectors' reports to those that are believed and acted on.

use tenax_hal_shim::detector::DetectorSet;

use crate::detectors::Detectors;

/// The detectors that the reflex may act on: by default all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Acting(pub DetectorSet);

impl Default for Acting {
    fn default() -> Self {
        Self(DetectorSet::ALL)
    }
}

impl Acting {
    /// This set without the detectors `off`.
    pub const fn but(self, off: DetectorSet) -> Self {
        Self(self.0.without(off))
    }
}

/// The detectors' reports in one tick: all, and those that are believed and may be acted on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Verdicts {
    /// Detectors that report slip or a warning.
    pub said: DetectorSet,
    /// Those of them that are believed.
    pub believed: DetectorSet,
    /// Detectors whose report of slip is believed and may be acted on.
    pub slip: DetectorSet,
    /// Detectors whose warning is believed and may be acted on.
    pub incipient: DetectorSet,
}

impl Verdicts {
    pub fn of(detectors: &Detectors, Acting(acting): Acting) -> Self {
        let (slip, incipient) = (detectors.slip(), detectors.incipient());
        let said = slip.or(incipient);
        let believed = said.and(detectors.credible());
        let acted = believed.and(acting);
        Self { said, believed, slip: slip.and(acted), incipient: incipient.and(acted) }
    }
}
