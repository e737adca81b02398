//! From the detectors' reports to those that are believed and acted on.

use tenax_hal_shim::detector::DetectorSet;

use crate::detectors::Detectors;

#[derive(Clone, Copy, Debug)]
pub(super) struct Acting(pub DetectorSet);

impl Default for Acting {
    fn default() -> Self {
        Self(DetectorSet::ALL)
    }
}

impl Acting {
    pub const fn but(self, off: DetectorSet) -> Self {
        Self(self.0.without(off))
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Verdicts {
    pub said: DetectorSet,
    pub believed: DetectorSet,
    pub slip: DetectorSet,
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
